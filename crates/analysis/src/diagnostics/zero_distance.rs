//! `zero-distance`: a move that goes nowhere.

use pydslrep_syntax::ast::ActionKind;

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "zero-distance",
    severity: Severity::Warning,
    summary: "a move over no distance, which does nothing",
    tag: Some(Tag::Unnecessary),
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot moves 0 meters or 0 centimeters.",
    why: "The robot stays where it is, so the line has no effect. Maybe a number was to be filled in later.",
    imports: &[],
    example: trip!("{ turn left move 0 meters }"),
    fixed: trip!("{ turn left }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let ActionKind::Move(step) = &action.kind else { continue };
        if let Some(distance) = step.distance.as_ref().filter(|distance| distance.value == Some(0.0)) {
            problems.push(
                RULE.problem(distance.span, "this move goes nowhere, since its distance is zero")
                    .fix("remove the move", [context.remove(action.span)]),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    fn program(actions: &str) -> String {
        format!(
            "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has {{ a b }} wheels\nmovement m of r {{{actions}}}"
        )
    }

    #[test]
    fn the_move_is_removed() {
        check(
            &program("\n  turn left // first\n  move 0.0 meters\n  move -0 meters at 4\n  turn right\n"),
            &expect![[r#"
                warning[zero-distance] 6:8 "0.0" this move goes nowhere, since its distance is zero
                  fix: remove the move -> 
                warning[zero-distance] 7:8 "-0" this move goes nowhere, since its distance is zero
                  fix: remove the move -> 
            "#]],
        );
        check_clean(&program(" move 0.001 centimeters "));
    }
}
