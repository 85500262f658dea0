//! Patterns to fill in: whole entities, whole actions, and the clauses that follow some keywords. What they are filled
//! with is what the program makes likely ([`super::defaults`]).

use pydslrep_syntax::ast::{Direction, Unit};
use pydslrep_syntax::{EntityKind, TokenKind};

use super::defaults::Defaults;
use super::context::CursorContext;
use super::keywords::port;
use super::{Completion, CompletionKind, Documentation, Rank};

/// A pattern to fill in.
struct Pattern {
    label: String,
    detail: &'static str,
    insert: String,
}

impl Pattern {
    fn new(label: &str, detail: &'static str, insert: String) -> Self {
        Self { label: label.to_owned(), detail, insert }
    }
}

/// Whole entities, in the order of the grammar; of the two kinds of wheel, the one declared last comes first.
pub(super) fn entities(place: &CursorContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_entity(place);
    let mut patterns = Vec::new();
    if place.database.entities(place.file).all(|entity| entity.parse.entity.is_none()) {
        patterns.push(program(place));
    }
    if place.may_import() && !super::paths::not_imported(place.database, place.file).is_empty() {
        patterns.push(Pattern::new("import …", "an import of another file", "import \"$1\"".to_owned()));
    }
    let mut wheels = [wheel(&defaults, false), wheel(&defaults, true)];
    if defaults.is_last_wheel_mecanum() {
        wheels.reverse();
    }
    patterns.extend(wheels);
    patterns.push(Pattern::new(
        "sensor …",
        "a complete sensor declaration",
        format!("sensor ${{1:{}}}", defaults.next_name(EntityKind::Sensor)),
    ));
    patterns.push(Pattern::new(
        "ip …",
        "a complete address declaration",
        format!("ip ${{1:{}}} ${{2:127.0.0.1}}", defaults.next_name(EntityKind::Ip)),
    ));
    patterns.push(robot(place, &defaults));
    patterns.push(movement(&defaults, ""));
    patterns.push(movement(&defaults, "parallel "));
    patterns.push(environment(&defaults));
    completions(place, patterns)
}

/// To start from, in an empty file.
fn program(place: &CursorContext<'_>) -> Pattern {
    let port = place.database.target(place.file).default_port();
    let insert = format!(
        "wheel wheelL with radius ${{4:4.5}}\n\
         wheel wheelR with radius ${{4:4.5}}\n\
         \n\
         robot ${{1:rover}} type tw with port ${{5:{port}}} has {{ wheelL wheelR }} wheels\n\
         \n\
         movement ${{2:patrol}} of ${{1:rover}} {{\n  move ${{6:1.0}} meters\n  $0\n}}\n\
         \n\
         environment ${{3:yard}} has {{ ${{1:rover}} }} robots with {{ ${{2:patrol}} }} moves\n"
    );
    Pattern::new("program …", "a robot on two wheels, a movement and an environment", insert)
}

fn wheel(defaults: &Defaults<'_>, mecanum: bool) -> Pattern {
    let (keyword, detail) = if mecanum {
        ("wheelH", "a complete mecanum wheel declaration")
    } else {
        ("wheel", "a complete wheel declaration")
    };
    let (name, radius) = (defaults.next_name(EntityKind::Wheel), defaults.radius());
    Pattern::new(
        &format!("{keyword} …"),
        detail,
        format!("{keyword} ${{1:{name}}} with radius ${{2:{radius}}}"),
    )
}

/// The wheels come right after the name: type and port are rarely changed.
fn robot(place: &CursorContext<'_>, defaults: &Defaults<'_>) -> Pattern {
    let layout = defaults.wheels();
    let sensors = defaults.sensors();
    let sensors = if sensors.is_empty() {
        String::new()
    } else {
        format!(" with sensors {{ {} }}", stop(3, &sensors.join(", ")))
    };
    let insert = format!(
        "robot ${{1:{}}} type ${{5:{}}} with port ${{4:{}}} has {{ {} }} wheels{sensors}",
        defaults.next_name(EntityKind::Robot),
        layout.drive,
        port(place, None).unwrap_or_default(),
        stop(2, &layout.names.join(" ")),
    );
    Pattern::new("robot …", "a complete robot declaration", insert)
}

fn movement(defaults: &Defaults<'_>, parallel: &str) -> Pattern {
    let detail = if parallel.is_empty() {
        "a complete movement declaration"
    } else {
        "a movement that runs at the same time as others"
    };
    let insert = format!(
        "{parallel}movement ${{1:{}}} of {} {{\n  $0\n}}",
        defaults.next_name(EntityKind::Movement),
        stop(2, &defaults.robot_to_move().unwrap_or_default()),
    );
    Pattern::new(&format!("{parallel}movement …"), detail, insert)
}

