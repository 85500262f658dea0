//! Completion: what the grammar allows at the cursor, and only the names that fit there.
//!
//! The parser itself says which keywords fit ([`expected_after`]), so completion cannot drift from the language.

mod actions;
mod context;
mod defaults;
mod documentation;
mod edition;
pub(crate) mod filter;
mod keywords;
mod names;
mod paths;
mod snippets;

use pydslrep_analysis::{Database, Edition, FileId};
use pydslrep_syntax::{EntityKind, Expected, Quantity, Span, TextEdit, TokenKind, expected_after};

use self::context::CursorContext;
pub use self::documentation::completion_documentation;
use self::snippets::plain_text;
use crate::FilePosition;

/// The maximum number of items in a list: long lists are slow in editors, and nobody reads them.
const MAX_ITEMS: usize = 200;

/// What triggered a completion request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionTrigger {
    /// The user has asked for the list.
    Invoked,
    /// A letter of a word: the list opens automatically, or is open already.
    Letter,
    /// Punctuation or a space. A list opens automatically only where one of its items must come next.
    Character(char),
}

/// A completion item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// The text shown in the list.
    pub label: String,
    /// Its kind.
    pub kind: CompletionKind,
    /// A short description next to the label.
    pub detail: String,
    /// The documentation shown for it.
    pub documentation: Documentation,
    /// The text it replaces: the word at the cursor.
    pub replace: Span,
    /// The text it inserts; with tab stops (`$1`, `${1:text}`, `$0`) if `is_snippet`.
    pub insert: String,
    /// Whether `insert` has tab stops.
    pub is_snippet: bool,
    /// Whether the word at the cursor begins with `^`, so that editors must filter by `insert` rather than by `label`.
    pub is_escaped: bool,
    /// The file that it imports, for a name that is not visible yet.
    pub imports: Option<FileId>,
    /// The edit that adds the import.
    pub import_edit: Option<TextEdit>,
    /// The primary sort key; items of one rank keep their order.
    pub(crate) rank: Rank,
}

impl Completion {
    /// An item that inserts its label.
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

    /// The inserted text without tab stops.
    pub fn plain(&self) -> String {
        if self.is_snippet { plain_text(&self.insert) } else { self.insert.clone() }
    }
}

/// The kind of a completion item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionKind {
    /// A keyword, possibly with the ones that must follow it.
    Keyword,
    /// A complete entity or action with placeholders.
    Snippet,
    /// A number or an address.
    Value,
    /// The path of a file.
    File,
    /// The name of an entity.
    Reference(EntityKind),
    /// A key or a table of a TOML file.
    Setting,
}

/// The documentation of a completion item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Documentation {
    /// Markdown; may be empty.
    Text(String),
    /// A declaration in a file, documented by [`completion_documentation`] on request: it costs more, and users look at
    /// few items.
    Of(FileId, EntityKind),
}

/// Names first, then snippets, keywords, closing braces, and names that need an import.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rank {
    Fitting,
    Snippet,
    Keyword,
    Closing,
    Elsewhere,
}

/// The completions at a position, best first; `speed` is the default for snippets, in centimetres per second.
///
/// Clients must request the list again after every typed character, since it depends on the typed prefix.
pub fn completions(
    database: &Database,
    position: FilePosition,
    trigger: CompletionTrigger,
    speed: f64,
) -> Vec<Completion> {
    if let Some(string) = paths::string_at(database, position) {
        let items = match trigger {
            _ if database.edition(position.file) == Edition::Article => Vec::new(),
            CompletionTrigger::Invoked
            | CompletionTrigger::Letter
            | CompletionTrigger::Character('"' | '/') => paths::paths(database, position.file, &string),
            CompletionTrigger::Character(_) => Vec::new(),
        };
        return filter_at(database, position, items, trigger);
    }
    let Some(context) = CursorContext::find(database, position, speed) else { return Vec::new() };
    let expected = expected_after(&context.text, &context.before);
    let opens = match trigger {
        CompletionTrigger::Invoked => true,
        CompletionTrigger::Letter => !context.is_whole_name(&expected),
        CompletionTrigger::Character('^') => context.is_escaped,
        CompletionTrigger::Character(' ') => context.needs_name(),
        CompletionTrigger::Character(_) => false,
    };
    if !opens {
        return Vec::new();
    }
    let may_end =
        expected.iter().any(|expected| matches!(expected, Expected::Action | Expected::Declaration));
    let mut items: Vec<Completion> = Vec::new();
    for expected in expected {
        let is_clause = may_end && matches!(expected, Expected::Word(word) if word != TokenKind::CloseBrace);
        let is_name = matches!(expected, Expected::ReferenceTo(_));
        if is_name || matches!(trigger, CompletionTrigger::Invoked | CompletionTrigger::Letter) {
            let mut found = items_for(&context, expected);
            edition::retain(&context, expected, &mut found);
            if is_clause {
                // On the same line, continuing the statement is more likely; on a new line, starting another one.
                let rank = if context.begins_line() { Rank::Closing } else { Rank::Fitting };
                for item in &mut found {
                    item.rank = rank;
                }
            }
            items.extend(found);
        }
    }
    items.sort_by_key(|item| item.rank);
    filter_at(database, position, items, trigger)
}

