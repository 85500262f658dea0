//! Hover: details of the item under the cursor: the circumference of a wheel, the equations of a robot with its numbers,
//! the duration and poses of an action, the timeline of an environment, and the syntax of a keyword with an example.

pub(crate) mod format;
pub(crate) mod motion;
mod parts;

use pydslrep_analysis::{Database, EntityId};
use pydslrep_syntax::ast::{Entity, nested};
use pydslrep_syntax::{EntityKind, Span};

use crate::FilePosition;
use crate::cursor::{body, entities_at, name_at, token_at};
use crate::keyword_pages::keyword_page;

/// A hover text and the range it describes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hover {
    /// The described range.
    pub span: Span,
    /// Markdown.
    pub markdown: String,
}

/// The hover text at a position.
pub fn hover(database: &Database, position: FilePosition) -> Option<Hover> {
    name(database, position).or_else(|| action(database, position)).or_else(|| keyword(database, position))
}

fn name(database: &Database, position: FilePosition) -> Option<Hover> {
    let at = name_at(database, position)?;
    let id = database.resolve(position.file, at.kind, &at.name.text).entity()?;
    let facts = describe(database, id);
    let entity = database.entity(id)?;
    let declaration = database.slice(entity.file, body(&entity));
    let first_line = declaration.lines().next().unwrap_or_default();
    let facts = facts.unwrap_or_else(|| "Fix its errors to see details.".to_owned());
    Some(Hover { span: at.span, markdown: format!("```pydslrep\n{first_line}\n```\n{facts}") })
}

/// The details of an entity; `None` if it has errors.
pub(crate) fn describe(database: &Database, id: EntityId) -> Option<String> {
    match database.tree(id)?.kind()? {
        EntityKind::Wheel => parts::wheel(database, id),
        EntityKind::Sensor => parts::sensor(database, id),
        EntityKind::Ip => parts::ip(database, id),
        EntityKind::Robot => parts::robot(database, id),
        EntityKind::Movement => motion::movement(database, id),
        EntityKind::Environment => motion::environment(database, id),
    }
}

/// The details of the innermost action under the cursor.
fn action(database: &Database, position: FilePosition) -> Option<Hover> {
    entities_at(database, position).into_iter().find_map(|entity| {
        let Some(Entity::Movement(movement)) = &entity.parse.entity else { return None };
        let touches = |span: Span| span.shifted(entity.span.start).touches(position.offset);
        let index = movement.actions.iter().position(|action| touches(action.span))?;
        let inside = nested(&movement.actions[index..=index]).filter(|action| touches(action.span));
        let span = inside.min_by_key(|action| action.span.len())?.span;
        let number = movement.statements().iter().position(|statement| *statement == span)? + 1;
        let markdown = motion::action(database, entity.id, index, number)?;
        Some(Hover { span: span.shifted(entity.span.start), markdown })
    })
}

