//! Snippets: complete entities and actions, and clauses that follow keywords. Their placeholders hold likely values
//! ([`super::defaults`]).

use pydslrep_syntax::ast::{Direction, Unit};
use pydslrep_syntax::{EntityKind, TokenKind};

use super::context::CursorContext;
use super::defaults::Defaults;
use super::keywords::port;
use super::{Completion, CompletionKind, Documentation, Rank};

/// An entity, action or clause with placeholders.
struct Snippet {
    label: String,
    detail: &'static str,
    insert: String,
}

impl Snippet {
    fn new(label: &str, detail: &'static str, insert: String) -> Self {
        Self { label: label.to_owned(), detail, insert }
    }
}

/// Complete entities in the order of the grammar; the kind of wheel declared last comes first.
pub(super) fn entities(context: &CursorContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_entity(context);
    let mut snippets = Vec::new();
    if context.database.entities(context.file).all(|entity| entity.parse.entity.is_none()) {
        snippets.push(program(context));
    }
    if context.may_import() && !super::paths::not_imported(context.database, context.file).is_empty() {
        snippets.push(Snippet::new("import …", "an import of another file", "import \"$1\"".to_owned()));
    }
    let mut wheels = [wheel(&defaults, false), wheel(&defaults, true)];
    if defaults.is_last_wheel_mecanum() {
        wheels.reverse();
    }
    snippets.extend(wheels);
    snippets.push(Snippet::new(
        "sensor …",
        "a complete sensor declaration",
        format!("sensor ${{1:{}}}", defaults.next_name(EntityKind::Sensor)),
    ));
    snippets.push(Snippet::new(
        "ip …",
        "a complete address declaration",
        format!("ip ${{1:{}}} ${{2:127.0.0.1}}", defaults.next_name(EntityKind::Ip)),
    ));
    snippets.push(robot(context, &defaults));
    snippets.push(movement(&defaults, ""));
    snippets.push(movement(&defaults, "parallel "));
    snippets.push(environment(&defaults));
    completions(context, snippets)
}

/// A complete program for an empty file.
fn program(context: &CursorContext<'_>) -> Snippet {
    let port = context.database.target(context.file).default_port();
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
    Snippet::new("program …", "a two-wheel robot, a movement and an environment", insert)
}

fn wheel(defaults: &Defaults<'_>, mecanum: bool) -> Snippet {
    let (keyword, detail) = if mecanum {
        ("wheelH", "a complete mecanum wheel declaration")
    } else {
        ("wheel", "a complete wheel declaration")
    };
    let (name, radius) = (defaults.next_name(EntityKind::Wheel), defaults.radius());
    Snippet::new(
        &format!("{keyword} …"),
        detail,
        format!("{keyword} ${{1:{name}}} with radius ${{2:{radius}}}"),
    )
}

/// The wheels are the first placeholder after the name, because type and port rarely change.
fn robot(context: &CursorContext<'_>, defaults: &Defaults<'_>) -> Snippet {
    let layout = defaults.wheels();
    let sensors = defaults.sensors();
    let sensors = if sensors.is_empty() {
        String::new()
    } else {
        format!(" with sensors {{ {} }}", tab_stop(3, &sensors.join(", ")))
    };
    let insert = format!(
        "robot ${{1:{}}} type ${{5:{}}} with port ${{4:{}}} has {{ {} }} wheels{sensors}",
        defaults.next_name(EntityKind::Robot),
        layout.drive,
        port(context, None).unwrap_or_default(),
        tab_stop(2, &layout.names.join(" ")),
    );
    Snippet::new("robot …", "a complete robot declaration", insert)
}

fn movement(defaults: &Defaults<'_>, parallel: &str) -> Snippet {
    let detail = if parallel.is_empty() {
        "a complete movement declaration"
    } else {
        "a movement that runs at the same time as others"
    };
    let insert = format!(
        "{parallel}movement ${{1:{}}} of {} {{\n  $0\n}}",
        defaults.next_name(EntityKind::Movement),
        tab_stop(2, &defaults.robot_to_move().unwrap_or_default()),
    );
    Snippet::new(&format!("{parallel}movement …"), detail, insert)
}

