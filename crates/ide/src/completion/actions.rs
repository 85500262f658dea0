//! Snippets of actions and of their clauses. Their placeholders hold what the last ones like them have
//! ([`super::defaults`]).

use pydslrep_syntax::TokenKind;
use pydslrep_syntax::ast::{Direction, SensorState, Unit};

use super::Completion;
use super::context::CompletionContext;
use super::defaults::{Defaults, LastTurn};
use super::names;
use super::snippets::{Snippet, completions, tab_stop};

/// A block with the last tab stop in it.
const BLOCK: &str = "{\n  $0\n}";

/// What stands for other text in the examples of actions.
const SENSORS: &str = "{ SENSORS }";
const ACTIONS: &str = "{ ACTIONS }";
const MOVEMENT: &str = "MOVEMENT";

/// Complete actions, those like the last action of their kind first.
pub(super) fn actions(context: &CompletionContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_part(context);
    let (moves, turns) = (moves(&defaults), turns(&defaults));
    // Moves and turns usually alternate.
    let moves_and_turns = if defaults.follows_a_move() { [turns, moves] } else { [moves, turns] };
    let mut others = TokenKind::ACTIONS;
    others.sort_by_key(|keyword| *keyword != TokenKind::Repeat);
    let others = others.into_iter().flat_map(|keyword| examples(context, &defaults, keyword));
    completions(context, moves_and_turns.into_iter().flatten().chain(others).collect())
}

/// `{ front }`, for the robot's sensors; `None` if it has none.
fn list(defaults: &Defaults<'_>) -> Option<String> {
    let sensors = defaults.sensors_to_wait_for();
    (!sensors.is_empty()).then(|| format!("{{ {} }}", tab_stop(1, &sensors.join(", "))))
}

/// `{ front } detect`
fn condition(defaults: &Defaults<'_>, state: SensorState) -> Option<String> {
    Some(format!("{} {}", list(defaults)?, state_word(state)))
}

fn state_word(state: SensorState) -> &'static str {
    let token = match state {
        SensorState::Clear => TokenKind::Clear,
        SensorState::Detect => TokenKind::Detect,
    };
    token.spelling().unwrap_or_default()
}

/// The examples of an action that have a detail, each with a tab stop for what differs.
fn examples(context: &CompletionContext<'_>, defaults: &Defaults<'_>, keyword: TokenKind) -> Vec<Snippet> {
    let examples = keyword.examples().iter().zip(keyword.details());
    let snippet = |(example, detail): (&&str, &&'static str)| {
        let (placeholder, stop) = stop(context, defaults, keyword, example)?;
        let label = example.replace(placeholder, "…").replace(ACTIONS, "{ … }");
        let insert = example.replace(placeholder, &stop).replace(ACTIONS, BLOCK);
        Some(Snippet::new(&label, detail, insert))
    };
    examples.filter_map(snippet).collect()
}

/// What stands in an example for something else, and the tab stop for that; `None` if there is nothing to write there.
fn stop<'e>(
    context: &CompletionContext<'_>,
    defaults: &Defaults<'_>,
    keyword: TokenKind,
    example: &'e str,
) -> Option<(&'e str, String)> {
    if example.contains(SENSORS) {
        return Some((SENSORS, list(defaults)?));
    }
    if example.contains(MOVEMENT) {
        // To look at all movements takes time.
        let is_wanted = keyword.spelling().is_some_and(|word| word.starts_with(&context.typed));
        let first = is_wanted.then(|| names::to_do(context).into_iter().next())??;
        return Some((MOVEMENT, tab_stop(1, &pydslrep_syntax::escape(&first))));
    }
    let number = example.split(' ').find(|word| word.starts_with(|c: char| c.is_ascii_digit()))?;
    let last = defaults.last_number(keyword);
    Some((number, tab_stop(1, last.as_deref().unwrap_or(number))))
}

fn moves(defaults: &Defaults<'_>) -> Vec<Snippet> {
    let last = defaults.last_move();
    let mut shapes =
        [(Unit::Meters, false), (Unit::Centimeters, false), (Unit::Meters, true), (Unit::Centimeters, true)];
    shapes.sort_by_key(|(unit, with_speed)| (*unit != last.unit, *with_speed != last.speed.is_some()));
    let speed = defaults.speed();
    let snippet = |(unit, with_speed): (Unit, bool)| {
        let (word, other) = match unit {
            Unit::Meters => (TokenKind::Meters, "1.0"),
            Unit::Centimeters => (TokenKind::Centimeters, "50"),
        };
        let word = word.spelling().unwrap_or_default();
        let distance = last.distance.as_deref().filter(|_| unit == last.unit).unwrap_or(other);
        let insert = format!("move ${{1:{distance}}} {word}");
        if with_speed {
            let label = format!("move … {word} at …");
            Snippet::new(&label, "straight ahead at this speed (cm/s)", format!("{insert} at ${{2:{speed}}}"))
        } else {
            Snippet::new(&format!("move … {word}"), "straight ahead", insert)
        }
    };
    let mut snippets: Vec<Snippet> = shapes.map(snippet).into();
    if let Some(condition) = condition(defaults, SensorState::Detect) {
        let detail = "straight ahead until a sensor detects an obstacle";
        let until = Snippet::new("move until … detect", detail, format!("move until {condition}"));
        snippets.insert(if last.is_until { 0 } else { snippets.len() }, until);
    }
    snippets
}

