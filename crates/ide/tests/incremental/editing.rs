//! Edits, opens and closes files, with a simple model of their content.

use std::collections::BTreeMap;

use proptest::prelude::*;
use pydslrep_analysis::{Absence, Database, Diagnostic, FileId, Snapshot, Target};
use pydslrep_syntax::{EntityKind, KEYWORDS, Span, TokenKind, lex, parse};

use crate::answers::{self, Focus};
use crate::panics::without_panic;
use crate::programs::{self, IMPORTS, PATHS, Start};
use crate::smallest::Failure;

/// An action of the user or the editor.
#[derive(Debug, Clone)]
pub(crate) enum Step {
    /// Replaces text.
    Replace { file: usize, at: Anchor, len: Length, text: String },
    /// Replaces a name or a number by another one of the file: what was grammatical stays so.
    Swap { file: usize, token: u8, with: u8 },
    /// Writes whole entities before another one.
    Insert { file: usize, to: u8, text: &'static str },
    /// Opens a file again with its text at the beginning.
    Restore { file: usize },
    /// Moves an entity before another one, possibly in another file.
    Move { file: usize, entity: u8, to_file: usize, to: u8 },
    /// Copies an entity before another one.
    Copy { file: usize, entity: u8, to_file: usize, to: u8 },
    /// Undoes the last edits one by one.
    Undo(u8),
    /// Redoes undone edits.
    Redo(u8),
    /// Closes a file, or reopens it with its last text.
    CloseOrOpen { file: usize },
    /// Opens an open file again with the text of another one.
    Reopen { file: usize, like: usize },
    /// Changes what is known of a missing import.
    Absence { file: usize, import: usize, why: Option<Absence> },
    /// Changes the target.
    Target { file: usize, target: Target },
    /// Adds, changes or removes the scene of an environment.
    Scene { file: usize, environment: u8, scene: Option<usize> },
}

/// A position that stays similar when text before it is removed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Anchor {
    /// A number of bytes after the start of a token, or of the last one.
    TokenKind(u8, u8),
    /// A fraction of the text in units of 1/65536. May be inside a character.
    Part(u16),
}

/// The length of the replaced text.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Length {
    Bytes(u8),
    Tokens(u8),
}

const SIGNS: [&str; 76] = [
    "{",
    "}",
    ",",
    ":",
    "/*",
    "*/",
    "//",
    "\"",
    "/",
    "*",
    "\n",
    "\r",
    "\r\n",
    "^",
    "-",
    ".",
    " ",
    "\t",
    "é",
    "🤖",
    "größe ",
    "\u{feff}",
    "s",
    "s ",
    "a ",
    "b ",
    "r ",
    "m ",
    "wheelL ",
    "4.5",
    "0",
    "19999",
    "1e400 ",
    "10.0.0.7",
    "import \"lib.pyr\" ",
    "import \"base.pyr\"\n",
    "import \"main.pyr\" ",
    "import \"parts/more.pyr\" ",
    "import \"missing.pyr\"\n",
    "import ",
    "wheel a with radius 3\n",
    "wheelH b with radius 5 ",
    "sensor s\n",
    "sensor t : bumper ",
    "movement m of r { turn left }\n",
    "parallel movement n of r { move 1 meters }",
    "robot r with port 19999 has { a b } wheels ",
    "robot r ",
    "sensor s ",
    "environment f has { r } robots ",
    "environment E has { r } robots with { m n } moves\n",
    "environment math has { q } robots ",
    "} wheel ",
    "parallel ",
    "ip here 10.0.0.1\n",
    "with ip here ",
    "type fwh ",
    "until { s }",
    "with sensors { s } ",
    "repeat 3 times { ",
    "repeat until { s } detect {\n",
    "if { s t } clear { ",
    "} else { ",
    "else if { t } detect within 0.5 meters { ",
    "do m ",
    "do n\n",
    "wait 2 seconds ",
    "wait until { s } clear ",
    "until { s } detect within 30 centimeters ",
    "with radius 1.5 meters ",
    "in reverse ",
    "10000 times ",
    "clear ",
    "move at 5 until ",
    "",
    "} } ",
];