/// The page of a keyword; a word that is a name has none.
fn keyword(database: &Database, position: FilePosition) -> Option<Hover> {
    if name_at(database, position).is_some() {
        return None;
    }
    let (token, span) = token_at(database, position)?;
    Some(Hover { span, markdown: keyword_page(token)?.markdown() })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor};

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let rendered = hover(&database, position)
            .map(|hover| format!("{}\n---\n{}\n", database.slice(position.file, hover.span), hover.markdown));
        expected.assert_eq(&rendered.unwrap_or_else(|| "nothing".to_owned()));
    }

    const REST: &str = "parallel movement m of rover { move 1.0 meters at 10 turn left 90 turn right until { front } slam }\n\
                        movement n of rover { move -50 centimeters }\nenvironment e has { rover } robots with { n m } moves";

    #[test]
    fn parts_show_their_measures_and_users() {
        check(
            &format!("{PARTS}robot r with port 1 has {{ wheelL$0 wheelR }} wheels"),
            &expect![[r#"
            wheelL
            ---
            ```pydslrep
            wheel wheelL with radius 4.5
            ```
            Wheel: radius 4.5 cm, 28.3 cm per revolution. Used by `r`, `rover`.
        "#]],
        );
        check(
            &format!("{PARTS}sensor $0left : bumper"),
            &expect![[r#"
            left
            ---
            ```pydslrep
            sensor left : bumper
            ```
            Bumper: detects an obstacle on contact. Unused.
        "#]],
        );
        check(
            "ip he$0re 127.0.0.1\nenvironment e with ip here has { } robots",
            &expect![[r#"
            here
            ---
            ```pydslrep
            ip here 127.0.0.1
            ```
            The machine at 127.0.0.1. Used by `e`.
        "#]],
        );
    }

    #[test]
    fn a_robot_shows_its_kinematics() {
        check(
            &format!("{PARTS}movement m of $0rover {{ slam }}"),
            &expect![[r#"
            rover
            ---
            ```pydslrep
            robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }
            ```
            Two-wheel differential drive (`tw`), port 23000.

            | wheel | position | radius |
            |---|---|---|
            | `wheelL` | left | 4.5 cm |
            | `wheelR` | right | 4.5 cm |

            Sensors: `front`.

            Wheel rates in rad/s:
            ```text
            left  = (v − ω d/2) / r
            right = (v + ω d/2) / r
            ```
            r = 0.045 m, d = 0.3 m unless the scene overrides them.

            Used by `m`.
        "#]],
        );
        check(
            "wheelH a with radius 5 robot c$0 type fw with port 1 has { a a a a } wheels",
            &expect![[r#"
                c
                ---
                ```pydslrep
                robot c type fw with port 1 has { a a a a } wheels
                ```
                Mecanum drive (`fwh`), port 1.

                | wheel | position | radius |
                |---|---|---|
                | `a` | left front | 5 cm |
                | `a` | left rear | 5 cm |
                | `a` | right front | 5 cm |
                | `a` | right rear | 5 cm |

                Wheel rates in rad/s:
                ```text
                left front  = (vx − vy − K ω) / r
                left rear   = (vx + vy − K ω) / r
                right front = (vx + vy + K ω) / r
                right rear  = (vx − vy + K ω) / r
                ```
                r = 0.05 m, K = 0.275 m (half of track 0.3 m and wheelbase 0.25 m) unless the scene overrides them.

                Unused.
            "#]],
        );
    }

    #[test]
    fn a_skid_steered_robot_shows_its_scrub_factor() {
        check(
            "wheel a with radius 5 robot c$0 type fw with port 1 has { a a a a } wheels",
            &expect![[r#"
            c
            ---
            ```pydslrep
            robot c type fw with port 1 has { a a a a } wheels
            ```
            Four-wheel skid-steer drive (`fw`), port 1.

            | wheel | position | radius |
            |---|---|---|
            | `a` | left front | 5 cm |
            | `a` | left rear | 5 cm |
            | `a` | right front | 5 cm |
            | `a` | right rear | 5 cm |

            Wheel rates in rad/s:
            ```text
            left front, left rear   = (v − ω d/2) / r
            right front, right rear = (v + ω d/2) / r
            ```
            r = 0.05 m, d = 0.508 m (track 0.3 m × 1.69 for tyre scrub in turns) unless the scene overrides them.

            Unused.
        "#]],
        );
    }

    #[test]
    fn an_action_shows_its_poses() {
        check(
            &format!("{PARTS}{}", REST.replace("turn left", "tu$0rn left")),
            &expect![[r#"
            turn left 90
            ---
            ```pydslrep
            turn left 90
            ```
            Takes 2.9 s. From (1 m, 0 m, 0°) to (1 m, 0 m, 90°), relative to the start of the movement.

            Wheel rates: `wheelL` -2 rad/s, `wheelR` 2 rad/s.
        "#]],
        );
        check(
            &format!("{PARTS}{}", REST.replace("turn right", "tu$0rn right")),
            &expect![[r#"
            turn right until { front }
            ---
            ```pydslrep
            turn right until { front }
            ```
            The end pose cannot be planned: `turn right until { front }` ends when the way is clear.
        "#]],
        );
        check(
            &format!("{PARTS}{}", REST.replace("slam", "sl$0am")),
            &expect![[r#"
                slam
                ---
                ```pydslrep
                slam
                ```
                The start pose cannot be planned: `turn right until { front }` ends when the way is clear.
            "#]],
        );
    }

    #[test]
    fn a_movement_shows_its_length() {
        check(
            &format!("{PARTS}{}", REST.replace("movement m", "movement m$0")),
            &expect![[r#"
            m
            ---
            ```pydslrep
            parallel movement m of rover { move 1.0 meters at 10 turn left 90 turn right until { front } slam }
            ```
            A movement of `rover`: drives 1 m and turns 90°. Its end cannot be planned because of `turn right until { front }`.

            Used by `e`.
        "#]],
        );
        check(
            &format!("{PARTS}{}", REST.replace("{ n m }", "{ n$0 m }")),
            &expect![[r#"
            n
            ---
            ```pydslrep
            movement n of rover { move -50 centimeters }
            ```
            A movement of `rover`: drives 0.5 m and turns 0° in 5.9 s. It ends at (-0.5 m, 0 m, 0°) relative to its start.

            Used by `e`.
        "#]],
        );
    }

    #[test]
    fn ways_there_and_back_add_up() {
        let actions = "move 1.5 meters turn left 90 turn right 30 move -1 meters turn left -45";
        let (database, position) = at_cursor(&format!("{PARTS}movement $0m of rover {{ {actions} }}"));
        let shown = hover(&database, position).map(|hover| hover.markdown).unwrap_or_default();
        assert!(shown.contains("drives 2.5 m and turns 165°"), "{shown}");
    }

    #[test]
    fn an_environment_shows_its_timeline() {
        check(
            &format!("{PARTS}{}", REST.replace(" slam ", " ").replace("environment e", "environment $0e")),
            &expect![[r#"
                e
                ---
                ```pydslrep
                environment e has { rover } robots with { n m } moves
                ```
                Runs `rover`; duration unknown until it runs.

                | from | to | robot | movement |
                |---|---|---|---|
                | 0.0 s | 5.9 s | `rover` | `n` |
                | 5.9 s | ? | `rover` | `m` |

                In `m`, `turn right until { front }` ends when the way is clear. Later poses of `rover` and start times of later movements are unknown.

            "#]],
        );
    }

    #[test]
    fn a_keyword_has_its_page() {
        check(
            "wh$0eel a with radius 4",
            &expect![[r#"
            wheel
            ---
            ```pydslrep
            wheel NAME with radius CENTIMETRES
            ```
            A standard wheel, with its radius in centimetres. Several robots may use it; each gets a joint of that name.

            ```pydslrep
            wheel wheelL with radius 4.5
            ```
        "#]],
        );
    }

    #[test]
    fn entities_with_errors_ask_to_fix_them() {
        check(
            "robot $0r with port 1 has { a b } wheels",
            &expect![[r#"
                r
                ---
                ```pydslrep
                robot r with port 1 has { a b } wheels
                ```
                Fix its errors to see details.
            "#]],
        );
        check(
            "movement $0m of nobody { slam }",
            &expect![[r#"
                m
                ---
                ```pydslrep
                movement m of nobody { slam }
                ```
                Fix its errors to see details.
            "#]],
        );
    }

    /// The hover texts at the marked places of a movement, which is done once.
    fn shown(actions: &str) -> String {
        let before =
            format!("{PARTS}movement side of rover {{ move 1 meters turn left }}\nmovement m of rover {{\n");
        let places = actions.match_indices("$0").map(|(at, _)| {
            let cursor = format!("{}$0{}", actions[..at].replace("$0", ""), actions[at..].replace("$0", ""));
            let (database, position) = at_cursor(&format!("{before}{cursor}\n}}"));
            hover(&database, position).map_or_else(|| "nothing\n".to_owned(), |hover| hover.markdown + "\n")
        });
        places.collect::<Vec<_>>().join("----\n")
    }

    #[test]
    fn an_action_in_a_block_has_its_own_details() {
        expect![[r#"
            ```pydslrep
            repeat 4 times
            ```
            Takes 2 min 30.0 s. From (1 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.
            ----
            ```pydslrep
            move 1 meters
            ```
            Takes 11.4 s. In the first round from (1 m, 0 m, 0°) to (2 m, 0 m, 0°), relative to the start of the movement.

            Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s.
            ----
            ```pydslrep
            do side
            ```
            Takes 14.4 s. In the first round from (2 m, 0 m, 0°) to (3 m, 0 m, 90°), relative to the start of the movement.
            ----
            ```pydslrep
            turn left 90 with radius 50 centimeters
            ```
            Takes 11.7 s. In the first round from (3 m, 0 m, 90°) to (2.5 m, 0.5 m, 180°), relative to the start of the movement.

            Wheel rates: `wheelL` 1.08 rad/s, `wheelR` 2 rad/s.
            ----
            ```pydslrep
            wait 2 seconds
            ```
            Takes 2.0 s. From (1 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.

            Wheel rates: `wheelL` 0 rad/s, `wheelR` 0 rad/s.
        "#]].assert_eq(&shown(
            "  move 1 meters\n  rep$0eat 4 times {\n    mo$0ve 1 meters\n    d$0o side\n    turn $0left 90 with radius 50 centimeters\n  }\n  w$0ait 2 seconds",
        ));
    }

    #[test]
    fn what_depends_on_sensors_says_so() {
        expect![[r#"
            ```pydslrep
            move 1 meters
            ```
            Takes 11.4 s. In the first round from (0 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.

            Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s.
            ----
            ```pydslrep
            if { front } detect
            ```
            The end pose cannot be planned: what `if { front } detect` does depends on its sensors.
            ----
            ```pydslrep
            wait 2 seconds
            ```
            Takes 2.0 s. The start pose cannot be planned: what `repeat 2 times` does depends on what sensors detect.

            Wheel rates: `wheelL` 0 rad/s, `wheelR` 0 rad/s.
            ----
            ```pydslrep
            slam
            ```
            The end pose cannot be planned: the path of `slam` depends on what it explores.
            ----
            ```pydslrep
            move 2 meters
            ```
            Takes 22.6 s. The start pose cannot be planned: what `repeat 2 times` does depends on what sensors detect.

            Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s.
        "#]].assert_eq(&shown(
            "  repeat 2 times {\n    move 1 me$0ters\n    i$0f { front } detect {\n      w$0ait 2 seconds\n    }\n    sl$0am\n  }\n  mo$0ve 2 meters",
        ));
    }

    #[test]
    fn a_name_that_is_a_keyword_elsewhere_has_no_page() {
        check("movement m of r { wait until { tim$0es } clear }", &expect!["nothing"]);
        check(
            "movement m of { wait until { times } cl$0ear",
            &expect![[r#"
            clear
            ---
            ```pydslrep
            { SENSORS } clear [within DISTANCE meters | centimeters]
            ```
            The condition holds while none of its sensors detects an obstacle.

            ```pydslrep
            wait until { front } clear
            ```
        "#]],
        );
    }
}
