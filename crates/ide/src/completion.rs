//! Completion: what the grammar allows at the cursor, and of names only those that make sense there.
//!
//! Which words fit is asked of the parser itself ([`expected_after`]), so it cannot drift from the language.

mod snippets;

use std::collections::HashMap;

use pydslrep_analysis::{Database, EntityId, EntityRef, FileId};
use pydslrep_syntax::ast::{Action, DriveWord, Entity, Movement, Name, References, Robot};
use pydslrep_syntax::{EntityKind, Expected, KEYWORDS, Lexeme, Span, Token, expected_after};

use self::snippets::{ACTIONS, ENTITIES, Snippet, without_stops};
use crate::FilePosition;
use crate::cursor::{body, resolved};
use crate::reference::keyword_page;

/// One thing to complete with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// What the list shows.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// A few words beside the label.
    pub detail: String,
    /// Markdown.
    pub documentation: String,
    /// What it replaces: the word at the cursor.
    pub replace: Span,
    /// What it inserts; with `$1`, `${1:text}` and `$0` for the cursor's stops if `is_snippet`.
    pub insert: String,
    /// Whether `insert` has stops.
    pub is_snippet: bool,
    /// Its place in the list: names, then words, then whole patterns.
    pub rank: u8,
}

/// What a completion is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionKind {
    /// A word of the language, perhaps with those that must follow.
    Keyword,
    /// A whole entity or action to fill in.
    Snippet,
    /// A number or an address.
    Value,
    /// The name of an entity.
    Reference(EntityKind),
    /// A key or a table of a settings file.
    Setting,
}

/// What fits at a place; `speed` is for patterns with one, in centimetres per second.
pub fn completions(database: &Database, position: FilePosition, speed: f64) -> Vec<Completion> {
    let Some(place) = Place::find(database, position, speed) else { return Vec::new() };
    let mut found = Vec::new();
    for expected in expected_after(&place.text, &place.before) {
        place.complete(expected, &mut found);
    }
    found.sort_by(|a, b| (a.rank, &a.label).cmp(&(b.rank, &b.label)));
    found
}

/// The entity before the cursor, as far as it is written.
struct Place<'a> {
    database: &'a Database,
    file: FileId,
    /// The entity that the cursor continues; `None` at the start of a file.
    entity: Option<(EntityId, &'a Entity)>,
    /// Its text.
    text: String,
    /// Its tokens before the word at the cursor.
    before: Vec<Lexeme>,
    /// Whether nothing of the entity is written behind that word.
    at_end: bool,
    /// The speed in patterns, centimetres per second.
    speed: f64,
    /// The cursor, from the entity's start.
    offset: u32,
    /// The word at the cursor, in the file.
    word: Span,
}

impl<'a> Place<'a> {
    fn find(database: &'a Database, position: FilePosition, speed: f64) -> Option<Self> {
        let word = word_at(database, position)?;
        // A word that looks like a keyword begins an entity of its own; it is still only a word being typed.
        let at = database.entity_at(position.file, word.start)?;
        let at = match word.start.checked_sub(1) {
            Some(before) if at.span.start == word.start => database.entity_at(position.file, before)?,
            _ => at,
        };
        let start = at.span.start;
        let significant = at.parse.lexemes.iter().filter(|(token, _)| !token.is_comment());
        let at_end = !significant.clone().any(|(_, span)| span.start + start >= word.end);
        let before = significant.take_while(|(_, span)| span.end + start <= word.start).copied();
        Some(Self {
            at_end,
            database,
            file: position.file,
            entity: at.parse.entity.as_ref().map(|tree| (at.id, tree)),
            text: database.slice(position.file, at.span),
            before: before.collect(),
            speed,
            offset: word.start - start,
            word,
        })
    }