/// Whole entities.
const ENTITIES: [&str; 16] = [
    "wheel a with radius 3\n",
    "wheel b with radius 5 ",
    "wheelH a with radius 3\n",
    "sensor s\n",
    "ip here 10.0.0.1\n",
    "robot r with port 20000 has { a b } wheels\n",
    "robot q type tw with port 20000 has { a b } wheels with sensors { s }\n",
    "movement m of r { move 2 meters turn left }\n",
    "parallel movement m of r { move -1 meters at 20 }\n",
    "parallel movement n of q { turn right 30 move 1.5 meters }\n",
    "movement n of r { repeat 3 times { do m repeat 2 times { turn left 30 with radius 50 centimeters } } }\n",
    "movement m of r { repeat 10 times { if { s } detect { wait 1 seconds } else { move 1 meters } } }\n",
    "movement o of q { do n repeat until { s } clear within 1 meters { move -0.1 meters } do n }\n",
    "parallel movement n of r { wait until { s } detect do n }\n",
    "environment e has { q r } robots with { n m } moves\n",
    "environment f has { r q } robots with { m n m } moves\n",
];

/// Scenes with many, some or no collisions, and an invalid one.
const SCENES: [&str; 5] = [
    "[world]\nsize = [1.5, 1.5]\n",
    "[[wall]]\nfrom = [0.4, -9]\nto = [0.4, 9]\n[robots.r]\nstart = [0, 0, 90]\n",
    "[[cylinder]]\nat = [0.0, 1.0]\nradius = 0.3\n[robots.robot_1]\ntrack = 0.5\n",
    "[noise]\nseed = 3\n",
    "[wrold]\nsize =",
];

fn files() -> impl Strategy<Value = usize> {
    // Most edits affect the active file.
    prop_oneof![3 => Just(0), 2 => Just(1), 1 => Just(2), 1 => Just(3)]
}

/// Any edits: most leave syntax errors behind, as typing does.
fn steps() -> BoxedStrategy<Step> {
    let text = prop_oneof![
        2 => proptest::sample::select(KEYWORDS.map(|(_, word)| format!("{word} ")).to_vec()),
        1 => (proptest::sample::select(KEYWORDS.map(|(_, word)| word).to_vec()), any::<u8>())
            .prop_map(|(word, cut)| word[..usize::from(cut) % word.len()].to_owned()),
        6 => proptest::sample::select(SIGNS.map(str::to_owned).to_vec()),
    ];
    let at = prop_oneof![
        4 => (any::<u8>(), prop_oneof![3 => Just(0_u8), 1 => 1..12_u8]).prop_map(|(token, bytes)| Anchor::TokenKind(token, bytes)),
        1 => any::<u16>().prop_map(Anchor::Part),
    ];
    let len = prop_oneof![
        5 => Just(Length::Bytes(0)),
        2 => (1..4_u8).prop_map(Length::Bytes),
        2 => (1..4_u8).prop_map(Length::Tokens),
        1 => (4..80_u8).prop_map(Length::Bytes),
    ];
    prop_oneof![
        30 => (files(), at, len, text).prop_map(|(file, at, len, text)| Step::Replace { file, at, len, text }),
        28 => whole_steps(),
    ]
    .boxed()
}

/// Edits that leave grammatical programs grammatical.
fn careful_steps() -> BoxedStrategy<Step> {
    prop_oneof![
        20 => (files(), any::<u8>(), any::<u8>()).prop_map(|(file, token, with)| Step::Swap { file, token, with }),
        4 => (files(), any::<u8>(), proptest::sample::select(ENTITIES.to_vec()))
            .prop_map(|(file, to, text)| Step::Insert { file, to, text }),
        3 => files().prop_map(|file| Step::Restore { file }),
        24 => whole_steps(),
    ]
    .boxed()
}

