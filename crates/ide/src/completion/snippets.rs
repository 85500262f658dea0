//! Snippets: complete entities; those of actions are in [`super::actions`]. Their placeholders hold likely values
//! ([`super::defaults`]).

use pydslrep_syntax::EntityKind;

use super::context::CompletionContext;
use super::defaults::Defaults;
use super::keywords::port;
use super::{Completion, CompletionKind, Documentation, Rank};

/// An entity, action or clause with placeholders.
pub(super) struct Snippet {
    label: String,
    detail: &'static str,
    insert: String,
}

impl Snippet {
    pub(super) fn new(label: &str, detail: &'static str, insert: String) -> Self {
        Self { label: label.to_owned(), detail, insert }
    }
}

/// Complete entities in the order of the grammar; the kind of wheel declared last comes first.
pub(super) fn entities(context: &CompletionContext<'_>) -> Vec<Completion> {
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
fn program(context: &CompletionContext<'_>) -> Snippet {
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
fn robot(context: &CompletionContext<'_>, defaults: &Defaults<'_>) -> Snippet {
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

/// A tab stop with a default, if any.
pub(super) fn tab_stop(number: u32, default: &str) -> String {
    if default.is_empty() { format!("${number}") } else { format!("${{{number}:{default}}}") }
}

/// The items of snippets.
pub(super) fn completions(context: &CompletionContext<'_>, snippets: Vec<Snippet>) -> Vec<Completion> {
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
        let rest = |action: &str| {
            format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{ {action}")
        };
        let others =
            ["$0", "turn left $0", "wait 2 seconds $0 }", "if { front } clear { slam } $0"].map(rest);
        for fixture in [entity, action, speed].into_iter().chain(others) {
            let (database, position) = at_cursor(&fixture);
            let items = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            let snippets: Vec<_> = items.iter().filter(|item| item.kind == CompletionKind::Snippet).collect();
            assert!(!snippets.is_empty());
            for snippet in snippets {
                let mut text = fixture.replace("$0", &plain_text(&snippet.insert));
                let braces = |brace| text.matches(brace).count();
                text += &" }".repeat(braces('{').saturating_sub(braces('}')));
                for (_, parse) in pydslrep_syntax::parse(&text) {
                    assert_eq!(parse.errors, [], "{text}");
                }
            }
        }
    }

    #[test]
    fn statements_resemble_the_previous_ones() {
        let before = "movement side of rover { slam }\nmovement m of rover { repeat 8 times { wait 0.5 seconds turn right 45 with radius 30 centimeters at 7 }";
        check(
            &format!("{PARTS}{before} $0"),
            &[
                "repeat … times { … }",
                "wait … seconds",
                "turn right … with radius …",
                "turn left … with radius …",
                "move until … detect",
                "wait until … clear",
                "if … detect { … }",
                "repeat until … detect { … }",
                "do …",
                "move … meters at …",
            ],
            &expect![[r#"
                repeat ${1:8} times {
                  $0
                }
                wait ${1:0.5} seconds
                turn right ${1:45} with radius ${2:30} centimeters
                turn left ${1:45} with radius ${2:30} centimeters
                move until { ${1:front} } detect
                wait until { ${1:front} } clear
                if { ${1:front} } detect {
                  $0
                }
                repeat until { ${1:front} } detect {
                  $0
                }
                do ${1:side}
                move ${1:1.0} meters at ${2:7}
            "#]],
        );
    }
}
