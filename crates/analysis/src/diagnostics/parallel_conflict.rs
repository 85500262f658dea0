//! `parallel-conflict`: one robot cannot do two movements at once.

use pydslrep_syntax::ast::{Entity, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "parallel-conflict",
    severity: Severity::Error,
    summary: "two movements of one robot run at the same time",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "Two `parallel` movements of the same robot are next to each other in an environment's list, so they \
        would start at the same time.",
    why: "A robot has one set of wheels and cannot drive ahead and turn at once. Let it do one after the other.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

parallel movement ahead of rover { move 1 meters }
parallel movement around of rover { turn left 180 }

environment yard has { rover } robots with { ahead around } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement ahead of rover { move 1 meters }
movement around of rover { turn left 180 }

environment yard has { rover } robots with { ahead around } moves",
};

/// A movement that runs beside others.
struct Running<'a> {
    robot: EntityId,
    name: &'a Name,
}

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    let mut group: Vec<Running<'_>> = Vec::new();
    for name in environment.movements.iter().flat_map(|list| &list.names) {
        // One that is not known may part the group.
        let Some((id, movement)) = context.movement(name).filter(|(_, movement)| movement.parallel.is_some())
        else {
            group.clear();
            continue;
        };
        let Some(robot) = context.robot_of(id, movement) else { continue };
        if let Some(other) = group.iter().find(|other| other.robot == robot) {
            let driven = movement.robot.map_or("", |name| name.text.as_str());
            problems.push(problem(context, driven, other, name));
        }
        group.push(Running { robot, name });
    }
}

fn problem(context: &Context<'_>, robot: &str, other: &Running<'_>, name: &Name) -> Problem {
    let message = if other.name.text == name.text {
        format!("`{robot}` cannot run `{}` twice at the same time", name.text)
    } else {
        format!("`{robot}` cannot run `{}` and `{}` at the same time", other.name.text, name.text)
    };
    RULE.problem(name.span, message)
        .related(context.id, other.name.span, format!("`{}` starts here and runs beside it", other.name.text))
        .help("remove `parallel` from one of them, or list a movement that is not parallel between them")
        .note("parallel movements that are next to each other in the list start together")
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n\
                         robot q with port 2 has { a b } wheels\nparallel movement m of r { turn left }\nparallel movement n of r { turn left }\n\
                         parallel movement o of q { turn left }\nmovement p of q { turn left }\n";

    #[test]
    fn one_robot_does_one_thing_at_a_time() {
        check(
            &format!("{PARTS}environment e has {{ r q }} robots with {{ m o n }} moves"),
            &expect![[r#"
                error[parallel-conflict] 9:45 "n" `r` cannot run `m` and `n` at the same time
                  see 9:41 "m" `m` starts here and runs beside it
                  help: remove `parallel` from one of them, or list a movement that is not parallel between them
                  note: parallel movements that are next to each other in the list start together
            "#]],
        );
        check(
            &format!("{PARTS}environment e has {{ r q }} robots with {{ p o o }} moves"),
            &expect![[r#"
                error[parallel-conflict] 9:45 "o" `q` cannot run `o` twice at the same time
                  see 9:43 "o" `o` starts here and runs beside it
                  help: remove `parallel` from one of them, or list a movement that is not parallel between them
                  note: parallel movements that are next to each other in the list start together
            "#]],
        );
    }

    #[test]
    fn a_movement_that_is_not_known_may_part_groups() {
        check(
            &format!("{PARTS}environment e has {{ r q }} robots with {{ m unknown n o }} moves"),
            &expect![[r#"
                error[unresolved-reference] 9:43 "unknown" there is no movement called `unknown`
                  help: the movements are `m`, `n`, `o`, `p`
            "#]],
        );
    }

    #[test]
    fn a_serial_movement_parts_groups() {
        check_clean(&format!("{PARTS}environment e has {{ r q }} robots with {{ m o p n o }} moves"));
    }
}