    fn complete(&self, expected: Expected, found: &mut Vec<Completion>) {
        match expected {
            Expected::Word(word) => found.extend(self.word(word)),
            Expected::ReferenceTo(kind) => found.extend(self.references(kind)),
            Expected::Action => found.extend(self.words(&[Token::Move, Token::Turn, Token::Slam], ACTIONS)),
            Expected::Declaration => found.extend(self.words(&BEGINNINGS, ENTITIES)),
            Expected::Port => found.push(self.value(&self.free_port(), "the next free port")),
            Expected::Address => found.push(self.value("127.0.0.1", "this machine")),
            Expected::Radius => found.push(self.value("4.5", "centimetres")),
            Expected::Distance | Expected::Speed | Expected::Angle | Expected::NameOf(_) | Expected::Path => {
            }
        }
    }

    /// A word, followed by those that can only follow it.
    fn word(&self, word: Token) -> Option<Completion> {
        let spelling = word.spelling().filter(|_| !matches!(word, Token::Comma))?;
        let Continued { insert, is_snippet, last } = self.continued(word);
        let label =
            insert.replace(" $0 ", " … ").replace("$0", "…").split_whitespace().collect::<Vec<_>>().join(" ");
        // `with` and braces say little by themselves; the word they lead to says it.
        let leads = matches!(word, Token::With | Token::Has | Token::OpenBrace | Token::CloseBrace);
        let page = keyword_page(if leads { last } else { word });
        Some(Completion {
            label: if word == Token::OpenBrace { label } else { label.trim_end_matches(" …").to_owned() },
            kind: CompletionKind::Keyword,
            detail: page
                .map_or_else(String::new, |page| page.syntax.lines().next().unwrap_or_default().to_owned()),
            documentation: page.map_or_else(|| format!("`{spelling}`"), |page| page.markdown()),
            replace: self.word,
            insert,
            is_snippet,
            rank: 1,
        })
    }

    /// `with` continues to `with port`, `has` to `has { $0 } wheels`: as long as only one word can follow, and nothing
    /// is written there yet.
    fn continued(&self, word: Token) -> Continued {
        const MOST: usize = 6;
        let mut before = self.before.clone();
        let insert = word.spelling().unwrap_or_default().to_owned();
        let mut continued = Continued { insert, is_snippet: false, last: word };
        for _ in 0..if self.at_end { MOST } else { 0 } {
            let end = Span::at(before.last().map_or(0, |(_, span)| span.end));
            before.push((continued.last, end));
            if continued.last == Token::OpenBrace && self.lists_names(&before) {
                continued.insert += " $0 }";
                continued.is_snippet = true;
                before.extend([(Token::Name, end), (Token::CloseBrace, end)]);
            }
            match expected_after(&self.text, &before)[..] {
                [Expected::Word(word)] if word != Token::Comma && word != Token::CloseBrace => {
                    continued.insert =
                        format!("{} {}", continued.insert, word.spelling().unwrap_or_default());
                    continued.last = word;
                }
                _ => break,
            }
        }
        continued
    }

    fn lists_names(&self, before: &[Lexeme]) -> bool {
        expected_after(&self.text, before).iter().any(|expected| matches!(expected, Expected::ReferenceTo(_)))
    }

    fn words(&self, words: &[Token], snippets: &[Snippet]) -> Vec<Completion> {
        let keywords = words.iter().filter_map(|word| {
            let spelling = word.spelling()?;
            let page = keyword_page(*word)?;
            Some(Completion {
                label: spelling.to_owned(),
                kind: CompletionKind::Keyword,
                detail: page.syntax.lines().next().unwrap_or_default().to_owned(),
                documentation: page.markdown(),
                replace: self.word,
                insert: spelling.to_owned(),
                is_snippet: false,
                rank: 1,
            })
        });
        let snippets = snippets.iter().map(|snippet| Completion {
            label: snippet.label.to_owned(),
            kind: CompletionKind::Snippet,
            detail: snippet.detail.to_owned(),
            documentation: format!("```pydslrep\n{}\n```", without_stops(&snippet.filled_in(self.speed))),
            replace: self.word,
            insert: snippet.filled_in(self.speed),
            is_snippet: true,
            rank: 2,
        });
        keywords.chain(snippets).collect()
    }

