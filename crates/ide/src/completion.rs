//! Completion: what the grammar allows at the cursor, and of names only those that make sense there.
//!
//! Which words fit is asked of the parser itself ([`expected_after`]), so it cannot drift from the language.

mod documentation;
mod names;
mod paths;
mod place;
mod snippets;
mod words;

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::{EntityKind, Expected, Span, TextEdit, Token, expected_after};

pub use self::documentation::completion_documentation;
use self::place::Place;
use self::snippets::{ACTIONS, ENTITIES, SPEEDS, without_stops};
use crate::FilePosition;

/// No more are given at once: a long list takes an editor longer than whoever reads it.
const MOST: usize = 200;

/// What fits at a place.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Completions {
    /// The best first.
    pub items: Vec<Completion>,
    /// Whether there are more, of which others may be better once more is typed.
    pub is_incomplete: bool,
}

/// One thing to complete with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// What the list shows.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// A few words beside the label.
    pub detail: String,
    /// What there is to say of it.
    pub documentation: Documentation,
    /// What it replaces: the word at the cursor.
    pub replace: Span,
    /// What it inserts; with `$1`, `${1:text}` and `$0` for the cursor's stops if `is_snippet`.
    pub insert: String,
    /// Whether `insert` has stops.
    pub is_snippet: bool,
    /// Whether the word at the cursor begins with `^`, so that what is typed is like `insert` and not like `label`.
    pub is_escaped: bool,
    /// The file that this brings into sight, which was not before.
    pub imports: Option<FileId>,
    /// What has to change elsewhere in the file for that.
    pub import_edit: Option<TextEdit>,
    /// Its place in the list, before its place among those of the same rank.
    pub(crate) rank: Rank,
}

impl Completion {
    /// One that inserts its label, with nothing more to say of it.
    pub(crate) fn new(label: &str, kind: CompletionKind, replace: Span) -> Self {
        Self {
            label: label.to_owned(),
            kind,
            detail: String::new(),
            documentation: Documentation::Text(String::new()),
            replace,
            insert: label.to_owned(),
            is_snippet: false,
            is_escaped: false,
            imports: None,
            import_edit: None,
            rank: Rank::Fitting,
        }
    }

    /// What it inserts where there are no stops.
    pub fn plain(&self) -> String {
        if self.is_snippet { without_stops(&self.insert) } else { self.insert.clone() }
    }
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
    /// The path of a file.
    File,
    /// The name of an entity.
    Reference(EntityKind),
    /// A key or a table of a settings file.
    Setting,
}

/// What there is to say of a completion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Documentation {
    /// Markdown; perhaps nothing.
    Text(String),
    /// What [`completion_documentation`] says of what a file declares: it takes longer, and only one is looked at.
    Of(FileId, EntityKind),
}

/// Names, then words, then whole patterns, then what is not in sight yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rank {
    Fitting,
    Word,
    Closing,
    Pattern,
    Elsewhere,
}

/// What fits at a place; `speed` is for patterns with one, in centimetres per second.
pub fn completions(database: &Database, position: FilePosition, speed: f64) -> Completions {
    let mut found = Completions::default();
    if let Some(string) = paths::string_at(database, position) {
        found.items = paths::paths(database, position.file, &string);
    } else if let Some(place) = Place::find(database, position, speed) {
        for expected in expected_after(&place.text, &place.before) {
            complete(&place, expected, &mut found);
        }
    }
    found.items.sort_by_key(|item| item.rank);
    found
}

fn complete(place: &Place<'_>, expected: Expected, found: &mut Completions) {
    match expected {
        Expected::Word(word) => {
            found.items.extend(words::word(place, word));
            if word == Token::At {
                found.items.extend(words::patterns(place, SPEEDS));
            }
        }
        Expected::ReferenceTo(kind) => names::names(place, kind, found),
        Expected::Action => {
            found.items.extend(words::plain_words(place, &[Token::Move, Token::Turn, Token::Slam]));
            found.items.extend(words::patterns(place, ACTIONS));
        }
        Expected::Declaration => {
            let words = if place.may_import() { &BEGINNINGS[..] } else { &BEGINNINGS[1..] };
            found.items.extend(words::plain_words(place, words));
            found.items.extend(words::patterns(place, ENTITIES));
        }
        Expected::Port => {
            let port = words::free_port(place);
            found.items.extend(port.map(|port| words::value(place, &port, "the next free port")));
        }
        Expected::Address => found.items.push(words::value(place, "127.0.0.1", "this machine")),
        Expected::Radius => found.items.push(words::value(place, "4.5", "centimetres")),
        Expected::Speed => {
            found.items.push(words::value(place, &format!("{:?}", place.speed), "centimetres per second"));
        }
        Expected::Path => found.items.extend(paths::quoted_paths(place)),
        Expected::Distance | Expected::Angle | Expected::NameOf(_) => {}
    }
}