fn environment(defaults: &Defaults<'_>) -> Pattern {
    let name = defaults.next_name(EntityKind::Environment);
    let robots = defaults.robots_to_run();
    let moves = defaults.moves_of(&robots);
    let head = format!("environment {name} has {{ {} }} robots with ", robots.join(" "));
    // As the canonical layout has it: a list that does not fit on the line gets a line for each of its names.
    let fits = head.len() + moves.join(" ").len() + "{  } moves".len() <= pydslrep_syntax::COLUMNS;
    let moves = if fits {
        format!("{{ {} }} moves", stop(3, &moves.join(" ")))
    } else {
        format!("{{\n  {}\n}} moves", stop(3, &moves.join("\n  ")))
    };
    let robots = stop(2, &robots.join(" "));
    let insert = format!("environment ${{1:{name}}} has {{ {robots} }} robots with {moves}");
    Pattern::new("environment …", "a complete environment declaration", insert)
}

/// Whole actions, those like the last action of their kind first.
pub(super) fn actions(place: &CursorContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_part(place);
    let (moves, turns) = (moves(&defaults), turns(&defaults));
    // Turns and moves mostly take turns.
    let patterns = if defaults.follows_a_move() { [turns, moves] } else { [moves, turns] };
    completions(place, patterns.into_iter().flatten().collect())
}

fn moves(defaults: &Defaults<'_>) -> Vec<Pattern> {
    let last = defaults.last_move();
    let mut shapes =
        [(Unit::Meters, false), (Unit::Centimeters, false), (Unit::Meters, true), (Unit::Centimeters, true)];
    shapes.sort_by_key(|(unit, with_speed)| (*unit != last.unit, *with_speed != last.speed.is_some()));
    let speed = defaults.speed();
    let pattern = |(unit, with_speed): (Unit, bool)| {
        let (word, other) = match unit {
            Unit::Meters => (TokenKind::Meters, "1.0"),
            Unit::Centimeters => (TokenKind::Centimeters, "50"),
        };
        let word = word.spelling().unwrap_or_default();
        let distance = last.distance.as_deref().filter(|_| unit == last.unit).unwrap_or(other);
        let insert = format!("move ${{1:{distance}}} {word}");
        if with_speed {
            let label = format!("move … {word} at …");
            Pattern::new(&label, "straight ahead at this speed (cm/s)", format!("{insert} at ${{2:{speed}}}"))
        } else {
            Pattern::new(&format!("move … {word}"), "straight ahead", insert)
        }
    };
    shapes.map(pattern).into()
}

fn turns(defaults: &Defaults<'_>) -> Vec<Pattern> {
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
    let pattern = |(direction, with_angle)| {
        let word = spelling(direction);
        if with_angle {
            let label = format!("turn {word} …");
            Pattern::new(&label, "in place by this angle (degrees)", format!("turn {word} ${{1:{angle}}}"))
        } else {
            Pattern::new(&format!("turn {word}"), "in place by 90 degrees", format!("turn {word}"))
        }
    };
    let mut patterns: Vec<Pattern> = shapes.into_iter().map(pattern).collect();
    if sensors.is_empty() {
        return patterns;
    }
    let word = spelling(last.direction);
    let until = Pattern::new(
        &format!("turn {word} until …"),
        "in place until no sensor detects an obstacle",
        format!("turn {word} until {{ {} }}", stop(1, &sensors.join(", "))),
    );
    patterns.insert(if last.is_until { 0 } else { patterns.len() }, until);
    patterns
}

fn spelling(direction: Direction) -> &'static str {
    let token = match direction {
        Direction::Left => TokenKind::Left,
        Direction::Right => TokenKind::Right,
    };
    token.spelling().unwrap_or_default()
}

/// The clause that a move can end with.
pub(super) fn speed(place: &CursorContext<'_>) -> Vec<Completion> {
    let insert = format!("at ${{1:{}}}", Defaults::for_part(place).speed());
    completions(place, vec![Pattern::new("at …", "a speed (cm/s)", insert)])
}

/// A place for the person to fill in, with what it is likely to be, if anything.
pub(super) fn stop(number: u32, likely: &str) -> String {
    if likely.is_empty() { format!("${number}") } else { format!("${{{number}:{likely}}}") }
}

fn completions(place: &CursorContext<'_>, patterns: Vec<Pattern>) -> Vec<Completion> {
    let completion = |pattern: Pattern| Completion {
        detail: pattern.detail.to_owned(),
        documentation: Documentation::Text(format!(
            "```pydslrep\n{}\n```",
            without_stops(&pattern.insert).trim_end()
        )),
        is_snippet: pattern.insert.contains('$'),
        insert: pattern.insert,
        ..place.item(&pattern.label, CompletionKind::Snippet, Rank::Pattern)
    };
    patterns.into_iter().map(completion).collect()
}