    fn value(&self, text: &str, detail: &str) -> Completion {
        Completion {
            label: text.to_owned(),
            kind: CompletionKind::Value,
            detail: detail.to_owned(),
            documentation: String::new(),
            replace: self.word,
            insert: text.to_owned(),
            is_snippet: false,
            rank: 0,
        }
    }

    fn free_port(&self) -> String {
        let ports = self.database.entities(self.file).filter_map(|entity| match &entity.parse.entity {
            Some(Entity::Robot(robot)) => robot.port.as_ref()?.value,
            _ => None,
        });
        let highest = ports.max().unwrap_or(FIRST_PORT - 1);
        highest.checked_add(1).unwrap_or(FIRST_PORT).to_string()
    }

    fn references(&self, kind: EntityKind) -> Vec<Completion> {
        let names = self.database.visible_names(self.file, kind);
        let taken = self.taken(kind);
        let wanted = names.iter().filter(|name| !taken.iter().any(|taken| taken == name.as_str()));
        let fitting =
            wanted.filter(|name| self.fits(kind, &Name { text: (*name).clone(), span: Span::default() }));
        let bodies = self.bodies(kind);
        fitting.map(|name| self.reference(kind, name, &bodies)).collect()
    }

    /// Where the entities of a kind stand, found in one walk over each file that is seen from here.
    fn bodies(&self, kind: EntityKind) -> HashMap<EntityId, (FileId, Span)> {
        let imported = self.database.imported_files(self.file);
        let files = std::iter::once(self.file).chain(imported);
        let of_kind = |entity: &EntityRef<'_>| {
            entity.parse.entity.as_ref().is_some_and(|tree| tree.kind() == Some(kind))
        };
        let entities = files.flat_map(|file| self.database.entities(file).filter(of_kind));
        entities.map(|entity| (entity.id, (entity.file, body(&entity)))).collect()
    }

    fn reference(
        &self,
        kind: EntityKind,
        name: &str,
        bodies: &HashMap<EntityId, (FileId, Span)>,
    ) -> Completion {
        let id = self.database.resolve(self.file, kind, &name.into()).entity();
        let preview = id.and_then(|id| bodies.get(&id)).map(|(file, body)| self.database.slice(*file, *body));
        let escaped = KEYWORDS.iter().any(|(token, word)| token.is_keyword() && *word == name);
        Completion {
            label: name.to_owned(),
            kind: CompletionKind::Reference(kind),
            detail: kind.noun().to_owned(),
            documentation: preview.map_or_else(String::new, |text| format!("```pydslrep\n{text}\n```")),
            replace: self.word,
            insert: if escaped { format!("^{name}") } else { name.to_owned() },
            is_snippet: false,
            rank: 0,
        }
    }

    /// The names that the list at the cursor has already. A movement may be listed again.
    fn taken(&self, kind: EntityKind) -> Vec<String> {
        let list = match self.entity.map(|(_, tree)| tree) {
            Some(Entity::Robot(robot)) if kind == EntityKind::Wheel => robot.wheels.as_ref(),
            Some(Entity::Robot(robot)) => robot.sensors.as_ref(),
            Some(Entity::Movement(movement)) if kind == EntityKind::Sensor => self.until_list(movement),
            Some(Entity::Environment(environment)) if kind == EntityKind::Robot => {
                environment.robots.as_ref()
            }
            _ => None,
        };
        let names = list.into_iter().flat_map(|list: &References| &list.names);
        // The word at the cursor is what is being replaced.
        names.filter(|name| name.span.start != self.offset).map(|name| name.text.to_string()).collect()
    }

    fn until_list<'m>(&self, movement: &'m Movement) -> Option<&'m References> {
        let around = |action: &&Action| action.span.touches(self.offset);
        movement.actions.iter().filter(around).find_map(Action::until)
    }

    /// Whether a name makes sense at the cursor.
    fn fits(&self, kind: EntityKind, name: &Name) -> bool {
        match (self.entity.map(|(_, tree)| tree), kind) {
            (Some(Entity::Robot(robot)), EntityKind::Wheel) => self.wheel_fits(robot, name),
            (Some(Entity::Movement(movement)), EntityKind::Sensor) => self.carries(movement, name),
            (Some(Entity::Environment(environment)), EntityKind::Movement) => {
                self.is_driven(environment.robots.as_ref(), name)
            }
            _ => true,
        }
    }

    fn wheel_fits(&self, robot: &Robot, name: &Name) -> bool {
        let Some(word) = robot.drive.and_then(|clause| clause.word) else { return true };
        match resolved(self.database, self.file, EntityKind::Wheel, name) {
            Some((_, Entity::Wheel(wheel))) => wheel.mecanum == (word == DriveWord::Fwh),
            _ => true,
        }
    }

    fn carries(&self, movement: &Movement, name: &Name) -> bool {
        let robot = movement
            .robot
            .as_ref()
            .and_then(|robot| resolved(self.database, self.file, EntityKind::Robot, robot));
        match robot {
            Some((_, Entity::Robot(robot))) => {
                robot.sensors.iter().flat_map(|list| &list.names).any(|sensor| sensor.text == name.text)
            }
            _ => true,
        }
    }

    fn is_driven(&self, robots: Option<&References>, name: &Name) -> bool {
        let movement = resolved(self.database, self.file, EntityKind::Movement, name);
        match (movement, robots) {
            (Some((_, Entity::Movement(movement))), Some(robots)) => movement
                .robot
                .as_ref()
                .is_none_or(|robot| robots.names.iter().any(|listed| listed.text == robot.text)),
            _ => true,
        }
    }
}