/// Drops the items that would get in the way of typing. All of them replace the same word.
fn filter_at(
    database: &Database,
    position: FilePosition,
    items: Vec<Completion>,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(word) = items.first().map(|item| item.replace) else { return items };
    let slice = |start, end| database.slice(position.file, Span::new(start, end));
    let (before, after) = (slice(word.start, position.offset), slice(position.offset, word.end));
    let ends_line = database.text(position.file).is_none_or(|text| {
        let following = text.get_byte_slice(word.end as usize..);
        following.is_none_or(|following| filter::ends_line(following.chars()))
    });
    filter::filter(items, filter::Word { before: &before, after: &after, ends_line }, trigger)
}

fn items_for(context: &CursorContext<'_>, expected: Expected) -> Vec<Completion> {
    match expected {
        Expected::Word(word) => {
            let mut found = clauses(context, word);
            found.extend(keywords::keyword(context, word));
            found
        }
        Expected::ReferenceTo(kind) => names::names(context, kind),
        Expected::Action => {
            let mut found = actions::actions(context);
            found.extend(keywords::plain_keywords(context, &TokenKind::ACTIONS));
            found
        }
        Expected::Declaration => {
            let mut found = snippets::entities(context);
            let words = TokenKind::DECLARATIONS.into_iter();
            let words: Vec<_> =
                words.filter(|word| *word != TokenKind::Import || context.may_import()).collect();
            found.extend(keywords::plain_keywords(context, &words));
            found
        }
        Expected::Port => {
            let port = keywords::port(context, context.entity);
            port.map(|port| keywords::value(context, &port, "simulator port")).into_iter().collect()
        }
        Expected::Address => vec![keywords::value(context, "127.0.0.1", "this machine")],
        Expected::Number(Quantity::Radius) => vec![keywords::value(context, "4.5", "centimetres")],
        Expected::Number(Quantity::Speed) => {
            vec![keywords::value(context, &format!("{:?}", context.speed), "centimetres per second")]
        }
        Expected::Path => paths::quoted_paths(context),
        Expected::Number(_) | Expected::NameOf(_) => Vec::new(),
    }
}

