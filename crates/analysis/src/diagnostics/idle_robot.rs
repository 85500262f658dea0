//! `idle-robot`: an environment lists a robot that none of its movements drives.

use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;

use crate::EntityId;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "idle-robot",
    severity: Severity::Hint,
    summary: "an environment lists a robot that none of its movements drives",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "An environment lists a robot, but none of its movements belongs to that robot.",
    why: "The script connects to the robot and never moves it. That may be intended, if the robot is only an obstacle \
        for others. If not, a movement is missing from the list.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement go of rover { move 1 meters }

environment yard has { rover scout } robots with { go } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement go of rover { move 1 meters }
movement follow of scout { move 1 meters }

environment yard has { rover scout } robots with { go follow } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    if !context.errors.is_empty() {
        return;
    }
    let movements = environment.movements.as_ref().map_or(&[][..], |list| &list.names);
    let known: Vec<_> = movements.iter().map(|name| context.movement(name)).collect();
    // A movement that is not known may drive any robot.
    if known.iter().any(Option::is_none) || environment.movements.as_ref().is_some_and(|list| list.broken) {
        return;
    }
    let driven: Vec<Option<EntityId>> =
        known.into_iter().flatten().map(|(id, movement)| context.robot_of(id, movement)).collect();
    if driven.iter().any(Option::is_none) {
        return;
    }
    for name in environment.robots.iter().flat_map(|list| &list.names) {
        let Some(robot) = context.resolve(EntityKind::Robot, name).entity() else { continue };
        if !driven.contains(&Some(robot)) {
            problems.push(
                RULE.problem(name.span, format!("no movement of this environment drives `{}`", name.text))
                    .help("list one of its movements, or leave the robot out"),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check_whole, check_whole_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n\
                         robot q with port 1 has { a b } wheels\nmovement m of r { turn left }\nmovement n of q { turn left }\n";

    #[test]
    fn every_robot_has_something_to_do() {
        check_whole(
            &format!(
                "{PARTS}environment e has {{ r q }} robots with {{ m }} moves environment f has {{ q }} robots with {{ n }} moves"
            ),
            &expect![[r#"
                hint[idle-robot] 7:23 "q" no movement of this environment drives `q`
                  help: list one of its movements, or leave the robot out
            "#]],
        );
        check_whole_clean(&format!("{PARTS}environment e has {{ r q }} robots with {{ m n }} moves"));
    }
}
