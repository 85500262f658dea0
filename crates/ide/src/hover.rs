//! Hover: details of the item under the cursor: the circumference of a wheel, the equations of a robot with its numbers,
//! the duration and poses of an action, what the rounds of a `repeat` come to, the circle of each wheel in a turn with a
//! radius, what the sensors of a condition see and where the robot stands that they stop, the timeline of an environment,
//! and the syntax of a keyword with an example.

pub(crate) mod action;
mod arc;
mod condition;
pub(crate) mod format;
mod motion;
mod parts;
mod way;
pub(crate) mod within;

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
    let own_words = || condition(database, position).or_else(|| action(database, position));
    name(database, position).or_else(own_words).or_else(|| keyword(database, position))
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

/// Returns the hover for the condition under the cursor.
fn condition(database: &Database, position: FilePosition) -> Option<Hover> {
    entities_at(database, position).into_iter().find_map(|entity| {
        let Some(Entity::Movement(movement)) = &entity.parse.entity else { return None };
        let touches = |span: Span| span.shifted(entity.span.start).touches(position.offset);
        let conditions = movement
            .all_actions()
            .flat_map(|action| action.conditions().map(move |condition| (action, condition)));
        let (action, condition) = { conditions }.find(|(_, condition)| touches(condition.span))?;
        let markdown = condition::describe(database, &entity, action, condition)?;
        Some(Hover { span: condition.span.shifted(entity.span.start), markdown })
    })
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
        let markdown = action::action(database, entity.id, index, number)?;
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

            4 rounds, each of which drives 2.785 m and turns 180° in 37.5 s: together 11.142 m and turns 720° in 2 min 30.0 s.
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

            `side` drives 1 m and turns 90° in 14.4 s. It ends at (1 m, 0 m, 90°) relative to its start.
            ----
            ```pydslrep
            turn left 90 with radius 50 centimeters
            ```
            Takes 11.7 s. In the first round from (3 m, 0 m, 90°) to (2.5 m, 0.5 m, 180°), relative to the start of the movement.

            The centre of rotation is at (2.5 m, 0 m), 0.5 m to the left of the robot. At the highest speed v = 0.069 m/s and ω = 0.138 rad/s.

            | wheel | radius of its circle | rate |
            |---|---|---|
            | `wheelL` | 0.35 m | 1.08 rad/s |
            | `wheelR` | 0.65 m | 2 rad/s |

            Wheel rates in rad/s:
            ```text
            left  = (v − ω d/2) / r
            right = (v + ω d/2) / r
            ```
            r = 0.045 m, d = 0.3 m unless the scene overrides them.
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
            Takes 2.0 s. If it is done in the first round, from (1 m, 0 m, 0°) to (1 m, 0 m, 0°), relative to the start of the movement.

            Wheel rates: `wheelL` 0 rad/s, `wheelR` 0 rad/s.
            ----
            ```pydslrep
            slam
            ```
            The start pose cannot be planned: what `if { front } detect` does depends on its sensors.
            ----
            ```pydslrep
            move 2 meters
            ```
            Takes 22.6 s. The start pose cannot be planned: what `if { front } detect` does depends on its sensors.

            Wheel rates: `wheelL` 2 rad/s, `wheelR` 2 rad/s.
        "#]].assert_eq(&shown(
            "  repeat 2 times {\n    move 1 me$0ters\n    i$0f { front } detect {\n      w$0ait 2 seconds\n    }\n    sl$0am\n  }\n  mo$0ve 2 meters",
        ));
    }

    #[test]
    fn an_arc_has_its_circles() {
        expect![[r#"
            ```pydslrep
            turn right with radius 1.5 meters in reverse
            ```
            Takes 29.1 s. From (1 m, 0 m, 0°) to (-0.5 m, 1.5 m, -90°), relative to the start of the movement.

            The centre of rotation is at (1 m, 1.5 m), 1.5 m to the left of the robot. Backwards, the heading turns to the right, as if wheels were steered to the left. At the highest speed v = -0.082 m/s and ω = -0.055 rad/s.

            | wheel | radius of its circle | rate |
            |---|---|---|
            | `wheelL` | 1.35 m | -1.64 rad/s |
            | `wheelR` | 1.65 m | -2 rad/s |

            Wheel rates in rad/s:
            ```text
            left  = (v − ω d/2) / r
            right = (v + ω d/2) / r
            ```
            r = 0.045 m, d = 0.3 m unless the scene overrides them.
        "#]]
            .assert_eq(&shown("  move 1 meters\n  turn $0right with radius 1.5 meters in reverse at 20"));
        expect![[r#"
            ```pydslrep
            turn left with radius 10 centimeters until { front } detect
            ```
            The start pose cannot be planned: the path of `slam` depends on what it explores.

            The centre of rotation is 0.1 m to the left of the robot. At the highest speed v = 0.036 m/s and ω = 0.36 rad/s.

            | wheel | radius of its circle | rate |
            |---|---|---|
            | `wheelL` | 0.05 m | -0.4 rad/s |
            | `wheelR` | 0.25 m | 2 rad/s |

            Wheel rates in rad/s:
            ```text
            left  = (v − ω d/2) / r
            right = (v + ω d/2) / r
            ```
            r = 0.045 m, d = 0.3 m unless the scene overrides them.
            ----
            ```pydslrep
            turn left -90 with radius 1 meters
            ```
            Takes 20.4 s. The start pose cannot be planned: the path of `slam` depends on what it explores.

            The centre of rotation is 1 m to the right of the robot. At the highest speed v = 0.078 m/s and ω = -0.078 rad/s.

            | wheel | radius of its circle | rate |
            |---|---|---|
            | `wheelL` | 1.15 m | 2 rad/s |
            | `wheelR` | 0.85 m | 1.48 rad/s |

            Wheel rates in rad/s:
            ```text
            left  = (v − ω d/2) / r
            right = (v + ω d/2) / r
            ```
            r = 0.045 m, d = 0.3 m unless the scene overrides them.
        "#]].assert_eq(&shown(
            "  slam\n  turn $0left with radius 10 centimeters until { front } detect\n  turn left -90 with$0 radius 1 meters",
        ));
    }

    #[test]
    fn rounds_say_what_they_come_to() {
        expect![[r#"
            ```pydslrep
            repeat 3 times
            ```
            Takes 2 min 4.6 s. From (0 m, 0 m, 0°) to (0.5 m, 0.5 m, 180°), relative to the start of the movement.

            3 rounds, each of which drives 3 m and turns 180° in 41.5 s: together 9 m and turns 540° in 2 min 4.6 s.
            ----
            ```pydslrep
            repeat 2 times
            ```
            Takes 40.5 s. In the first round from (0 m, 0 m, 0°) to (0.5 m, 0.5 m, 180°), relative to the start of the movement.

            2 rounds, each of which drives 1.5 m and turns 90° in 20.3 s: together 3 m and turns 180° in 40.5 s.
            ----
            ```pydslrep
            repeat until { front } detect
            ```
            The end pose cannot be planned: `repeat until { front } detect` ends when its condition holds.

            A round drives 1 m and turns 0° in 11.4 s.
            ----
            ```pydslrep
            repeat 2 times
            ```
            The start pose cannot be planned: `repeat until { front } detect` ends when its condition holds.

            2 rounds, each of which drives 1 m and turns 0°, what sensors decide not counted.
            ----
            ```pydslrep
            do side
            ```
            Takes 14.4 s. The start pose cannot be planned: `repeat until { front } detect` ends when its condition holds.

            `side` drives 1 m and turns 90° in 14.4 s. It ends at (1 m, 0 m, 90°) relative to its start.
        "#]].assert_eq(&shown(
            "  rep$0eat 3 times { rep$0eat 2 times { move -50 centimeters do side } wait 1 seconds }\n  \
             repeat$0 until { front } detect { move 1 meters }\n  repeat$0 2 times { move until { front } detect move 1 meters }\n  d$0o side",
        ));
    }

    #[test]
    fn a_condition_says_what_its_sensors_see_and_where_the_robot_stands() {
        expect![[r#"
            ```pydslrep
            { front } detect within 40 centimeters
            ```
            Holds while `front` detects something nearer than 0.4 m.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            When it holds, the robot brakes. From 50 cm/s it stands 27.5 cm farther on: v²/2a = 25 cm and a step of 2.5 cm at the fastest rim. What `front` detects straight ahead is then 12.5 cm away.
            ----
            ```pydslrep
            { front } detect within 20 centimeters
            ```
            Holds while `front` detects something nearer than 0.2 m.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            When it holds, the robot brakes. From 50 cm/s it stands 27.5 cm farther on: v²/2a = 25 cm and a step of 2.5 cm at the fastest rim. That is too late for what `front` detects straight ahead.
            ----
            ```pydslrep
            { front } detect
            ```
            Holds while `front` detects something.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            When it holds, the robot brakes. From 9 cm/s it stands 1.3 cm farther on: v²/2a = 0.8 cm and a step of 0.4 cm at the fastest rim.
            ----
            ```pydslrep
            { front }
            ```
            Holds while `front` detects nothing.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            When it holds, the robot brakes. From 9 cm/s it stands 4.8° farther on: v²/2a = 0.8 cm and a step of 0.4 cm at the fastest rim.
            ----
            ```pydslrep
            { front } clear
            ```
            Holds while `front` detects nothing.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            When it holds, the robot brakes. From 20 cm/s it stands 2.5° or 4.3 cm farther on: v²/2a = 4 cm and a step of 1 cm at the fastest rim.
            ----
            ```pydslrep
            { front } detect within 2 meters
            ```
            Holds while `front` detects something nearer than 2 m.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            It is asked once, of the latest step, which takes no time.
            ----
            ```pydslrep
            { front } clear
            ```
            Holds while `front` detects nothing.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.
            ----
            ```pydslrep
            { front } detect
            ```
            Holds while `front` detects something.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead, facing ahead | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            It is asked before each round, of the latest step, which takes no time.
        "#]].assert_eq(&shown(
            "  move at 50 until { front } det$0ect within 40 centimeters\n  move at 50 until { front } det$0ect within 20 centimeters\n  move -1 meters until { front } de$0tect\n  \
             turn left until {$0 front }\n  turn left with radius 1 meters at 20 until { front } clear$0\n  \
             if { front } detect wi$0thin 2 meters { turn left }\n  wait until { front } cl$0ear\n  repeat until { front } det$0ect { slam }",
        ));
    }

    const MANY: &str = "sensor left_eye\nsensor back : bumper\nsensor far\n\
        robot scout type tw with port 1 has { wheelL wheelR } wheels with sensors { front, left_eye, back, far }\n\
        movement m of scout { do n }\nmovement n of scout { if { front, left_eye, back, far } cl$0ear { slam } }\n";

    #[test]
    fn sensors_are_where_the_scene_of_an_environment_has_them() {
        check(
            &format!("{PARTS}{MANY}"),
            &expect![[r#"
            { front, left_eye, back, far } clear
            ---
            ```pydslrep
            { front, left_eye, back, far } clear
            ```
            Holds while none of its sensors detects anything.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead and 0.15 m to the left, facing 45° to the left | 1 m, in a cone of 20° |
            | `left_eye` | 0.15 m to the left, facing left | 1 m, in a cone of 20° |
            | `back` | 0.15 m behind, facing back | what it touches: 0.05 m |
            | `far` | 0.15 m ahead and 0.15 m to the right, facing 45° to the right | 1 m, in a cone of 20° |

            Unless a scene says otherwise.

            It is asked once, of the latest step, which takes no time.
        "#]],
        );
        let text = format!("{PARTS}{MANY}environment e has {{ scout }} robots with {{ m }} moves");
        let (mut database, position) = at_cursor(&text.replace("slam", "turn left"));
        let scene = "[robots.scout.sensors.far]\nat = [0.1, -0.05]\nbearing = -30\nrange = 2.5\ncone = 10\n";
        database.set_scene(position.file, "e", Some(scene));
        let shown = hover(&database, position).map(|hover| hover.markdown).unwrap_or_default();
        expect![[r#"
            ```pydslrep
            { front, left_eye, back, far } clear
            ```
            Holds while none of its sensors detects anything.

            | sensor | mounted | sees |
            |---|---|---|
            | `front` | 0.15 m ahead and 0.15 m to the left, facing 45° to the left | 1 m, in a cone of 20° |
            | `left_eye` | 0.15 m to the left, facing left | 1 m, in a cone of 20° |
            | `back` | 0.15 m behind, facing back | what it touches: 0.05 m |
            | `far` | 0.1 m ahead and 0.05 m to the right, facing 30° to the right | 2.5 m, in a cone of 10° |

            In the scene of `e`.

            It is asked once, of the latest step, which takes no time."#]]
        .assert_eq(&shown);
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