fn environment(defaults: &Defaults<'_>) -> Snippet {
    let name = defaults.next_name(EntityKind::Environment);
    let robots = defaults.robots_to_run();
    let moves = defaults.moves_of(&robots);
    let head = format!("environment {name} has {{ {} }} robots with ", robots.join(" "));
    // As in the canonical layout, a list that does not fit on the line has one name per line.
    let fits = head.len() + moves.join(" ").len() + "{  } moves".len() <= pydslrep_syntax::COLUMNS;
    let moves = if fits {
        format!("{{ {} }} moves", tab_stop(3, &moves.join(" ")))
    } else {
        format!("{{\n  {}\n}} moves", tab_stop(3, &moves.join("\n  ")))
    };
    let robots = tab_stop(2, &robots.join(" "));
    let insert = format!("environment ${{1:{name}}} has {{ {robots} }} robots with {moves}");
    Snippet::new("environment …", "a complete environment declaration", insert)
}

/// Complete actions, those like the last action of their kind first.
pub(super) fn actions(context: &CursorContext<'_>) -> Vec<Completion> {
    let defaults = Defaults::for_part(context);
    let (moves, turns) = (moves(&defaults), turns(&defaults));
    // Moves and turns usually alternate.
    let snippets = if defaults.follows_a_move() { [turns, moves] } else { [moves, turns] };
    completions(context, snippets.into_iter().flatten().collect())
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
    shapes.map(snippet).into()
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

fn spelling(direction: Direction) -> &'static str {
    let token = match direction {
        Direction::Left => TokenKind::Left,
        Direction::Right => TokenKind::Right,
    };
    token.spelling().unwrap_or_default()
}

/// The optional speed clause of a `move`.
pub(super) fn speed(context: &CursorContext<'_>) -> Vec<Completion> {
    let insert = format!("at ${{1:{}}}", Defaults::for_part(context).speed());
    completions(context, vec![Snippet::new("at …", "a speed (cm/s)", insert)])
}

/// A tab stop with a default, if any.
pub(super) fn tab_stop(number: u32, default: &str) -> String {
    if default.is_empty() { format!("${number}") } else { format!("${{{number}:{default}}}") }
}

fn completions(context: &CursorContext<'_>, snippets: Vec<Snippet>) -> Vec<Completion> {
    let completion = |snippet: Snippet| Completion {
        detail: snippet.detail.to_owned(),
        documentation: Documentation::Text(format!(
            "```pydslrep\n{}\n```",
            plain_text(&snippet.insert).trim_end()
        )),
        is_snippet: snippet.insert.contains('$'),
        insert: snippet.insert,
        ..context.item(&snippet.label, CompletionKind::Snippet, Rank::Snippet)
    };
    snippets.into_iter().map(completion).collect()
}

/// A snippet as plain text: `${1:name}` becomes `name`, `$0` the empty string.
pub(super) fn plain_text(snippet: &str) -> String {
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
    fn tab_stops_leave_their_default() {
        assert_eq!(plain_text("a ${1:b} {\n  $0\n}"), "a b {\n  \n}");
        assert_eq!(plain_text("{ $1 } ${2:a ${3:b}} \\$ \\}"), "{  } a b $ }");
    }

    /// The text that the snippets with these labels insert.
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
    fn entities_continue_the_declarations_above() {
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
    fn a_long_list_has_one_name_per_line() {
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
    fn actions_resemble_the_previous_ones() {
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
    fn every_snippet_parses_with_its_defaults() {
        let entity = PARTS.to_owned() + "$0";
        let action = format!("{PARTS}movement m of rover {{ $0 }}");
        let speed = format!("{PARTS}movement m of rover {{ move 2 meters $0 }}");
        for fixture in [entity, action, speed] {
            let (database, position) = at_cursor(&fixture);
            let items = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            let snippets: Vec<_> = items.iter().filter(|item| item.kind == CompletionKind::Snippet).collect();
            assert!(!snippets.is_empty());
            for snippet in snippets {
                let text = fixture.replace("$0", &plain_text(&snippet.insert));
                for (_, parse) in pydslrep_syntax::parse(&text) {
                    assert_eq!(parse.errors, [], "{text}");
                }
            }
        }
    }
}
