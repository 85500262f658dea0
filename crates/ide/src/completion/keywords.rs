//! Keywords, with the ones that must follow them, and values.

use pydslrep_analysis::{EntityId, Target};
use pydslrep_syntax::ast::{Drive, Entity};
use pydslrep_syntax::{EntityKind, Expected, Span, TokenKind, expected_after};

use super::context::CompletionContext;
use super::defaults::likely_list;
use super::names::{MAX_RANKED, NEARBY_ENTITIES};
use super::snippets::tab_stop;
use super::{Completion, CompletionKind, Documentation, Rank};
use crate::cursor::is_mecanum;
use crate::keyword_pages::{KeywordPage, keyword_page};

impl CompletionContext<'_> {
    /// An item that replaces the word at the cursor.
    pub(super) fn item(&self, label: &str, kind: CompletionKind, rank: Rank) -> Completion {
        Completion {
            insert: label.to_owned(),
            is_escaped: self.is_escaped,
            rank,
            ..Completion::new(label, kind, self.word)
        }
    }
}

/// A keyword with the ones that must follow it; `None` for the comma, which is always optional.
pub(super) fn keyword(context: &CompletionContext<'_>, word: TokenKind) -> Option<Completion> {
    let spelling = word.spelling().filter(|_| word != TokenKind::Comma)?;
    let Continuation { insert, label, last } = continuation(context, word);
    let label = if word == TokenKind::OpenBrace { &label } else { label.trim_end_matches(" …") };
    // `with` and braces say little by themselves: the page of the last keyword is more helpful.
    let leads =
        matches!(word, TokenKind::With | TokenKind::Has | TokenKind::OpenBrace | TokenKind::CloseBrace);
    let page = keyword_page(if leads { last } else { word });
    let rank = match word {
        TokenKind::CloseBrace => Rank::Closing,
        // A condition is more likely to continue.
        TokenKind::OpenBrace if context.movement().is_some() => Rank::Closing,
        _ if matches_wheels(context, word) => Rank::Fitting,
        _ => Rank::Keyword,
    };
    Some(Completion {
        detail: page.map_or_else(String::new, |page| detail(word, &page)),
        documentation: Documentation::Text(
            page.map_or_else(|| format!("`{spelling}`"), |page| page.markdown()),
        ),
        is_snippet: insert.contains('$'),
        insert,
        ..context.item(label, CompletionKind::Keyword, rank)
    })
}

/// For the values of `type`, their meaning; otherwise the syntax.
fn detail(word: TokenKind, page: &KeywordPage) -> String {
    match word.drive() {
        Some(drive) => drive.row().label.to_owned(),
        None => page.syntax.lines().next().unwrap_or_default().to_owned(),
    }
}

/// Returns whether a keyword is the drive type that the robot's wheels imply.
fn matches_wheels(context: &CompletionContext<'_>, word: TokenKind) -> bool {
    let (Some(drive), Some(Entity::Robot(robot))) = (word.drive(), context.tree) else { return false };
    let names = robot.wheels.iter().flat_map(|list| &list.names);
    let mecanum: Vec<bool> =
        names.filter_map(|name| is_mecanum(context.database, context.file, &name.text)).collect();
    Drive::from_wheels(&mecanum) == Some(drive)
}

/// A keyword with the ones that must follow it.
struct Continuation {
    insert: String,
    /// The same with `…` for placeholders.
    label: String,
    /// The last of the keywords.
    last: TokenKind,
}

impl Continuation {
    fn push(&mut self, insert: &str, label: &str) {
        self.insert.extend([" ", insert]);
        self.label.extend([" ", label]);
    }
}