/// Edits of whole entities and files, and other inputs.
fn whole_steps() -> impl Strategy<Value = Step> {
    let import = 0..IMPORTS.len();
    let why = prop_oneof![
        Just(None),
        Just(Some(Absence::Missing)),
        Just(Some(Absence::Outside)),
        Just(Some(Absence::Unreadable("is a folder".to_owned()))),
    ];
    let moved = || (files(), any::<u8>(), files(), any::<u8>());
    prop_oneof![
        4 => moved().prop_map(|(file, entity, to_file, to)| Step::Move { file, entity, to_file, to }),
        2 => moved().prop_map(|(file, entity, to_file, to)| Step::Copy { file, entity, to_file, to }),
        6 => (1..4_u8).prop_map(Step::Undo),
        3 => (1..4_u8).prop_map(Step::Redo),
        2 => files().prop_map(|file| Step::CloseOrOpen { file }),
        1 => (files(), files()).prop_map(|(file, like)| Step::Reopen { file, like }),
        2 => (files(), import, why).prop_map(|(file, import, why)| Step::Absence { file, import, why }),
        2 => (files(), proptest::sample::select(Target::ALL.to_vec())).prop_map(|(file, target)| Step::Target { file, target }),
        3 => (files(), any::<u8>(), proptest::option::weighted(0.8, 0..SCENES.len()))
            .prop_map(|(file, environment, scene)| Step::Scene { file, environment, scene }),
    ]
}

/// Programs with about `length` steps; half of the programs are edited with care.
pub(crate) fn strategy(steps_in_a_row: usize) -> impl Strategy<Value = (Start, Vec<Step>)> {
    let length = steps_in_a_row / 2..=steps_in_a_row * 3 / 2;
    let in_a_row = move |steps: BoxedStrategy<Step>| proptest::collection::vec(steps, length.clone());
    let steps = prop_oneof![in_a_row(steps()), in_a_row(careful_steps())];
    (steps, programs::starts()).prop_map(|(steps, start)| (start, steps))
}

/// A simple model of a database's inputs.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Model {
    /// `None` for a closed file.
    pub(crate) texts: [Option<String>; 4],
    pub(crate) absences: BTreeMap<(usize, String), Absence>,
    pub(crate) targets: [Target; 4],
    /// By file and environment; kept while a file is closed.
    pub(crate) scenes: BTreeMap<(usize, String), String>,
}

/// An input of a database.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Change {
    Edit { file: usize, span: Span, text: String },
    Open { file: usize, text: String },
    Close { file: usize },
    Absence { file: usize, path: String, why: Option<Absence> },
    Target { file: usize, target: Target },
    Scene { file: usize, environment: String, text: Option<String> },
}

impl Change {
    pub(crate) fn file(&self) -> usize {
        match self {
            Self::Edit { file, .. }
            | Self::Open { file, .. }
            | Self::Close { file }
            | Self::Absence { file, .. }
            | Self::Target { file, .. }
            | Self::Scene { file, .. } => *file,
        }
    }

    /// Applies the input to a database.
    pub(crate) fn tell(&self, database: &mut Database, files: [FileId; 4]) {
        match self {
            Self::Edit { file, span, text } => database.edit(files[*file], *span, text),
            Self::Open { file, text } => assert_eq!(database.open(PATHS[*file], text), files[*file]),
            Self::Close { file } => database.close(files[*file]),
            Self::Absence { file, path, why } => database.set_absence(files[*file], path, why.clone()),
            Self::Target { file, target } => database.set_target(files[*file], *target),
            Self::Scene { file, environment, text } => {
                database.set_scene(files[*file], environment, text.as_deref());
            }
        }
    }
}

impl Model {
    pub(crate) fn apply(&mut self, change: &Change) {
        match change {
            Change::Edit { file, span, text } => {
                if let Some(before) = &mut self.texts[*file] {
                    let span = fit(before, *span);
                    before.replace_range(span.start as usize..span.end as usize, text);
                }
            }
            Change::Open { file, text } => {
                self.texts[*file] = Some(text.clone());
                self.absences.retain(|(_, path), why| path != PATHS[*file] || *why == Absence::Outside);
            }
            Change::Close { file } => {
                self.texts[*file] = None;
                self.absences.retain(|(importer, _), _| importer != file);
            }
            Change::Absence { file, path, why } if self.texts[*file].is_some() => {
                let key = (*file, path.clone());
                match why {
                    Some(why) => self.absences.insert(key, why.clone()),
                    None => self.absences.remove(&key),
                };
            }
            Change::Absence { .. } => {}
            Change::Target { file, target } => self.targets[*file] = *target,
            Change::Scene { file, environment, text } => {
                let key = (*file, environment.clone());
                match text {
                    Some(text) => self.scenes.insert(key, text.clone()),
                    None => self.scenes.remove(&key),
                };
            }
        }
    }

