//! Go to type definition: from a movement, declared or listed in an environment, to its robot.

use pydslrep_analysis::{Database, EntityId};
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;

use crate::cursor::name_at;
use crate::definition::{Definition, Target, target};
use crate::{FilePosition, goto_definition};

/// The robot of the movement at a position; for the name of a robot, the robot itself.
pub fn goto_type_definition(database: &Database, position: FilePosition) -> Option<Definition> {
    let at = name_at(database, position)?;
    if at.kind == EntityKind::Robot {
        return goto_definition(database, position);
    }
    let movements = database.candidates(position.file, at.kind, &at.name.text);
    let mut targets: Vec<Target> = Vec::new();
    for target in movements.into_iter().flat_map(|id| robots_of(database, id)) {
        if !targets.contains(&target) {
            targets.push(target);
        }
    }
    (!targets.is_empty()).then_some(Definition { origin: at.span, targets })
}

/// The declarations of a movement's robot, as seen from the movement's file.
fn robots_of(database: &Database, id: EntityId) -> Vec<Target> {
    let (Some(Entity::Movement(movement)), Some(file)) = (database.tree(id), database.file_of(id)) else {
        return Vec::new();
    };
    let Some(robot) = &movement.robot else { return Vec::new() };
    let robots = database.candidates(file, EntityKind::Robot, &robot.text);
    robots.into_iter().filter_map(|robot| target(&database.entity(robot)?)).collect()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::at_cursor_in;

    fn check(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let found = goto_type_definition(&database, position).map(|definition| {
            let origin = database.slice(position.file, definition.origin);
            let targets = definition.targets.into_iter().map(|target| {
                format!(
                    "{origin} -> {}: {}",
                    database.path(target.file),
                    database.slice(target.file, target.full)
                )
            });
            targets.collect::<Vec<_>>().join("\n")
        });
        expected.assert_eq(&found.unwrap_or_else(|| "nothing".to_owned()));
    }

    #[test]
    fn a_movement_leads_to_its_robot() {
        check(
            &[("a.pyr", "robot r with port 1\nmovement $0m of r { turn left }")],
            &expect!["m -> a.pyr: robot r with port 1"],
        );
        check(
            &[("a.pyr", "robot ^robots with port 1\nmovement m of $0^robots { turn left }")],
            &expect!["^robots -> a.pyr: robot ^robots with port 1"],
        );
    }

    #[test]
    fn a_movement_that_is_done_leads_to_its_robot() {
        check(
            &[(
                "a.pyr",
                "robot r with port 1\nmovement m of r { slam }\nmovement n of r { repeat 2 times { do $0m } }",
            )],
            &expect!["m -> a.pyr: robot r with port 1"],
        );
    }

    #[test]
    fn the_robot_is_the_one_the_movement_sees() {
        check(
            &[
                ("deep.pyr", "robot r with port 3"),
                ("parts.pyr", "import \"deep.pyr\" movement m of r { turn left"),
                (
                    "main.pyr",
                    "import \"parts.pyr\" robot r with port 1 environment e has { r } robots with { m$0 } moves",
                ),
            ],
            &expect!["m -> deep.pyr: robot r with port 3"],
        );
    }

    #[test]
    fn twins_give_all_of_their_robots_once() {
        check(
            &[(
                "a.pyr",
                "robot r with port 1\nrobot q with port 2\nmovement m of r { }\nmovement m of q { }\nmovement m of r { }\nenvironment e has { r } robots with { m$0 } moves",
            )],
            &expect![[r"
                m -> a.pyr: robot r with port 1
                m -> a.pyr: robot q with port 2"]],
        );
    }

    #[test]
    fn nothing_else_has_a_type() {
        check(&[("a.pyr", "wheel $0w with radius 4")], &expect!["nothing"]);
        check(&[("a.pyr", "movement $0m of { }")], &expect!["nothing"]);
        check(&[("a.pyr", "movement $0m of nobody { }")], &expect!["nothing"]);
    }
}
