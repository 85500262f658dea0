//! Hover: what a robot programmer would like to know of the thing under the cursor: of a wheel its circumference, of a
//! robot its equations with its numbers, of an action its time and poses, of an environment who drives when, and of a
//! keyword its syntax with an example.

pub(crate) mod format;
pub(crate) mod motion;
mod parts;

use pydslrep_analysis::{Database, EntityId};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span};

use crate::FilePosition;
use crate::cursor::{body, entities_at, lexeme_at, name_at};
use crate::keyword_pages::keyword_page;

/// What to show, and for which piece of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hover {
    /// The text it is about.
    pub span: Span,
    /// Markdown.
    pub markdown: String,
}

/// What there is to say of a place.
pub fn hover(database: &Database, position: FilePosition) -> Option<Hover> {
    name(database, position).or_else(|| action(database, position)).or_else(|| keyword(database, position))
}

fn name(database: &Database, position: FilePosition) -> Option<Hover> {
    let at = name_at(database, position)?;
    let id = database.resolve(position.file, at.kind, &at.name.text).entity()?;
    let facts = facts(database, id);
    let entity = database.entity(id)?;
    let declaration = database.slice(entity.file, body(&entity));
    let first_line = declaration.lines().next().unwrap_or_default();
    let facts = facts.unwrap_or_else(|| "There is more to say of it once its errors are mended.".to_owned());
    Some(Hover { span: at.span, markdown: format!("```pydslrep\n{first_line}\n```\n{facts}") })
}

/// What there is to say of an entity; `None` where it has errors.
pub(crate) fn facts(database: &Database, id: EntityId) -> Option<String> {
    match database.tree(id)?.kind()? {
        EntityKind::Wheel => parts::wheel(database, id),
        EntityKind::Sensor => parts::sensor(database, id),
        EntityKind::Ip => parts::ip(database, id),
        EntityKind::Robot => parts::robot(database, id),
        EntityKind::Movement => motion::movement(database, id),
        EntityKind::Environment => motion::environment(database, id),
    }
}

/// An action, where the cursor is on one of its words.
fn action(database: &Database, position: FilePosition) -> Option<Hover> {
    entities_at(database, position).into_iter().find_map(|entity| {
        let Some(Entity::Movement(movement)) = &entity.parse.entity else { return None };
        let touches = |span: Span| span.shifted(entity.span.start).touches(position.offset);
        let index = movement.actions.iter().position(|action| touches(action.span))?;
        let span = movement.actions[index].span.shifted(entity.span.start);
        Some(Hover { span, markdown: motion::action(database, entity.id, index)? })
    })
}

fn keyword(database: &Database, position: FilePosition) -> Option<Hover> {
    let (token, span) = lexeme_at(database, position)?;
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
    fn parts_tell_their_measures_and_users() {
        check(
            &format!("{PARTS}robot r with port 1 has {{ wheelL$0 wheelR }} wheels"),
            &expect![[r#"
            wheelL
            ---
            ```pydslrep
            wheel wheelL with radius 4.5
            ```
            Wheel: radius 4.5 cm, 28.3 cm a turn. Used by `r`, `rover`.
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
            Bumper: feels an obstacle at contact. Nothing here uses it.
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
    fn a_robot_tells_its_kinematics() {
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
            r = 0.045 m, d = 0.3 m unless the scene says otherwise.

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
                r = 0.05 m, K = 0.275 m (half of track 0.3 m and wheelbase 0.25 m) unless the scene says otherwise.

                Nothing here uses it.
            "#]],
        );
    }

    #[test]
    fn a_skid_steered_robot_tells_what_it_scrubs() {
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
            r = 0.05 m, d = 0.508 m (track 0.3 m, times 1.69 for what tyres scrub in turns) unless the scene says otherwise.

            Nothing here uses it.
        "#]],
        );
    }

    #[test]
    fn an_action_tells_where_it_leads() {
        check(
            &format!("{PARTS}{}", REST.replace("turn left", "tu$0rn left")),
            &expect![[r#"
            turn left 90
            ---
            ```pydslrep
            turn left 90
            ```
            Takes 2.8 s. From (1 m, 0 m, 0°) to (1 m, 0 m, 90°), counted from where the movement starts.

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
            Where it ends cannot be planned: `turn right until { front }` ends when the way is free.
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
                Where it starts cannot be planned: `turn right until { front }` ends when the way is free.
            "#]],
        );
    }

    #[test]
    fn a_movement_tells_its_length() {
        check(
            &format!("{PARTS}{}", REST.replace("movement m", "movement m$0")),
            &expect![[r#"
            m
            ---
            ```pydslrep
            parallel movement m of rover { move 1.0 meters at 10 turn left 90 turn right until { front } slam }
            ```
            A movement of `rover`: drives 1 m and turns 90°. Its end cannot be planned, because of `turn right until { front }`.

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
            A movement of `rover`: drives 0.5 m and turns 0° in 5.7 s. It ends at (-0.5 m, 0 m, 0°) from where it starts.

            Used by `e`.
        "#]],
        );
    }

    #[test]
    fn an_environment_tells_its_timeline() {
        check(
            &format!("{PARTS}{}", REST.replace(" slam ", " ").replace("environment e", "environment $0e")),
            &expect![[r#"
                e
                ---
                ```pydslrep
                environment e has { rover } robots with { n m } moves
                ```
                Runs `rover`; takes a time that cannot be planned.

                | from | to | robot | movement |
                |---|---|---|---|
                | 0.0 s | 5.7 s | `rover` | `n` |
                | 5.7 s | ? | `rover` | `m` |

                Unknown from there in `m` on: `turn right until { front }` ends when the way is free, so where `rover` then is, and when anything after it begins, cannot be planned.

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
    fn broken_things_tell_what_they_can() {
        check(
            "robot $0r with port 1 has { a b } wheels",
            &expect![[r#"
                r
                ---
                ```pydslrep
                robot r with port 1 has { a b } wheels
                ```
                There is more to say of it once its errors are mended.
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
                There is more to say of it once its errors are mended.
            "#]],
        );
    }
}