    /// A fresh database with these inputs. Their order must not matter; `turn` varies it.
    pub(crate) fn fresh(&self, turn: usize) -> (Database, [FileId; 4]) {
        let mut database = Database::new();
        // File ids follow the order of opening and must match.
        let files = PATHS.map(|path| {
            let file = database.open(path, "");
            database.close(file);
            file
        });
        for index in (0..PATHS.len()).map(|index| (index + turn) % PATHS.len()) {
            for ((_, environment), text) in self.scenes.iter().filter(|((file, _), _)| *file == index) {
                database.set_scene(files[index], environment, Some(text));
            }
            database.set_target(files[index], self.targets[index]);
            if let Some(text) = &self.texts[index] {
                database.open(PATHS[index], text);
            }
        }
        for ((file, path), why) in &self.absences {
            database.set_absence(files[*file], path, Some(why.clone()));
        }
        (database, files)
    }

    /// The position after an edit.
    pub(crate) fn following(&self, change: &Change) -> u32 {
        match change {
            Change::Edit { file, span, text } => {
                let following = span.start.saturating_add(u32::try_from(text.len()).unwrap());
                fit(self.text(*file), Span::at(following)).start
            }
            _ => 0,
        }
    }

    fn text(&self, file: usize) -> &str {
        self.texts[file].as_deref().unwrap_or_default()
    }
}

/// The nearest earlier range within the text and on character boundaries.
fn fit(text: &str, span: Span) -> Span {
    let snap = |offset: u32| {
        let mut offset = (offset as usize).min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        u32::try_from(offset).unwrap()
    };
    let start = snap(span.start);
    Span::new(start, snap(span.end.max(span.start)))
}

/// A database under continuous editing.
pub(crate) struct Editing {
    database: Database,
    files: [FileId; 4],
    model: Model,
    /// The diagnostics that an editor has.
    reported: [Vec<Diagnostic>; 4],
    /// The inverses of the last edits.
    undo: Vec<Change>,
    redo: Vec<Change>,
    /// The last texts of closed files.
    closed: [String; 4],
    /// The texts at the beginning.
    begun: [String; 4],
    /// Snapshots of files.
    kept: Vec<(Snapshot, usize)>,
    beginning: Database,
    turn: usize,
    /// The number of edits between two comparisons.
    every: usize,
}

impl Editing {
    pub(crate) fn new(start: &Start, every: usize) -> Self {
        let mut model = Model::default();
        let mut closed: [String; 4] = std::array::from_fn(|_| String::new());
        for (file, text) in start.texts().into_iter().enumerate() {
            if start.is_open(file) {
                model.apply(&Change::Open { file, text });
            } else {
                closed[file] = text;
            }
        }
        for (file, environment, text) in start.scenes() {
            let (environment, text) = ((*environment).to_owned(), Some((*text).to_owned()));
            model.apply(&Change::Scene { file: *file, environment, text });
        }
        let (mut database, files) = model.fresh(0);
        database.take_touched();
        let reported = files.map(|file| database.diagnostics(file));
        let kept = files
            .iter()
            .enumerate()
            .filter_map(|(index, file)| Some((database.snapshot(*file, None)?, index)));
        Self {
            kept: kept.collect(),
            beginning: model.fresh(2).0,
            database,
            files,
            model,
            reported,
            undo: Vec::new(),
            redo: Vec::new(),
            closed,
            begun: start.texts(),
            turn: 0,
            every,
        }
    }