/// `with` continues to `with port`, `has` to `has { … } wheels`, as long as only one keyword can follow and nothing is
/// there yet.
fn continuation(context: &CompletionContext<'_>, word: TokenKind) -> Continuation {
    const MAX_KEYWORDS: usize = 6;
    let mut before = context.before.clone();
    let spelling = word.spelling().unwrap_or_default().to_owned();
    let mut continued = Continuation { insert: spelling.clone(), label: spelling, last: word };
    let max_count = if context.at_end { MAX_KEYWORDS } else { usize::from(leads_on(context, word)) };
    for _ in 0..max_count {
        let end = Span::at(before.last().map_or(0, |(_, span)| span.end));
        before.push((continued.last, end));
        let mut expected = expected_after(&context.text, &before);
        if let Some(kind) = listed_kind(continued.last, &expected) {
            continued.push(&tab_stop(1, &likely_list(context, kind)), "…");
            continued.push("}", "}");
            before.extend([(TokenKind::Name, end), (TokenKind::CloseBrace, end)]);
            expected = expected_after(&context.text, &before);
        }
        match expected[..] {
            // The block is a snippet of its own.
            [Expected::Word(TokenKind::OpenBrace)] if continued.last == TokenKind::Times => break,
            [Expected::Word(word)] if word != TokenKind::Comma && word != TokenKind::CloseBrace => {
                let spelling = word.spelling().unwrap_or_default();
                continued.push(spelling, spelling);
                continued.last = word;
            }
            _ => break,
        }
    }
    continued
}

/// Returns whether a keyword of a statement inserts the next one as well, although more of the movement follows.
fn leads_on(context: &CompletionContext<'_>, word: TokenKind) -> bool {
    let next = match word {
        TokenKind::With => TokenKind::Radius,
        TokenKind::In => TokenKind::Reverse,
        _ => return false,
    };
    context.movement().is_some() && context.next_token() != Some(next)
}

/// The kind of the references in a list that begins here.
fn listed_kind(last: TokenKind, expected: &[Expected]) -> Option<EntityKind> {
    let kind = expected.iter().find_map(|expected| match expected {
        Expected::ReferenceTo(kind) => Some(*kind),
        _ => None,
    });
    kind.filter(|_| last == TokenKind::OpenBrace)
}

/// Keywords without continuation.
pub(super) fn plain_keywords(context: &CompletionContext<'_>, words: &[TokenKind]) -> Vec<Completion> {
    let word = |word: &TokenKind| {
        let page = keyword_page(*word)?;
        Some(Completion {
            detail: detail(*word, &page),
            documentation: Documentation::Text(page.markdown()),
            ..context.item(word.spelling()?, CompletionKind::Keyword, Rank::Keyword)
        })
    };
    words.iter().filter_map(word).collect()
}

/// A number or an address.
pub(super) fn value(context: &CompletionContext<'_>, text: &str, detail: &str) -> Completion {
    Completion { detail: detail.to_owned(), ..context.item(text, CompletionKind::Value, Rank::Fitting) }
}

/// A port for the robot `own`, or for a new one: the port that all others share, as they may in CoppeliaSim; otherwise
/// the one after the highest, or the first free one.
pub(super) fn port(context: &CompletionContext<'_>, own: Option<EntityId>) -> Option<String> {
    let target = context.database.target(context.file);
    let port = |id: EntityId| match context.database.tree(id)? {
        Entity::Robot(robot) if Some(id) != own => robot.port.as_ref()?.value,
        _ => None,
    };
    let mut taken: Vec<u16> = if context.database.count(context.file, EntityKind::Robot) as usize > MAX_RANKED
    {
        let near = context.database.entities_around(context.file, context.word.start, NEARBY_ENTITIES);
        near.filter_map(port).collect()
    } else {
        let robots = context.database.names_in_sight(context.file, EntityKind::Robot);
        let found = |name| context.database.resolve(context.file, EntityKind::Robot, name).entity();
        robots.filter_map(found).filter_map(port).collect()
    };
    taken.sort_unstable();
    taken.dedup();
    let first = target.default_port();
    let port = match taken[..] {
        [] => Some(first),
        [shared] if target != Target::VRep => Some(shared),
        [.., highest] => highest.checked_add(1),
    };
    let free = |port: &u16| taken.binary_search(port).is_err();
    port.or_else(|| (first..=u16::MAX).chain(1..first).find(free)).map(|port| port.to_string())
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::completion::testing::{check, opens};
    use crate::fixture::PARTS;

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
}
