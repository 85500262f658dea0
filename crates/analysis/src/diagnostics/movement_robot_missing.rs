//! `movement-robot-missing`: an environment runs a movement of a robot that it does not have.

use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::{Entity, Name, References};

use super::context::Context;
use super::edits::append;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::signature::MovementSignature;
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "movement-robot-missing",
    severity: Severity::Error,
    summary: "an environment lists a movement whose robot it does not list",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "An environment lists a movement of a robot that is not among its robots.",
    why: "The script connects only to the robots that the environment lists, so it could not drive this one.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement go of rover { move 1 meters }
movement follow of scout { move 1 meters }

environment yard has { rover } robots with { go follow } moves",
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
    let (Some(robots), Some(movements)) = (&environment.robots, &environment.movements) else { return };
    if robots.broken || robots.names.is_empty() && !context.errors.is_empty() {
        return;
    }
    let listed: Vec<EntityId> =
        robots.names.iter().filter_map(|name| context.resolve(EntityKind::Robot, name).entity()).collect();
    for name in &movements.names {
        let Some((id, movement)) = context.movement(name) else { continue };
        let Some(robot) = context.robot_of(id, movement).filter(|robot| !listed.contains(robot)) else {
            continue;
        };
        problems.push(problem(context, name, (id, movement), robot, robots));
    }
}

fn problem(
    context: &Context<'_>,
    name: &Name,
    (id, movement): (EntityId, MovementSignature<'_>),
    robot: EntityId,
    robots: &References,
) -> Problem {
    let driven = movement.robot.map_or("", |name| name.text.as_str());
    let mut problem = RULE.problem(
        name.span,
        format!("`{}` moves `{driven}`, which is not among the robots of this environment", name.text),
    );
    problem = problem.help(format!("list `{driven}` among the robots, or leave `{}` out", name.text));
    if let Some(reference) = movement.robot {
        problem = problem.related(id, reference.span, format!("`{}` is a movement of `{driven}`", name.text));
    }
    // The name must mean the same robot here.
    let visible = movement.robot.and_then(|name| context.resolve(EntityKind::Robot, name).entity());
    if visible == Some(robot) {
        problem =
            problem.fix(format!("add `{driven}` to the robots"), [append(context.id, robots, driven, " ")]);
    }
    problem
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n\
                         robot q with port 2 has { a b } wheels\nmovement m of r { turn left }\nmovement n of q { turn left }\n";

    #[test]
    fn the_robot_is_added() {
        check(
            &format!("{PARTS}environment e has {{ r }} robots with {{ m n }} moves"),
            &expect![[r#"
                error[movement-robot-missing] 7:41 "n" `n` moves `q`, which is not among the robots of this environment
                  see 6:15 "q" `n` is a movement of `q`
                  help: list `q` among the robots, or leave `n` out
                  fix: add `q` to the robots -> environment e has { r q } robots with { m n } moves
            "#]],
        );
        check(
            &format!("{PARTS}environment e has {{}} robots with {{ m }} moves"),
            &expect![[r#"
                warning[empty-environment] 7:19 "{}" this environment has no robots, so nothing drives in it
                  help: name its robots between the braces
                error[movement-robot-missing] 7:36 "m" `m` moves `r`, which is not among the robots of this environment
                  see 5:15 "r" `m` is a movement of `r`
                  help: list `r` among the robots, or leave `m` out
                  fix: add `r` to the robots -> environment e has { r } robots with { m } moves
            "#]],
        );
        check_clean(&format!("{PARTS}environment e has {{ r, q }} robots with {{ n m n }} moves"));
    }

    #[test]
    fn the_robot_is_offered_as_soon_as_its_name_means_it_here() {
        let mut database = crate::Database::new();
        database.open(
            "lib.pyr",
            "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n\
             movement m of r { turn left }",
        );
        // Text right beside an edit is read again anyway; neither the environment nor its robot may be right beside it.
        let twin = "robot r\n";
        let program = format!(
            "import \"lib.pyr\"\n{twin}sensor between\nrobot q with port 3 has {{ a b }} wheels\n\
             environment e has {{ q }} robots with {{ m }} moves"
        );
        let file = database.open("a.pyr", &program);
        let offers = |database: &crate::Database| -> Vec<usize> {
            let diagnostics = database.diagnostics(file).into_iter();
            diagnostics
                .filter(|found| found.code() == super::RULE.code)
                .map(|found| found.fixes.len())
                .collect()
        };
        assert_eq!(offers(&database), [0]);
        let start = u32::try_from(program.find("robot r").unwrap()).unwrap();
        let end = start + u32::try_from(twin.len()).unwrap();
        database.edit(file, pydslrep_syntax::Span::new(start, end), "");
        assert_eq!(offers(&database), [1]);
    }
}
