//! Safe fixes, applied round after round until none is left.

mod patch;

use std::collections::hash_map::DefaultHasher;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::hash::{Hash, Hasher};

use self::patch::Patch;
use crate::{Database, Diagnostic, Edit, FileId, Fix};

/// A limit for fixes that keep causing new problems. Fixes at the same place take a round each.
const MAX_ROUNDS: usize = 1000;

/// The fixing of some files. The caller reads the problems before each round, so that it can open files that have
/// become relevant since the last one.
#[derive(Debug)]
pub struct Fixing {
    files: Vec<FileId>,
    seen: HashSet<u64>,
    rounds: usize,
    problems: BTreeMap<FileId, usize>,
    before: BTreeMap<FileId, String>,
    patches: BTreeMap<FileId, Patch>,
}

impl Fixing {
    /// Only the given files will be changed.
    pub fn new(database: &Database, files: &[FileId]) -> Self {
        Self {
            files: files.to_vec(),
            seen: HashSet::from([fingerprint(database, files)]),
            rounds: 0,
            problems: BTreeMap::new(),
            before: BTreeMap::new(),
            patches: BTreeMap::new(),
        }
    }

    /// Applies the first safe fix of each of these problems, as far as they can be applied at once. False when that is
    /// the end: nothing was left to fix, or fixes undo each other; then the database is as it was before the round.
    pub fn round(&mut self, database: &mut Database, problems: &[Diagnostic]) -> bool {
        let chosen = choose(database, &self.files, problems);
        let texts = texts(database, &chosen);
        self.rounds += 1;
        apply(database, &texts, &chosen);
        // Also where nothing was chosen.
        if !self.seen.insert(fingerprint(database, &self.files)) {
            restore(database, &texts);
            return false;
        }
        for (problem, _) in &chosen {
            *self.problems.entry(problem.file).or_default() += 1;
        }
        for (file, text) in texts {
            let patch = self.patches.entry(file).or_insert_with(|| Patch::of(&text));
            patch.apply(&in_order(file, &chosen));
            self.before.entry(file).or_insert(text);
        }
        self.rounds < MAX_ROUNDS
    }

    /// Returns the number of fixed problems of each file that had any.
    pub fn problems(&self) -> &BTreeMap<FileId, usize> {
        &self.problems
    }

    /// Returns the texts of the changed files as they were before.
    pub fn before(&self) -> &BTreeMap<FileId, String> {
        &self.before
    }

    /// All that was changed, as edits of the files as they were: apart from each other, in the order of the texts.
    pub fn edits(&self) -> Vec<Edit> {
        self.patches.iter().flat_map(|(file, patch)| patch.edits(*file)).collect()
    }
}

/// Fixes that can be applied at once: the first safe one of each problem, if nothing chosen before touches it.
fn choose<'a>(
    database: &Database,
    files: &[FileId],
    problems: &'a [Diagnostic],
) -> Vec<(&'a Diagnostic, &'a Fix)> {
    let mut chosen: Vec<(&Diagnostic, &Fix)> = Vec::new();
    for problem in problems {
        let fits = |fix: &&Fix| {
            let is_ours = fix.edits.iter().all(|edit| files.contains(&edit.file));
            let changes = fix.edits.iter().any(|edit| database.slice(edit.file, edit.span) != edit.text);
            fix.safe && is_ours && changes && !chosen.iter().any(|(_, other)| touch(fix, other))
        };
        if let Some(fix) = problem.fixes.iter().find(fits) {
            chosen.push((problem, fix));
        }
    }
    chosen
}

/// Returns whether two fixes change the same text, or adjacent text, where the order would matter.
fn touch(a: &Fix, b: &Fix) -> bool {
    let touch =
        |a: &Edit, b: &Edit| a.file == b.file && a.span.start <= b.span.end && b.span.start <= a.span.end;
    a.edits.iter().any(|a| b.edits.iter().any(|b| touch(a, b)))
}

fn apply(database: &mut Database, texts: &BTreeMap<FileId, String>, chosen: &[(&Diagnostic, &Fix)]) {
    for (file, text) in texts {
        let path = database.path(*file).to_owned();
        // At once: thousands of edits would each be followed by a look at what they change.
        database.open(&path, &edited(text, &in_order(*file, chosen)));
    }
}

fn in_order<'a>(file: FileId, chosen: &[(&Diagnostic, &'a Fix)]) -> Vec<&'a Edit> {
    let edits = chosen.iter().flat_map(|(_, fix)| &fix.edits).filter(|edit| edit.file == file);
    let mut edits: Vec<&Edit> = edits.collect();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    edits
}

/// A text with edits, which are in its order.
fn edited(text: &str, edits: &[&Edit]) -> String {
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for edit in edits {
        out += text.get(done..edit.span.start as usize).unwrap_or_default();
        out += &edit.text;
        done = edit.span.end as usize;
    }
    out + text.get(done..).unwrap_or_default()
}