const BEGINNINGS: [Token; 9] = [
    Token::Import,
    Token::Wheel,
    Token::WheelH,
    Token::Sensor,
    Token::Ip,
    Token::Robot,
    Token::Movement,
    Token::Parallel,
    Token::Environment,
];

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor, at_cursor_in};

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let rendered = completions(&database, position, 9.0).items.into_iter().map(|item| {
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
                import [import "FILE.pyr"] "" -> "import"
                wheel [wheel NAME with radius CENTIMETRES] "" -> "wheel"
                wheelH [wheelH NAME with radius CENTIMETRES] "" -> "wheelH"
                sensor [sensor NAME [: distance | bumper]] "" -> "sensor"
                ip [ip NAME 127.0.0.1] "" -> "ip"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "" -> "robot"
                movement [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "movement"
                parallel [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "parallel"
                environment [environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]] "" -> "environment"
                wheel … [a whole wheel] "" -> "wheel ${1:wheelL} with radius ${2:4.5}"
                wheelH … [a whole mecanum wheel] "" -> "wheelH ${1:wheelLF} with radius ${2:4.5}"
                sensor … [a whole sensor] "" -> "sensor ${1:front}"
                ip … [a whole address] "" -> "ip ${1:lab} ${2:127.0.0.1}"
                robot … [a whole robot] "" -> "robot ${1:rover} type ${2:tw} with port ${3:19999} has { ${4:wheelL wheelR} } wheels"
                movement … [a whole movement] "" -> "movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                parallel movement … [a movement that runs beside others] "" -> "parallel movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                environment … [a whole environment] "" -> "environment ${1:area} has { ${2:rover} } robots with { ${3:patrol} } moves"
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
                with port [with port NUMBER] "" -> "with port"
                type [type tw | fw | fwh] "" -> "type"
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
                with ip [ip NAME 127.0.0.1] "" -> "with ip"
                has { … } robots [has { ROBOTS } robots] "" -> "has { $0 } robots"
            "#]],
        );
        check(
            "robot r type $0",
            &expect![[r#"
                tw with port [Two-wheel differential drive] "" -> "tw with port"
                fw with port [Four-wheel skid-steer drive] "" -> "fw with port"
                fwh with port [Mecanum drive] "" -> "fwh with port"
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
                tw [Two-wheel differential drive] "" -> "tw"
                fw [Four-wheel skid-steer drive] "" -> "fw"
                fwh [Mecanum drive] "" -> "fwh"
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
                meters [move DISTANCE meters | centimeters [at SPEED]] "" -> "meters"
                centimeters [move DISTANCE centimeters] "" -> "centimeters"
            "#]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 me$0 turn left }}"),
            &expect![[r#"
                meters [move DISTANCE meters | centimeters [at SPEED]] "me" -> "meters"
                centimeters [move DISTANCE centimeters] "me" -> "centimeters"
            "#]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 meters $0 }}"),
            &expect![[r#"
                at [move DISTANCE meters | centimeters [at SPEED]] "" -> "at"
                move [move DISTANCE meters | centimeters [at SPEED]] "" -> "move"
                turn [turn left | right [DEGREES]] "" -> "turn"
                slam [slam] "" -> "slam"
                } [] "" -> "}"
                at … [a speed in centimetres per second] "" -> "at ${1:9.0}"
                move … meters [straight ahead] "" -> "move ${1:1.0} meters"
                move … centimeters at … [straight ahead, with a speed] "" -> "move ${1:50} centimeters at ${2:9.0}"
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
                wheel [wheel NAME with radius CENTIMETRES] "robot" -> "wheel"
                wheelH [wheelH NAME with radius CENTIMETRES] "robot" -> "wheelH"
                sensor [sensor NAME [: distance | bumper]] "robot" -> "sensor"
                ip [ip NAME 127.0.0.1] "robot" -> "ip"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "robot" -> "robot"
                movement [[parallel] movement NAME of ROBOT { ACTIONS }] "robot" -> "movement"
                parallel [[parallel] movement NAME of ROBOT { ACTIONS }] "robot" -> "parallel"
                environment [environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]] "robot" -> "environment"
                wheel … [a whole wheel] "robot" -> "wheel ${1:wheelL} with radius ${2:4.5}"
                wheelH … [a whole mecanum wheel] "robot" -> "wheelH ${1:wheelLF} with radius ${2:4.5}"
                sensor … [a whole sensor] "robot" -> "sensor ${1:front}"
                ip … [a whole address] "robot" -> "ip ${1:lab} ${2:127.0.0.1}"
                robot … [a whole robot] "robot" -> "robot ${1:rover} type ${2:tw} with port ${3:19999} has { ${4:wheelL wheelR} } wheels"
                movement … [a whole movement] "robot" -> "movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                parallel movement … [a movement that runs beside others] "robot" -> "parallel movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}"
                environment … [a whole environment] "robot" -> "environment ${1:area} has { ${2:rover} } robots with { ${3:patrol} } moves"
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

    fn check_in(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let rendered = completions(&database, position, 9.0).items.into_iter().map(|item| {
            let replaced = database.slice(position.file, item.replace);
            let import = item.import_edit.map(|edit| format!(" and {:?} at {}", edit.text, edit.span.start));
            let import = import.unwrap_or_default();
            format!("{} [{}] {replaced:?} -> {:?}{import}\n", item.label, item.detail, item.insert)
        });
        expected.assert_eq(&rendered.collect::<String>());
    }

    #[test]
    fn names_of_other_files_bring_their_import() {
        let wheels = ("lib/wheels.pyr", "wheel big with radius 9 wheelH round with radius 9");
        let more = ("more.pyr", "wheel ^type with radius 1 wheel big with radius 2");
        check_in(
            &[wheels, more, ("a.pyr", "import \"more.pyr\"\nrobot r type tw with port 1 has { $0 } wheels")],
            &expect![[r#"
                big [wheel from more.pyr] "" -> "big"
                type [wheel from more.pyr] "" -> "^type"
                } [] "" -> "}"
            "#]],
        );
        check_in(
            &[wheels, more, ("a.pyr", "// head\nimport \"more.pyr\"\nrobot r with port 1 has { rou$0")],
            &expect![[r#"
                big [wheel from more.pyr] "rou" -> "big"
                type [wheel from more.pyr] "rou" -> "^type"
                } wheels [has { WHEELS } wheels] "rou" -> "} wheels"
                round [wheel from lib/wheels.pyr, adds the import] "rou" -> "round" and "import \"lib/wheels.pyr\"\n" at 8
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "\u{feff}robot r type fwh with port 1 has { $0 } wheels")],
            &expect![[r#"
            } [] "" -> "}"
            round [wheel from lib/wheels.pyr, adds the import] "" -> "round" and "import \"lib/wheels.pyr\"\n\n" at 3
        "#]],
        );
    }

    #[test]
    fn imports_offer_the_files_there_are() {
        let files =
            |last| [("lib/wheels.pyr", "wheel big with radius 9"), ("b.pyr", ""), ("lib/a.pyr", last)];
        check_in(
            &files("import \"$0\""),
            &expect![[r#"
            wheels.pyr [1 wheel] "" -> "wheels.pyr"
            ../b.pyr [declares nothing] "" -> "../b.pyr"
        "#]],
        );
        check_in(
            &files("import \"whe$0\nsensor s"),
            &expect![[r#"
            wheels.pyr [1 wheel] "whe" -> "wheels.pyr\""
            ../b.pyr [declares nothing] "whe" -> "../b.pyr\""
        "#]],
        );
        check_in(
            &files("import \"wheels.pyr\" import $0"),
            &expect![[r#"
            "../b.pyr" [declares nothing] "" -> "\"../b.pyr\""
        "#]],
        );
    }

    #[test]
    fn keywords_as_names_are_escaped() {
        check(
            "sensor ^robots robot r with port 1 has { } wheels with sensors { ro$0",
            &expect![[r#"
            robots [sensor] "ro" -> "^robots"
        "#]],
        );
        check(
            "sensor ^robots sensor s robot r with port 1 has { } wheels with sensors { ^$0 }",
            &expect![[r#"
            robots [sensor] "^" -> "^robots"
            s [sensor] "^" -> "s"
        "#]],
        );
    }

    #[test]
    fn a_port_that_is_free() {
        check(
            "robot r with port 65535 has { } wheels robot q with port $0",
            &expect![[r#"
            19999 [the next free port] "" -> "19999"
        "#]],
        );
        check(
            "robot r with port 20000 has { } wheels robot q with port $0",
            &expect![[r#"
            20001 [the next free port] "" -> "20001"
        "#]],
        );
    }

    #[test]
    fn a_number_is_left_alone() {
        check("movement m of r { move 4$0.0 meters }", &expect![]);
        check(
            "movement m of r { move 4$0 }",
            &expect![[r#"
            meters [move DISTANCE meters | centimeters [at SPEED]] "" -> " meters"
            centimeters [move DISTANCE centimeters] "" -> " centimeters"
        "#]],
        );
        check(
            "movement m of r { move 4 meters at $0 }",
            &expect![[r#"
                9.0 [centimetres per second] "" -> "9.0"
            "#]],
        );
    }

    #[test]
    fn the_likeliest_wheels_come_first() {
        check(
            "wheel a with radius 9 wheel b with radius 4 wheel c with radius 4 wheel d with radius 4 wheelH e with radius 4\n\
             robot q with port 1 has { b } wheels robot r with port 1 has { c $0 } wheels",
            &expect![[r#"
                d [wheel] "" -> "d"
                b [wheel] "" -> "b"
                a [wheel] "" -> "a"
                } [] "" -> "}"
            "#]],
        );
        check(
            "wheelH a with radius 4 wheelH b with radius 4 wheelH c with radius 4 wheelH d with radius 4\n\
             robot r type $0 with port 1 has { a b c d } wheels",
            &expect![[r#"
                fwh [Mecanum drive] "" -> "fwh"
                tw [Two-wheel differential drive] "" -> "tw"
                fw [Four-wheel skid-steer drive] "" -> "fw"
            "#]],
        );
    }

    #[test]
    fn a_list_is_as_long_as_anybody_reads() {
        let many: Vec<String> = (0..5_000).map(|number| format!("sensor s{number}")).collect();
        let many = many.join("\n");
        let found = |typed: &str| {
            let (database, position) = at_cursor(&format!(
                "sensor zz\n{many}\nsensor near robot r with port 1 has {{ }} wheels with sensors {{ {typed}$0"
            ));
            let found = completions(&database, position, 9.0);
            let labels: Vec<String> = found.items.into_iter().map(|item| item.label).collect();
            (labels, found.is_incomplete)
        };
        let (labels, is_incomplete) = found("");
        assert_eq!((labels.len(), is_incomplete), (MOST, true));
        assert!(labels.contains(&"near".to_owned()), "what is declared right before");
        let (labels, is_incomplete) = found("s4321");
        assert_eq!((&labels[..], is_incomplete), (&["s4321".to_owned()][..], false));
        assert_eq!(found("Z").0, ["zz"]);
    }

    #[test]
    fn a_name_says_what_it_is_when_it_is_looked_at() {
        let (database, position) = at_cursor(&format!("{PARTS}movement m of $0"));
        let item = completions(&database, position, 9.0).items.remove(0);
        let Documentation::Of(home, kind) = item.documentation else { panic!("{item:?}") };
        expect![[r#"
            ```pydslrep
            robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }
            ```
            Two-wheel differential drive (`tw`), port 23000."#]]
        .assert_eq(&completion_documentation(&database, home, kind, &item.label.into()).unwrap_or_default());
    }
}