/// The clauses of actions that a keyword begins, with placeholders.
fn clauses(context: &CursorContext<'_>, word: TokenKind) -> Vec<Completion> {
    match word {
        TokenKind::At => actions::speed(context),
        TokenKind::With if context.movement().is_some() => actions::circle(context),
        TokenKind::Until => actions::until(context),
        TokenKind::Else => actions::otherwise(context),
        TokenKind::Times => actions::rounds(context),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor, at_cursor_in};

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let rendered =
            completions(&database, position, CompletionTrigger::Invoked, 9.0).into_iter().map(|item| {
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
                program … [a two-wheel robot, a movement and an environment] "" -> "wheel wheelL with radius ${4:4.5}\nwheel wheelR with radius ${4:4.5}\n\nrobot ${1:rover} type tw with port ${5:23000} has { wheelL wheelR } wheels\n\nmovement ${2:patrol} of ${1:rover} {\n  move ${6:1.0} meters\n  $0\n}\n\nenvironment ${3:yard} has { ${1:rover} } robots with { ${2:patrol} } moves\n"
                wheel … [a complete wheel declaration] "" -> "wheel ${1:wheelL} with radius ${2:4.5}"
                wheelH … [a complete mecanum wheel declaration] "" -> "wheelH ${1:wheelL} with radius ${2:4.5}"
                sensor … [a complete sensor declaration] "" -> "sensor ${1:front}"
                ip … [a complete address declaration] "" -> "ip ${1:lab} ${2:127.0.0.1}"
                robot … [a complete robot declaration] "" -> "robot ${1:rover} type ${5:tw} with port ${4:23000} has { $2 } wheels"
                movement … [a complete movement declaration] "" -> "movement ${1:patrol} of $2 {\n  $0\n}"
                parallel movement … [a movement that runs at the same time as others] "" -> "parallel movement ${1:patrol} of $2 {\n  $0\n}"
                environment … [a complete environment declaration] "" -> "environment ${1:area} has { $2 } robots with { $3 } moves"
                import [import "FILE.pyr"] "" -> "import"
                wheel [wheel NAME with radius CENTIMETRES] "" -> "wheel"
                wheelH [wheelH NAME with radius CENTIMETRES] "" -> "wheelH"
                sensor [sensor NAME [: distance | bumper]] "" -> "sensor"
                ip [ip NAME 127.0.0.1] "" -> "ip"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "" -> "robot"
                movement [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "movement"
                parallel [[parallel] movement NAME of ROBOT { ACTIONS }] "" -> "parallel"
                environment [environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]] "" -> "environment"
            "#]],
        );
    }

    #[test]
    fn keywords_bring_those_that_must_follow() {
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
                has { … } wheels [has { WHEELS } wheels] "" -> "has { ${1:wheelL wheelR} } wheels"
            "#]],
        );
        check(
            &format!("{PARTS}environment e $0"),
            &expect![[r#"
                with ip [ip NAME 127.0.0.1] "" -> "with ip"
                has { … } robots [has { ROBOTS } robots] "" -> "has { ${1:rover} } robots"
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
                23000 [simulator port] "" -> "23000"
            "#]],
        );
    }

    #[test]
    fn keywords_bring_nothing_that_is_already_there() {
        check(
            &format!("{PARTS}robot r type $0 with port 1 has {{ wheelL wheelR }} wheels"),
            &expect![[r#"
                tw [Two-wheel differential drive] "" -> "tw"
                fw [Four-wheel skid-steer drive] "" -> "fw"
                fwh [Mecanum drive] "" -> "fwh"
            "#]],
        );
    }

    #[test]
    fn a_list_offers_names_it_does_not_have_yet() {
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
            "#]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ move 4.0 meters $0 }}"),
            &expect![[r#"
                at … [a speed (cm/s)] "" -> "at ${1:9.0}"
                at [move DISTANCE meters | centimeters [at SPEED]] "" -> "at"
                until … detect [until a sensor detects an obstacle] "" -> "until { ${1:front} } detect"
                until … clear [until no sensor detects an obstacle] "" -> "until { ${1:front} } clear"
                until [until { SENSORS } clear | detect [within DISTANCE meters | centimeters]] "" -> "until"
                turn left [in place by 90 degrees] "" -> "turn left"
                turn right [in place by 90 degrees] "" -> "turn right"
                turn left … [in place by this angle (degrees)] "" -> "turn left ${1:90}"
                turn right … [in place by this angle (degrees)] "" -> "turn right ${1:90}"
                turn left … with radius … [on a circle] "" -> "turn left ${1:90} with radius ${2:1.0} meters"
                turn right … with radius … [on a circle] "" -> "turn right ${1:90} with radius ${2:1.0} meters"
                turn left until … [in place until no sensor detects an obstacle] "" -> "turn left until { ${1:front} }"
                move … meters [straight ahead] "" -> "move ${1:4.0} meters"
                move … meters at … [straight ahead at this speed (cm/s)] "" -> "move ${1:4.0} meters at ${2:9.0}"
                move … centimeters [straight ahead] "" -> "move ${1:50} centimeters"
                move … centimeters at … [straight ahead at this speed (cm/s)] "" -> "move ${1:50} centimeters at ${2:9.0}"
                move until … detect [straight ahead until a sensor detects an obstacle] "" -> "move until { ${1:front} } detect"
                repeat … times { … } [a number of times] "" -> "repeat ${1:4} times {\n  $0\n}"
                repeat until … detect { … } [until a sensor detects an obstacle] "" -> "repeat until { ${1:front} } detect {\n  $0\n}"
                wait … seconds [stands still] "" -> "wait ${1:2} seconds"
                wait until … clear [stands still until no sensor detects an obstacle] "" -> "wait until { ${1:front} } clear"
                if … detect { … } [only if a sensor detects an obstacle] "" -> "if { ${1:front} } detect {\n  $0\n}"
                move [move DISTANCE meters | centimeters [at SPEED]] "" -> "move"
                turn [turn left | right [DEGREES] [with radius DISTANCE meters | centimeters] [at SPEED] [in reverse]] "" -> "turn"
                wait [wait SECONDS seconds] "" -> "wait"
                repeat [repeat COUNT times { ACTIONS }] "" -> "repeat"
                if [if { SENSORS } clear | detect [within DISTANCE meters | centimeters] { ACTIONS } [else { ACTIONS }]] "" -> "if"
                do [do MOVEMENT] "" -> "do"
                slam [slam] "" -> "slam"
                } [] "" -> "}"
            "#]],
        );
    }

    #[test]
    fn a_half_typed_keyword_is_a_word() {
        check(
            "wheel w with radius 4\nrob$0",
            &expect![[r#"
                robot … [a complete robot declaration] "rob" -> "robot ${1:rover} type ${5:tw} with port ${4:23000} has { $2 } wheels"
                robot [robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]] "rob" -> "robot"
            "#]],
        );
    }

    /// The list that opens automatically after the character before the cursor.
    fn opens(fixture: &str) -> Vec<String> {
        let (database, position) = at_cursor(fixture);
        let typed = fixture[..position.offset as usize].chars().last().unwrap();
        let is_letter = typed.is_alphanumeric() || typed == '_';
        let trigger = if is_letter { CompletionTrigger::Letter } else { CompletionTrigger::Character(typed) };
        completions(&database, position, trigger, 9.0).into_iter().map(|item| item.label).collect()
    }

    #[test]
    fn the_list_opens_automatically_where_a_name_must_follow() {
        assert_eq!(opens(&format!("{PARTS}movement m of $0")), ["rover"]);
        assert_eq!(opens(&format!("{PARTS}robot r with port 1 has {{ $0 }} wheels")), ["wheelL", "wheelR"]);
        assert_eq!(opens(&format!("{PARTS}robot r type tw with port 1 has {{ wheelL $0 }}")), ["wheelR"]);
        assert_eq!(opens(&format!("{PARTS}environment e has {{ $0 }}")), ["rover"]);
        assert_eq!(opens(&format!("{PARTS}movement m of rover {{ turn left until {{ $0 }} }}")), ["front"]);
        assert_eq!(opens("ip lab 127.0.0.1 environment e with ip $0"), ["lab"]);
        assert_eq!(
            opens(&format!("{PARTS}robot r with port 1 has {{ }} wheels with sensors {{ back, $0 }}")),
            ["front"]
        );
    }

    #[test]
    fn no_list_opens_automatically_anywhere_else() {
        let in_movement = |action: &str| format!("{PARTS}movement m of rover {{{action}");
        let robot = |rest: &str| format!("{PARTS}robot r type tw {rest}");
        let fixtures = [
            in_movement("$0}"),
            in_movement(" $0 }"),
            in_movement(" move $0 }"),
            in_movement(" move 2 $0 }"),
            in_movement(" move 2$0 }"),
            in_movement(" move 2 meters $0 }"),
            in_movement(" move 2 meters at 12$0 }"),
            in_movement(" turn $0 }"),
            in_movement(" turn left $0 }"),
            in_movement(" turn left 90$0 }"),
            robot("$0"),
            robot("with port $0"),
            robot("with port 23000 $0"),
            robot("with port 23000 has {$0"),
            robot("with port 23000 has { wheelL wheelR $0"),
            robot("with port 23000 has { $0 wheelL wheelR }"),
            robot("with port 23000 has { wheelL wheelR } wheels $0"),
            format!("{PARTS}movement m of $0 rover"),
            format!("{PARTS}environment e has {{ rover $0 }}"),
            format!("{PARTS}environment e has {{ rover }} robots $0"),
            "wheel w $0".to_owned(),
            "wheel w with radius 4.5$0".to_owned(),
            "wheel w with radius 4.5 $0".to_owned(),
            "wheel w$0".to_owned(),
            "import $0".to_owned(),
            "// of $0".to_owned(),
        ];
        for fixture in fixtures {
            assert_eq!(opens(&fixture), [""; 0], "{fixture}");
        }
    }

    #[test]
    fn a_word_that_is_complete_is_left_alone() {
        let in_movement = |action: &str| format!("{PARTS}movement m of rover {{ {action} }}");
        let fixtures = [
            in_movement("move 2 meters$0"),
            in_movement("move 2 centimeters$0"),
            in_movement("turn left$0"),
            in_movement("slam$0"),
            in_movement("turn left until { front$0 }"),
            format!("{PARTS}robot r with port 1 has {{ wheelL wheelR }} wheels$0"),
            format!("{PARTS}wheel wheelL2 with radius 4.5 robot r with port 1 has {{ wheelL$0 }}"),
            format!("{PARTS}movement m of rover$0"),
            "wheel$0".to_owned(),
            "sensor s : bumper$0".to_owned(),
        ];
        for fixture in fixtures {
            assert_eq!(opens(&fixture), [""; 0], "{fixture}");
        }
    }

    #[test]
    fn a_word_inside_a_line_is_offered_until_it_is_complete() {
        let fixture = |typed: &str| format!("{PARTS}movement m of {typed}$0 {{ slam }}");
        assert_eq!(opens(&fixture("rove")), ["rover"]);
        assert_eq!(opens(&fixture("rover")), [""; 0]);
    }

    /// The list that the user asks for.
    fn asked(fixture: &str) -> Vec<String> {
        let (database, position) = at_cursor(fixture);
        let found = completions(&database, position, CompletionTrigger::Invoked, 9.0);
        found.into_iter().map(|item| item.label).collect()
    }

    const SIMILAR: &str = "wheel abc with radius 4.5\nwheel ab with radius 4.5\nwheel a2 with radius 4.5\nwheel a with radius 4.5\n";

    #[test]
    fn no_list_opens_at_a_name_that_others_begin_with() {
        let inside = |list: &str| format!("{SIMILAR}robot r with port 1 has {{\n  {list}");
        for list in
            ["a$0", "ab$0", "a\n  ab$0", "a\n  ab\n  a2$0 } wheels", "ab$0 } wheels", "a$0 ab } wheels"]
        {
            assert_eq!(opens(&inside(list)), [""; 0], "{list}");
        }
        assert_eq!(opens(&inside("a ab$0 ab")), [""; 0], "a name that the list has already");
    }

    #[test]
    fn a_list_that_is_asked_for_begins_with_the_exact_name() {
        let inside = |list: &str| format!("{SIMILAR}robot r with port 1 has {{\n  {list}");
        assert_eq!(asked(&inside("ab$0")), ["ab", "abc"]);
        assert_eq!(asked(&inside("a$0")), ["a", "a2", "ab", "abc"]);
        assert_eq!(asked(&format!("{PARTS}movement m of rover {{ move 2 meters$0 }}")), ["meters"]);
    }

    #[test]
    fn the_exact_name_is_among_the_first_of_very_many() {
        let many: Vec<String> = (0..3_000).map(|number| format!("sensor s{number}")).collect();
        let many = many.join("\n");
        let list = format!("{many}\nrobot r with port 1 has {{ }} wheels with sensors {{ s2999, s2$0");
        let found = asked(&list);
        assert_eq!((found[0].as_str(), found.len()), ("s2", MAX_ITEMS));
    }

    #[test]
    fn the_list_closes_before_the_word_is_complete() {
        let fixture = |typed: &str| format!("{PARTS}movement m of rover {{ move 2 {typed}$0");
        assert_eq!(opens(&fixture("me")), ["meters"]);
        assert_eq!(opens(&fixture("met")), [""; 0]);
        assert_eq!(opens(&fixture("meter")), [""; 0]);
    }

    #[test]
    fn prefixes_come_before_subwords() {
        let wheels = "wheel bigWheel with radius 9 wheel wheel_right with radius 9 wheel left with radius 9";
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ w$0")), ["wheel_right", "bigWheel"]);
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ ri$0")), ["wheel_right"]);
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ heel$0")), [""; 0]);
    }

    #[test]
    fn clauses_are_offered_for_their_first_word_only() {
        let robot = |typed: &str| {
            format!("{PARTS}robot r type tw with port 1 has {{ wheelL wheelR }} wheels\n{typed}$0")
        };
        assert_eq!(opens(&robot("w")), ["wheel …", "wheelH …", "wheel", "wheelH", "with sensors { … }"]);
        assert_eq!(opens(&robot("s")), ["sensor …", "sensor"]);
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
        let rendered =
            completions(&database, position, CompletionTrigger::Invoked, 9.0).into_iter().map(|item| {
                let replaced = database.slice(position.file, item.replace);
                let import =
                    item.import_edit.map(|edit| format!(" and {:?} at {}", edit.text, edit.span.start));
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
            &[wheels, more, ("a.pyr", "// head\nimport \"more.pyr\"\nrobot r with port 1 has { r$0")],
            &expect![[r#"
                round [wheel from lib/wheels.pyr, adds the import] "r" -> "round" and "import \"lib/wheels.pyr\"\n" at 8
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "wheel rear with radius 1\nrobot r with port 1 has { r$0")],
            &expect![[r#"
                rear [wheel] "r" -> "rear"
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "wheelH rear with radius 1\nrobot r type tw with port 1 has { $0")],
            &expect![[r#"
                } wheels [has { WHEELS } wheels] "" -> "} wheels"
                big [wheel from lib/wheels.pyr, adds the import] "" -> "big" and "import \"lib/wheels.pyr\"\n\n" at 0
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
    fn imports_offer_existing_files() {
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
                65535 [simulator port] "" -> "65535"
            "#]],
        );
        check(
            "robot r with port 20000 has { } wheels robot q with port $0",
            &expect![[r#"
                20000 [simulator port] "" -> "20000"
            "#]],
        );
    }

    #[test]
    fn a_number_is_left_alone() {
        check("movement m of r { move 4$0.0 meters }", &expect![]);
        check("movement m of r { move 4$0 }", &expect![""]);
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
    fn lists_have_a_maximum_length() {
        let many: Vec<String> = (0..5_000).map(|number| format!("sensor s{number:04}end")).collect();
        let many = many.join("\n");
        let found = |typed: &str| {
            let (database, position) = at_cursor(&format!(
                "sensor zigzag\n{many}\nsensor near robot r with port 1 has {{ }} wheels with sensors {{ {typed}$0"
            ));
            let found = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            found.into_iter().map(|item| item.label).collect::<Vec<String>>()
        };
        let labels = found("");
        assert_eq!(labels.len(), MAX_ITEMS);
        assert!(labels.contains(&"near".to_owned()), "the nearest declaration");
        assert_eq!(found("s4321end"), ["s4321end"]);
        assert_eq!(found("s432").iter().filter(|label| label.starts_with("s432")).count(), 10);
        assert_eq!(found("Z"), ["zigzag"]);
    }

    #[test]
    fn a_name_is_documented_on_request() {
        let (database, position) = at_cursor(&format!("{PARTS}movement m of $0"));
        let item = completions(&database, position, CompletionTrigger::Invoked, 9.0).remove(0);
        let Documentation::Of(home, kind) = item.documentation else { panic!("{item:?}") };
        expect![[r#"
            ```pydslrep
            robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }
            ```
            Two-wheel differential drive (`tw`), port 23000."#]]
        .assert_eq(&completion_documentation(&database, home, kind, &item.label.into()).unwrap_or_default());
    }

    /// The labels of the items in a movement of `rover`.
    fn labels_in(action: &str) -> Vec<String> {
        asked(&format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{\n  {action}"))
    }

    #[test]
    fn each_clause_is_offered_in_its_place() {
        let fixtures = [
            "wait 2 $0",
            "wait until { front } $0",
            "wait until { front } clear within 2 $0",
            "repeat 4 $0",
            "repeat 4 $0\n}",
            "repeat 4 $0 { slam }",
            "repeat 4 times $0",
            "if { front } $0",
            "if { front } clear $0",
            "turn left 90 with $0",
            "turn left 90 with radius 2 meters in $0",
            "wait $0",
        ];
        let shown = |fixture: &&str| format!("{fixture:?}: {:?}\n", labels_in(fixture));
        let shown: String = fixtures.iter().map(shown).collect();
        expect![[r#"
            "wait 2 $0": ["seconds"]
            "wait until { front } $0": ["clear", "detect", "within", "move … meters", "move … meters at …", "move … centimeters", "move … centimeters at …", "move until … detect", "turn left", "turn right", "turn left …", "turn right …", "turn left … with radius …", "turn right … with radius …", "turn left until …", "repeat … times { … }", "repeat until … detect { … }", "wait … seconds", "wait until … clear", "if … detect { … }", "do …", "move", "turn", "wait", "repeat", "if", "do", "slam", "}"]
            "wait until { front } clear within 2 $0": ["meters", "centimeters"]
            "repeat 4 $0": ["times { … }", "times"]
            "repeat 4 $0\n}": ["times { … }", "times"]
            "repeat 4 $0 { slam }": ["times"]
            "repeat 4 times $0": ["{"]
            "if { front } $0": ["clear", "detect", "within", "{"]
            "if { front } clear $0": ["within", "{"]
            "turn left 90 with $0": ["radius"]
            "turn left 90 with radius 2 meters in $0": ["reverse"]
            "wait $0": ["until … clear", "until … detect", "until { … }"]
        "#]].assert_eq(&shown);
    }

    /// Those that are no actions of their own.
    #[test]
    fn clauses_come_before_the_next_action() {
        let first =
            |fixture: &str, count: usize| labels_in(fixture).into_iter().take(count).collect::<Vec<_>>();
        assert_eq!(
            first("turn left 90 $0", 8),
            [
                "with radius …",
                "with radius",
                "at …",
                "at",
                "until … clear",
                "until … detect",
                "until { … }",
                "in reverse"
            ]
        );
        assert_eq!(first("if { front } clear { slam } $0", 2), ["else { … }", "else"]);
        assert_eq!(first("wait 2 seconds $0 }", 3), ["until … clear", "until … detect", "until"]);
        assert_eq!(first("move until { front } $0", 3), ["clear", "detect", "within"]);
    }

    #[test]
    fn do_offers_movements_of_the_same_robot_that_do_not_lead_back() {
        let movements = format!(
            "{PARTS}robot other type tw with port 1 has {{ wheelL wheelR }} wheels\n\
             movement leg of rover {{ slam }}\nmovement back of rover {{ repeat 2 times {{ do m }} }}\n\
             movement far of rover {{ do back }}\nmovement foreign of other {{ slam }}\n\
             movement done of rover {{ do leg }}\n"
        );
        let inside = |actions: &str| format!("{movements}movement m of rover {{ {actions}");
        assert_eq!(asked(&inside("do $0")), ["done", "leg"]);
        assert_eq!(asked(&inside("do d$0 wait 1 seconds }")), ["done"]);
        assert_eq!(opens(&inside("repeat 2 times { do $0 } }")), ["done", "leg"]);
        assert_eq!(asked(&inside("if { front } clear { slam } else { do $0")), ["done", "leg"]);
        // Names, not actions.
        assert_eq!(opens(&inside("turn left until { do $0 }")), [""; 0]);
        assert_eq!(opens(&inside("do leg $0 }")), [""; 0]);
    }

    #[test]
    fn words_of_statements_are_offered_only_where_they_fit() {
        for fixture in
            ["turn left until { $0 } }", "turn left until { w$0 } }", "repeat $0", "do $0", "wait 2 s$0 x"]
        {
            let found = labels_in(fixture);
            let words = ["wait", "repeat", "if", "do", "else", "clear", "detect", "times", "within"];
            assert!(!found.iter().any(|label| words.contains(&label.as_str())), "{fixture}: {found:?}");
        }
        for fixture in ["sensor re$0", "wheel wai$0", "robot i$0", "movement d$0", "movement m of cl$0 {"] {
            assert_eq!(asked(&format!("{PARTS}{fixture}")), [""; 0], "{fixture}");
        }
        let names = "sensor wait sensor clear robot r type tw with port 1 has { } wheels with sensors { wait clear }\n";
        assert_eq!(
            asked(&format!("{names}movement m of r {{ if {{ $0 }} clear {{ slam }} }}")),
            ["wait", "clear"]
        );
    }

    #[test]
    fn no_list_opens_automatically_where_a_new_statement_may_be_complete() {
        for action in [
            "wait $0",
            "wait 2 $0",
            "wait 2 seconds $0",
            "wait until { front } $0",
            "wait until { front } clear $0",
            "repeat $0",
            "repeat 4 $0",
            "repeat 4 times $0",
            "repeat 4 times { $0 }",
            "if { front } clear { slam } $0",
            "if { front } clear { slam } else $0",
            "turn left 90 with $0",
            "move 1 meters until { front } detect within 2 $0",
            "wait 2 seconds$0",
            "repeat 4 times$0",
            "if { front } clear$0",
            "do side$0",
            "if$0",
            "do$0",
            "wait$0",
            "repeat$0",
        ] {
            let fixture =
                format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{\n  {action}\n}}");
            assert_eq!(opens(&fixture), [""; 0], "{action}");
        }
    }
}
