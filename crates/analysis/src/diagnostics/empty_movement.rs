//! `empty-movement`: a movement without actions.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "empty-movement",
    severity: Severity::Warning,
    summary: "a movement without actions",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "There is nothing between the braces of a movement.",
    why: "The robot would not move. Probably the actions are still missing.",
    imports: &[],
    example: trip!("{ }"),
    fixed: trip!("{ move 1 meters turn left }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some(body) = movement.body.filter(|_| movement.actions.is_empty() && context.errors.is_empty())
    else {
        return;
    };
    problems.push(
        RULE.problem(body, "this movement has no actions, so the robot stays where it is")
            .help("write actions between the braces, such as `move 1.0 meters` or `turn left`"),
    );
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str =
        "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n";

    #[test]
    fn a_movement_does_something() {
        check(
            &format!("{PARTS}movement m of r {{ }}"),
            &expect![[r#"
                warning[empty-movement] 4:17 "{ }" this movement has no actions, so the robot stays where it is
                  help: write actions between the braces, such as `move 1.0 meters` or `turn left`
            "#]],
        );
        check_clean(&format!("{PARTS}movement m of r {{ turn left }}"));
    }
}