    /// Makes the edits of a step, compares when it is time, and returns their number.
    pub(crate) fn take(&mut self, step: &Step) -> Result<u64, Box<Failure>> {
        let mut count = 0;
        match step {
            Step::Undo(times) => {
                for _ in 0..*times {
                    let Some(change) = self.undo.pop() else { break };
                    self.redo.extend(self.inverse(&change));
                    self.change(&change)?;
                    count += 1;
                }
            }
            Step::Redo(times) => {
                for _ in 0..*times {
                    let Some(change) = self.redo.pop() else { break };
                    self.undo.extend(self.inverse(&change));
                    self.change(&change)?;
                    count += 1;
                }
            }
            _ => {
                for change in self.changes(step) {
                    match self.inverse(&change) {
                        Some(inverse) => self.undo.push(inverse),
                        // Closing a file cannot be undone, nor anything before it.
                        None => self.undo.clear(),
                    }
                    self.redo.clear();
                    self.change(&change)?;
                    count += 1;
                }
            }
        }
        Ok(count)
    }

    /// The inverse of an edit.
    fn inverse(&self, change: &Change) -> Option<Change> {
        let Change::Edit { file, span, text } = change else { return None };
        let before = self.model.texts[*file].as_ref()?;
        let span = fit(before, *span);
        let end = span.start + u32::try_from(text.len()).ok()?;
        Some(Change::Edit {
            file: *file,
            span: Span::new(span.start, end),
            text: span.text(before).to_owned(),
        })
    }

    fn changes(&self, step: &Step) -> Vec<Change> {
        match step {
            Step::Replace { file, at, len, text } => {
                let span = span(self.model.text(*file), *at, *len);
                vec![Change::Edit { file: *file, span, text: text.clone() }]
            }
            Step::Swap { file, token, with } => self.swapped(*file, *token, *with).into_iter().collect(),
            Step::Insert { file, to, text } => {
                let to = entity(self.model.text(*file), *to).start;
                vec![Change::Edit { file: *file, span: Span::at(to), text: (*text).to_owned() }]
            }
            Step::Restore { file } => vec![Change::Open { file: *file, text: self.begun[*file].clone() }],
            Step::Move { file, entity, to_file, to } => self.moved(*file, *entity, *to_file, *to, true),
            Step::Copy { file, entity, to_file, to } => self.moved(*file, *entity, *to_file, *to, false),
            Step::CloseOrOpen { file } => vec![match self.model.texts[*file] {
                Some(_) => Change::Close { file: *file },
                None => Change::Open { file: *file, text: self.closed[*file].clone() },
            }],
            Step::Reopen { file, like } => {
                vec![Change::Open { file: *file, text: self.model.text(*like).to_owned() }]
            }
            Step::Absence { file, import, why } => {
                vec![Change::Absence { file: *file, path: IMPORTS[*import].to_owned(), why: why.clone() }]
            }
            Step::Target { file, target } => vec![Change::Target { file: *file, target: *target }],
            Step::Scene { file, environment, scene } => {
                let environment = self.environment(*file, *environment);
                vec![Change::Scene {
                    file: *file,
                    environment,
                    text: scene.map(|scene| SCENES[scene].to_owned()),
                }]
            }
            Step::Undo(_) | Step::Redo(_) => Vec::new(),
        }
    }

    /// Another name in place of a name, or another number in place of a number.
    fn swapped(&self, file: usize, token: u8, with: u8) -> Option<Change> {
        let text = self.model.text(file);
        let is_value =
            |kind: TokenKind| matches!(kind, TokenKind::Name | TokenKind::Integer | TokenKind::Float);
        let values: Vec<_> = lex(text).into_iter().filter(|(kind, _)| is_value(*kind)).collect();
        let (kind, span) = *values.get(usize::from(token) % values.len().max(1))?;
        let alike: Vec<_> = values.iter().filter(|(other, _)| *other == kind).collect();
        let (_, other) = alike[usize::from(with) % alike.len()];
        Some(Change::Edit { file, span, text: other.text(text).to_owned() })
    }

    /// The name of one of a file's environments.
    fn environment(&self, file: usize, index: u8) -> String {
        let pieces = parse(self.model.text(file));
        let environments = pieces.iter().filter_map(|(_, piece)| piece.entity.as_ref());
        let names: Vec<&str> = environments
            .filter(|entity| entity.kind() == Some(EntityKind::Environment))
            .filter_map(|entity| Some(entity.name()?.text.as_str()))
            .collect();
        names.get(usize::from(index) % names.len().max(1)).map_or("e", |name| name).to_owned()
    }

