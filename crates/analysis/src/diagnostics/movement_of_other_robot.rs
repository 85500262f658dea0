//! `movement-of-other-robot`: `do` names a movement of another robot.

use pydslrep_syntax::ast::{Action, Entity, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "movement-of-other-robot",
    severity: Severity::Error,
    summary: "`do` names a movement of another robot",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A movement does another movement, but that one is of another robot.",
    why: "What is done is done by the robot of the movement that says so. To let another robot drive, list its \
        movement in the environment.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement side of scout { move 1 meters }

movement trip of rover { do side }

environment yard has { rover scout } robots with { trip side } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels
robot scout with port 23001 has { wheelL wheelR } wheels

movement side of rover { move 1 meters }

movement trip of rover { do side }

movement walk of scout { move 1 meters }

environment yard has { rover scout } robots with { trip walk } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some(own) = &movement.robot else { return };
    let Some((robot, _)) = context.robot(own) else { return };
    for done in context.actions().filter_map(Action::done) {
        let Some((id, other)) = context.movement(done) else { continue };
        let theirs = context.robot_of(id, other).filter(|other| *other != robot);
        problems.extend(theirs.zip(other.robot).map(|(_, name)| problem(context, done, own, (id, name))));
    }
}

fn problem(context: &Context<'_>, done: &Name, own: &Name, (id, theirs): (EntityId, &Name)) -> Problem {
    RULE.problem(
        done.span,
        format!("`{}` is a movement of `{}`, but this one moves `{}`", done.text, theirs.text, own.text),
    )
    .help(format!("do a movement of `{}`, or list `{}` in the environment", own.text, done.text))
    .related(context.id, own.span, format!("this movement is of `{}`", own.text))
    .related(id, theirs.span, format!("`{}` is of `{}`", done.text, theirs.text))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{PARTS, check, check_clean, program};

    #[test]
    fn a_robot_does_its_own_movements() {
        check(
            &format!(
                "{}\nrobot q with port 2 has {{ a b }} wheels\nmovement n of q {{ slam }}",
                program("do n")
            ),
            &expect![[r#"
                error[movement-of-other-robot] 6:22 "n" `n` is a movement of `q`, but this one moves `r`
                  see 6:15 "r" this movement is of `r`
                  see 8:15 "q" `n` is of `q`
                  help: do a movement of `r`, or list `n` in the environment
                error[slam-sensors] 8:19 "slam" `slam` needs 5 distance sensors, and `q` has none
                  see 7:7 "q" `q` is declared here
                  help: declare more sensors, and add them to the robot: `with sensors { … }`
            "#]],
        );
        check_clean(&format!("{}\nmovement n of r {{ turn left }}", program("do n")));
    }

    #[test]
    fn a_robot_of_the_same_name_is_another_one() {
        let count = |own: &str| {
            let mut database = crate::Database::new();
            database.open("parts.pyr", &format!("{PARTS}movement n of r {{ turn left }}"));
            let text = format!("import \"parts.pyr\"\n{own}movement m of r {{ do n }}");
            let file = database.open("a.pyr", &text);
            database.diagnostics(file).iter().filter(|found| found.code() == super::RULE.code).count()
        };
        let robot = "robot r with port 1 has { a b } wheels\n";
        assert_eq!((count(""), count(robot)), (0, 1));
    }
}