/// A word with those that can only follow it.
struct Continued {
    insert: String,
    is_snippet: bool,
    /// The last of the words.
    last: Token,
}

/// The first port offered: V-REP's.
const FIRST_PORT: u16 = 19999;

const BEGINNINGS: [Token; 9] = [
    Token::Wheel,
    Token::WheelH,
    Token::Sensor,
    Token::Ip,
    Token::Robot,
    Token::Movement,
    Token::Parallel,
    Token::Environment,
    Token::Import,
];

/// The word before and behind the cursor; `None` inside comments and strings, where nothing is completed.
fn word_at(database: &Database, position: FilePosition) -> Option<Span> {
    let entity = database.entity_at(position.file, position.offset)?;
    let offset = position.offset - entity.span.start;
    let covering = |(_, span): &&Lexeme| span.start < offset && offset <= span.end;
    let Some((token, span)) = entity.parse.lexemes.iter().find(covering) else {
        return Some(Span::at(position.offset));
    };
    let ends_before = span.end == offset;
    let in_comment = token.is_comment() && !(*token == Token::BlockComment && ends_before);
    let in_string = *token == Token::UnterminatedString || (*token == Token::String && !ends_before);
    if in_comment || in_string {
        return None;
    }
    let is_word = token.is_name() || token.is_keyword();
    Some(if is_word { span.shifted(entity.span.start) } else { Span::at(position.offset) })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor};

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let rendered = completions(&database, position, 9.0).into_iter().map(|item| {
            let replaced = database.slice(position.file, item.replace);
            format!("{} [{}] {replaced:?} -> {:?}\n", item.label, item.detail, item.insert)
        });
        expected.assert_eq(&rendered.collect::<String>());
    }

    #[test]
    fn an_empty_file_offers_declarations() {
        check(
            "$0",
            &expect![[r#"
                environment [environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]] "" -> "environment"
                import [import "FILE.pyr"] "" -> "import"
                ip [ip NAME 127.0.0.1] "" -> "ip"
                movement [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "movement"
                parallel [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "parallel"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "" -> "robot"
                sensor [sensor NAME [: distance | bumper]] "" -> "sensor"
                wheel [wheel NAME with radius CENTIMETRES] "" -> "wheel"
                wheelH [wheelH NAME with radius CENTIMETRES] "" -> "wheelH"
                environment … [a whole environment] "" -> "environment ${1:area} has { ${2:rover} } robots with { ${3:patrol} } moves"
                ip … [a whole address] "" -> "ip ${1:lab} ${2:127.0.0.1}"
                movement … [a whole movement] "" -> "movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                parallel movement … [a movement that runs beside others] "" -> "parallel movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                robot … [a whole robot] "" -> "robot ${1:rover} type ${2:tw} with port ${3:19999} has { ${4:wheelL wheelR} } wheels"
                sensor … [a whole sensor] "" -> "sensor ${1:front}"
                wheel … [a whole wheel] "" -> "wheel ${1:wheelL} with radius ${2:4.5}"
                wheelH … [a whole mecanum wheel] "" -> "wheelH ${1:wheelLF} with radius ${2:4.5}"
            "#]],
        );
    }

    #[test]
    fn words_bring_those_that_must_follow() {
        check(
            "wheel w $0",
            &expect![[r#"
                with radius [with radius CENTIMETRES] "" -> "with radius"
            "#]],
        );
        check(
            &format!("{PARTS}robot r $0"),
            &expect![[r#"
                type [type tw | fw | fwh] "" -> "type"
                with port [with port NUMBER] "" -> "with port"
            "#]],
        );
        check(
            &format!("{PARTS}robot r with port 1 $0"),
            &expect![[r#"
                has { … } wheels [has { WHEELS } wheels] "" -> "has { $0 } wheels"
            "#]],
        );
        check(
            &format!("{PARTS}environment e $0"),
            &expect![[r#"
                has { … } robots [has { ROBOTS } robots] "" -> "has { $0 } robots"
                with ip [ip NAME 127.0.0.1] "" -> "with ip"
            "#]],
        );
        check(
            "robot r type $0",
            &expect![[r#"
            fw with port [type tw | fw | fwh] "" -> "fw with port"
            fwh with port [type tw | fw | fwh] "" -> "fwh with port"
            tw with port [type tw | fw | fwh] "" -> "tw with port"
        "#]],
        );
        check(
            "robot r with port $0",
            &expect![[r#"
            19999 [the next free port] "" -> "19999"
        "#]],
        );
    }

    #[test]
    fn words_bring_nothing_that_is_there_already() {
        check(
            &format!("{PARTS}robot r type $0 with port 1 has {{ wheelL wheelR }} wheels"),
            &expect![[r#"
            fw [type tw | fw | fwh] "" -> "fw"
            fwh [type tw | fw | fwh] "" -> "fwh"
            tw [type tw | fw | fwh] "" -> "tw"
        "#]],
        );
        check(
            &format!("{PARTS}robot r with port 1 h$0 {{ wheelL wheelR }} wheels"),
            &expect![[r#"
            has [has { … }] "h" -> "has"
        "#]],
        );
    }

    #[test]
    fn a_list_offers_what_it_does_not_have() {
        check(
            &format!("{PARTS}robot r type tw with port 1 has {{ wheelL $0 }} wheels"),
            &expect![[r#"
                wheelR [wheel] "" -> "wheelR"
                } [] "" -> "}"
            "#]],
        );
        check(
            &format!("{PARTS}robot r type fwh with port 1 has {{ $0 }} wheels"),
            &expect![[r#"
                } [] "" -> "}"
            "#]],
        );
        check(
            &format!("{PARTS}robot r type tw with port 1 has {{ wheelL whe$0 }} wheels"),
            &expect![[r#"
                wheelR [wheel] "whe" -> "wheelR"
                } [] "whe" -> "}"
            "#]],
        );
    }

    #[test]
    fn a_turn_offers_its_robots_sensors() {
        check(
            &format!("{PARTS}movement m of rover {{ turn left until {{ $0"),
            &expect![[r#"
            front [sensor] "" -> "front"
            } [] "" -> "}"
        "#]],
        );
    }

    #[test]
    fn an_environment_offers_its_robots_movements() {
        check(
            &format!(
                "{PARTS}robot other with port 2 has {{ wheelL wheelR }} wheels movement m of rover {{ slam }} movement n of other {{ slam }}\nenvironment e has {{ rover }} robots with {{ $0"
            ),
            &expect![[r#"
                m [movement] "" -> "m"
                } moves [with { MOVEMENTS } moves] "" -> "} moves"
            "#]],
        );
    }

    #[test]
    fn a_distance_is_followed_by_its_unit() {
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 $0 }}"),
            &expect![[r#"
                centimeters [move DISTANCE centimeters] "" -> "centimeters"
                meters [move DISTANCE meters | centimeters [at SPEED]] "" -> "meters"
            "#]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 me$0 turn left }}"),
            &expect![[r#"
                centimeters [move DISTANCE centimeters] "me" -> "centimeters"
                meters [move DISTANCE meters | centimeters [at SPEED]] "me" -> "meters"
            "#]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 meters $0 }}"),
            &expect![[r#"
                at [move DISTANCE meters | centimeters [at SPEED]] "" -> "at"
                move [move DISTANCE meters | centimeters [at SPEED]] "" -> "move"
                slam [slam] "" -> "slam"
                turn [turn left | right [DEGREES]] "" -> "turn"
                } [] "" -> "}"
                move … centimeters at … [straight ahead, with a speed] "" -> "move ${1:50} centimeters at ${2:9.0}"
                move … meters [straight ahead] "" -> "move ${1:1.0} meters"
                turn left [in place] "" -> "turn left ${1:90}"
                turn right [in place] "" -> "turn right ${1:90}"
                turn … until [until the way is free] "" -> "turn ${1:right} until { $0 }"
            "#]],
        );
    }

    #[test]
    fn a_half_typed_keyword_is_a_word() {
        check(
            "wheel w with radius 4\nrobot$0",
            &expect![[r#"
                environment [environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]] "robot" -> "environment"
                import [import "FILE.pyr"] "robot" -> "import"
                ip [ip NAME 127.0.0.1] "robot" -> "ip"
                movement [[parallel] movement NAME of ROBOT { ACTIONS }] "robot" -> "movement"
                parallel [[parallel] movement NAME of ROBOT { ACTIONS }] "robot" -> "parallel"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "robot" -> "robot"
                sensor [sensor NAME [: distance | bumper]] "robot" -> "sensor"
                wheel [wheel NAME with radius CENTIMETRES] "robot" -> "wheel"
                wheelH [wheelH NAME with radius CENTIMETRES] "robot" -> "wheelH"
                environment … [a whole environment] "robot" -> "environment ${1:area} has { ${2:rover} } robots with { ${3:patrol} } moves"
                ip … [a whole address] "robot" -> "ip ${1:lab} ${2:127.0.0.1}"
                movement … [a whole movement] "robot" -> "movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                parallel movement … [a movement that runs beside others] "robot" -> "parallel movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                robot … [a whole robot] "robot" -> "robot ${1:rover} type ${2:tw} with port ${3:19999} has { ${4:wheelL wheelR} } wheels"
                sensor … [a whole sensor] "robot" -> "sensor ${1:front}"
                wheel … [a whole wheel] "robot" -> "wheel ${1:wheelL} with radius ${2:4.5}"
                wheelH … [a whole mecanum wheel] "robot" -> "wheelH ${1:wheelLF} with radius ${2:4.5}"
            "#]],
        );
    }

    #[test]
    fn nothing_is_offered_for_names_and_in_comments() {
        check("wheel $0", &expect![]);
        check("// a$0", &expect![]);
        check("import \"$0", &expect![]);
        check("import \"a$0\"", &expect![]);
    }
}