    fn moved(&self, file: usize, entity: u8, to_file: usize, to: u8, is_move: bool) -> Vec<Change> {
        let text = self.model.text(file);
        let from = self::entity(text, entity);
        let moved = from.text(text).to_owned();
        let mut to = self::entity(self.model.text(to_file), to).start;
        let insert = |to| Change::Edit { file: to_file, span: Span::at(to), text: moved.clone() };
        if !is_move {
            return vec![insert(to)];
        }
        if file == to_file && to > from.start {
            to -= from.len();
        }
        vec![Change::Edit { file, span: from, text: String::new() }, insert(to)]
    }

    fn change(&mut self, change: &Change) -> Result<(), Box<Failure>> {
        let before = self.model.clone();
        if let Change::Close { file } = change {
            self.model.text(*file).clone_into(&mut self.closed[*file]);
        }
        self.turn += 1;
        self.model.apply(change);
        let outcome = if self.turn.is_multiple_of(self.every) {
            self.change_and_compare(change, &before)
        } else {
            without_panic(|| {
                change.tell(&mut self.database, self.files);
                let touched = self.database.take_touched();
                self.report(&touched);
                Ok(())
            })
        };
        outcome.map_err(|difference| Box::new(Failure::new(before, change.clone(), difference)))
    }

    fn change_and_compare(&mut self, change: &Change, before: &Model) -> Result<(), String> {
        let snapshots: Vec<(Snapshot, usize)> = self
            .files
            .iter()
            .enumerate()
            .filter_map(|(index, file)| Some((self.database.snapshot(*file, None)?, index)))
            .collect();
        let (fresh, _) = self.model.fresh(self.turn);
        let (last, _) = before.fresh(self.turn - 1);
        without_panic(|| {
            change.tell(&mut self.database, self.files);
            self.compare(&fresh, change)?;
            for (snapshot, index) in &snapshots {
                answers::compare_snapshot(snapshot, &last, self.files[*index])?;
            }
            let touched = self.database.take_touched();
            answers::unreported(&self.database, self.files, &touched, &self.reported)?;
            self.report(&touched);
            Ok(())
        })
    }

    fn compare(&self, fresh: &Database, change: &Change) -> Result<(), String> {
        let focus = Focus { file: change.file(), offset: self.model.following(change), turn: self.turn };
        answers::compare(&self.database, fresh, self.files, &focus)?;
        if let Some((snapshot, index)) = self.kept.get(self.turn % PATHS.len()) {
            answers::compare_snapshot(snapshot, &self.beginning, self.files[*index])?;
        }
        Ok(())
    }

    /// Reports the diagnostics of the files that an edit has touched, as a server does.
    fn report(&mut self, touched: &[FileId]) {
        for (index, file) in self.files.into_iter().enumerate() {
            if touched.contains(&file) {
                self.reported[index] = self.database.diagnostics(file);
            }
        }
    }
}

/// The range of an entity.
fn entity(text: &str, index: u8) -> Span {
    let pieces = parse(text);
    pieces.get(usize::from(index) % pieces.len()).map_or(Span::at(0), |(span, _)| *span)
}

/// The range of an anchor and a length.
fn span(text: &str, at: Anchor, len: Length) -> Span {
    let tokens = lex(text);
    let start = match at {
        Anchor::Part(part) => u32::try_from(text.len() * usize::from(part) / usize::from(u16::MAX)).unwrap(),
        Anchor::TokenKind(token, bytes) => match usize::from(token) % (tokens.len() + 1) {
            0 => 0,
            index => {
                let span = tokens[index - 1].1;
                span.start + u32::from(bytes).min(span.len())
            }
        },
    };
    match len {
        Length::Bytes(bytes) => Span::new(start, start + u32::from(bytes)),
        Length::Tokens(count) => {
            let following = tokens.iter().filter(|(_, span)| span.end > start).take(usize::from(count));
            Span::new(start, following.last().map_or(start, |(_, span)| span.end))
        }
    }
}