/// A snippet as plain text: `${1:name}` becomes `name`, `$0` nothing.
pub(super) fn without_stops(snippet: &str) -> String {
    let mut plain = String::with_capacity(snippet.len());
    let mut depth = 0_u32;
    let mut characters = snippet.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '\\' => plain.extend(characters.next()),
            '$' => {
                let braced = characters.next_if_eq(&'{').is_some();
                while characters.next_if(char::is_ascii_digit).is_some() {}
                if braced {
                    characters.next_if_eq(&':');
                    depth += 1;
                }
            }
            '}' if depth > 0 => depth -= 1,
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor};
    use crate::{CompletionTrigger, completions};

    #[test]
    fn stops_leave_their_text() {
        assert_eq!(without_stops("a ${1:b} {\n  $0\n}"), "a b {\n  \n}");
        assert_eq!(without_stops("{ $1 } ${2:a ${3:b}} \\$ \\}"), "{  } a b $ }");
    }

    /// What patterns of these labels insert.
    fn check(fixture: &str, labels: &[&str], expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let items = completions(&database, position, CompletionTrigger::Invoked, 9.0);
        let found = labels.iter().map(|label| {
            let item = items.iter().find(|item| item.label == *label);
            item.map_or_else(|| format!("no {label}\n"), |item| item.insert.clone() + "\n")
        });
        expected.assert_eq(&found.collect::<String>());
    }

    #[test]
    fn entities_continue_what_is_declared_above() {
        let wheels =
            "wheelH wheelR0 with radius 6\nwheelH wheelL0 with radius 6\nwheelH wheelR1 with radius 6.5\n";
        check(
            &format!("{wheels}$0"),
            &["wheelH …", "robot …"],
            &expect![[r#"
                wheelH ${1:wheelL1} with radius ${2:6.5}
                robot ${1:rover} type ${5:tw} with port ${4:23000} has { $2 } wheels
            "#]],
        );
        check(
            &format!("{wheels}wheelH wheelL1 with radius 6\nsensor sonar_1\n$0"),
            &["wheelH …", "sensor …", "robot …"],
            &expect![[r#"
                wheelH ${1:wheelL2} with radius ${2:6}
                sensor ${1:sonar_2}
                robot ${1:rover} type ${5:fwh} with port ${4:23000} has { ${2:wheelL0 wheelL1 wheelR0 wheelR1} } wheels with sensors { ${3:sonar_1} }
            "#]],
        );
        check(
            &format!(
                "{PARTS}movement mov_1 of rover {{ slam }}\nmovement mov_2 of rover {{ slam }}\n\
                 robot other with port 23000 has {{ wheelL wheelR }} wheels\n$0"
            ),
            &["movement …", "parallel movement …", "environment …"],
            &expect![[r#"
                movement ${1:mov_3} of ${2:other} {
                  $0
                }
                parallel movement ${1:mov_3} of ${2:other} {
                  $0
                }
                environment ${1:area} has { ${2:rover} } robots with { ${3:mov_1 mov_2} } moves
            "#]],
        );
    }

    #[test]
    fn a_long_list_has_a_line_for_each_name() {
        let movement = |number: u32| format!("movement along_the_fence_{number} of rover {{ slam }}\n");
        let movements: String = (1..5).map(movement).collect();
        check(
            &format!("{PARTS}{movements}$0"),
            &["environment …"],
            &expect![[r#"
                environment ${1:area} has { ${2:rover} } robots with {
                  ${3:along_the_fence_1
                  along_the_fence_2
                  along_the_fence_3
                  along_the_fence_4}
                } moves
            "#]],
        );
    }

    #[test]
    fn actions_are_like_those_before() {
        let before = "movement m of rover { move 50 centimeters at 12.5 turn right 45";
        check(
            &format!("{PARTS}{before} $0"),
            &["move … centimeters at …", "move … meters", "turn right …", "turn right until …"],
            &expect![[r#"
                move ${1:50} centimeters at ${2:12.5}
                move ${1:1.0} meters
                turn right ${1:45}
                turn right until { ${1:front} }
            "#]],
        );
        check(
            &format!("{PARTS}{before} }}\nmovement n of rover {{ $0 }}"),
            &["move … centimeters at …", "turn left …"],
            &expect![[r#"
                move ${1:50} centimeters at ${2:12.5}
                turn left ${1:45}
            "#]],
        );
    }

    #[test]
    fn every_pattern_is_a_program_once_it_is_filled_in() {
        let entity = PARTS.to_owned() + "$0";
        let action = format!("{PARTS}movement m of rover {{ $0 }}");
        let speed = format!("{PARTS}movement m of rover {{ move 2 meters $0 }}");
        for fixture in [entity, action, speed] {
            let (database, position) = at_cursor(&fixture);
            let items = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            let patterns: Vec<_> = items.iter().filter(|item| item.kind == CompletionKind::Snippet).collect();
            assert!(!patterns.is_empty());
            for pattern in patterns {
                let text = fixture.replace("$0", &without_stops(&pattern.insert));
                for (_, parse) in pydslrep_syntax::parse(&text) {
                    assert_eq!(parse.errors, [], "{text}");
                }
            }
        }
    }
}