/// The texts that fixes will change.
fn texts(database: &Database, chosen: &[(&Diagnostic, &Fix)]) -> BTreeMap<FileId, String> {
    let files: BTreeSet<FileId> =
        chosen.iter().flat_map(|(_, fix)| &fix.edits).map(|edit| edit.file).collect();
    files.into_iter().map(|file| (file, text(database, file))).collect()
}

fn text(database: &Database, file: FileId) -> String {
    database.text(file).map(ToString::to_string).unwrap_or_default()
}

fn restore(database: &mut Database, texts: &BTreeMap<FileId, String>) {
    for (file, text) in texts {
        let path = database.path(*file).to_owned();
        database.open(&path, text);
    }
}

/// Distinguishes texts that were there before.
fn fingerprint(database: &Database, files: &[FileId]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for file in files {
        text(database, *file).hash(&mut hasher);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Severity;
    use crate::diagnostics::rule;
    use pydslrep_syntax::Span;

    /// A problem whose fixes each replace a text by another one.
    fn problem(file: FileId, fixes: &[(bool, Span, &str)]) -> Diagnostic {
        let fixes = fixes.iter().map(|(safe, span, text)| Fix {
            title: String::new(),
            safe: *safe,
            edits: vec![Edit { file, span: *span, text: (*text).to_owned() }],
        });
        Diagnostic {
            rule: rule("zero-distance").unwrap(),
            severity: Severity::Warning,
            file,
            span: Span::new(0, 0),
            message: String::new(),
            help: None,
            note: None,
            related: Vec::new(),
            fixes: fixes.collect(),
        }
    }

    fn fixed(text: &str, find: impl Fn(&str, FileId) -> Vec<Diagnostic>) -> (String, usize) {
        let mut database = Database::new();
        let file = database.open("x.pyr", text);
        let mut fixing = Fixing::new(&database, &[file]);
        loop {
            let problems = find(&super::text(&database, file), file);
            if !fixing.round(&mut database, &problems) {
                break;
            }
        }
        let edits = fixing.edits();
        let now = super::text(&database, file);
        assert_eq!(edited(text, &edits.iter().collect::<Vec<_>>()), now, "the edits say the same");
        (now, fixing.problems().values().sum())
    }

    #[test]
    fn fixes_at_the_same_place_take_turns() {
        let find = |text: &str, file| {
            let span = |word: &str| text.find(word).and_then(|at| u32::try_from(at).ok());
            let words = ["ab", "bc", "x"].into_iter().filter_map(|word| Some((word, span(word)?)));
            let problems = words.map(|(word, start)| {
                let end = start + u32::try_from(word.len()).unwrap();
                problem(file, &[(false, Span::new(start, end), "!"), (true, Span::new(start, end), "")])
            });
            problems.collect()
        };
        assert_eq!(fixed("abc x bcd", find), ("c  d".to_owned(), 3));
    }

    #[test]
    fn what_came_in_one_round_may_change_in_the_next() {
        let find = |text: &str, file| {
            let step = [("one", "two words"), ("two ", "2"), ("2wo", "")];
            let found = step.into_iter().find_map(|(word, new)| Some((text.find(word)?, word.len(), new)));
            let problems = found.into_iter().map(|(at, len, new)| {
                let at = u32::try_from(at).unwrap();
                problem(file, &[(true, Span::new(at, at + u32::try_from(len).unwrap()), new)])
            });
            problems.collect()
        };
        assert_eq!(fixed("a one b", find), ("a rds b".to_owned(), 3));
    }

    #[test]
    fn fixes_that_undo_each_other_end() {
        let flip = |text: &str, file| {
            let other = if text == "a" { "b" } else { "a" };
            vec![problem(file, &[(true, Span::new(0, 1), other)])]
        };
        assert_eq!(fixed("a", flip), ("b".to_owned(), 1));
    }

    #[test]
    fn fixes_that_change_nothing_or_never_end_do_not_loop() {
        let same = |_: &str, file| vec![problem(file, &[(true, Span::new(0, 1), "a")])];
        assert_eq!(fixed("a", same), ("a".to_owned(), 0));
        let grow = |_: &str, file| vec![problem(file, &[(true, Span::new(0, 0), "a")])];
        assert_eq!(fixed("", grow).1, MAX_ROUNDS);
    }

    #[test]
    fn files_that_were_not_named_stay() {
        let mut database = Database::new();
        let [named, other] = ["x.pyr", "y.pyr"].map(|path| database.open(path, "a"));
        let mut fixing = Fixing::new(&database, &[named]);
        assert!(!fixing.round(&mut database, &[problem(other, &[(true, Span::new(0, 1), "b")])]));
        assert_eq!(text(&database, other), "a");
        assert_eq!(fixing.edits(), []);
    }
}