fn turns(defaults: &Defaults<'_>) -> Vec<Snippet> {
    let last = defaults.last_turn();
    let sensors = defaults.sensors_to_wait_for();
    let shapes = [Direction::Left, Direction::Right]
        .map(|direction| [(direction, false), (direction, true)])
        .into_iter()
        .flatten();
    let mut shapes: Vec<(Direction, bool)> = shapes.collect();
    let is_unlike = |(direction, with_angle): &(_, bool)| {
        (*with_angle != last.angle.is_some(), *direction != last.direction)
    };
    shapes.sort_by_key(is_unlike);
    let angle = last.angle.as_deref().unwrap_or("90");
    let snippet = |(direction, with_angle)| {
        let word = spelling(direction);
        if with_angle {
            let label = format!("turn {word} …");
            Snippet::new(&label, "in place by this angle (degrees)", format!("turn {word} ${{1:{angle}}}"))
        } else {
            Snippet::new(&format!("turn {word}"), "in place by 90 degrees", format!("turn {word}"))
        }
    };
    let mut snippets: Vec<Snippet> = shapes.into_iter().map(snippet).collect();
    let arcs = arcs(defaults, &last, angle);
    let place = if last.is_on_circle { 0 } else { snippets.len() };
    snippets.splice(place..place, arcs);
    if sensors.is_empty() {
        return snippets;
    }
    let word = spelling(last.direction);
    let until = Snippet::new(
        &format!("turn {word} until …"),
        "in place until no sensor detects an obstacle",
        format!("turn {word} until {{ {} }}", tab_stop(1, &sensors.join(", "))),
    );
    snippets.insert(if last.is_until { 0 } else { snippets.len() }, until);
    snippets
}

/// On a circle, first to the side of the last turn.
fn arcs(defaults: &Defaults<'_>, last: &LastTurn, angle: &str) -> Vec<Snippet> {
    let other = match last.direction {
        Direction::Left => Direction::Right,
        Direction::Right => Direction::Left,
    };
    let (radius, unit) = defaults.last_radius();
    let arc = |direction| {
        let word = spelling(direction);
        let insert = format!("turn {word} ${{1:{angle}}} with radius ${{2:{radius}}} {unit}");
        Snippet::new(&format!("turn {word} … with radius …"), "on a circle", insert)
    };
    [last.direction, other].map(arc).into()
}

fn spelling(direction: Direction) -> &'static str {
    let token = match direction {
        Direction::Left => TokenKind::Left,
        Direction::Right => TokenKind::Right,
    };
    token.spelling().unwrap_or_default()
}

/// The optional speed clause of a `move` or `turn`.
pub(super) fn speed(context: &CompletionContext<'_>) -> Vec<Completion> {
    let insert = format!("at ${{1:{}}}", Defaults::for_part(context).speed());
    completions(context, vec![Snippet::new("at …", "a speed (cm/s)", insert)])
}

/// The circle of a `turn`.
pub(super) fn circle(context: &CompletionContext<'_>) -> Vec<Completion> {
    let (radius, unit) = Defaults::for_part(context).last_radius();
    let insert = format!("with radius ${{1:{radius}}} {unit}");
    completions(context, vec![Snippet::new("with radius …", "on a circle", insert)])
}

/// Completions for the words that end an action or a `repeat`.
pub(super) fn until(context: &CompletionContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_part(context);
    let snippet = |state| {
        let insert = format!("until {}", condition(&defaults, state)?);
        let (label, detail) = match state {
            SensorState::Clear => ("until … clear", "until no sensor detects an obstacle"),
            SensorState::Detect => ("until … detect", "until a sensor detects an obstacle"),
        };
        Some(Snippet::new(label, detail, insert))
    };
    let mut states = [SensorState::Detect, SensorState::Clear];
    // A robot waits, and turns, until the way is free.
    if context.statement_begins_with(&[TokenKind::Wait, TokenKind::Turn]) {
        states.reverse();
    }
    completions(context, states.into_iter().filter_map(snippet).collect())
}

/// The rest of a `repeat`, if its block is not there yet.
pub(super) fn rounds(context: &CompletionContext<'_>) -> Vec<Completion> {
    // The keyword is before the number.
    let keyword = context.before.iter().rev().nth(1);
    let has_block = keyword.is_none_or(|(word, _)| !word.is_action() || word.begins_block());
    if context.next_token() == Some(TokenKind::OpenBrace) || !has_block {
        return Vec::new();
    }
    completions(context, vec![Snippet::new("times { … }", "what is repeated", format!("times {BLOCK}"))])
}

/// Completions for the block that runs if the condition does not hold.
pub(super) fn otherwise(context: &CompletionContext<'_>) -> Vec<Completion> {
    let snippet =
        Snippet::new("else { … }", "what is done if the condition does not hold", format!("else {BLOCK}"));
    completions(context, vec![snippet])
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::completion::testing::{asked, labels_in};
    use crate::fixture::PARTS;

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

    /// Clauses are not actions of their own.
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
}
