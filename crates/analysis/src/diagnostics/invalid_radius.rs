//! `invalid-radius`: a wheel without size, or beyond every robot.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-radius",
    severity: Severity::Error,
    summary: "a wheel's radius is zero or negative, or one that no wheel has",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A wheel's radius is zero or negative, below 0.001 centimetres, or above 100000 (a kilometre).",
    why: "The radius is the distance from the centre of the wheel to its edge, in centimetres. The script divides by \
        it to compute how fast the wheel turns, and a wheel without size cannot roll.",
    imports: &[],
    example: "wheel wheelL with radius 0",
    fixed: "wheel wheelL with radius 4.5",
};

/// Centimetres.
const MIN_RADIUS: f64 = 0.001;
const MAX_RADIUS: f64 = 100_000.0;

/// Returns whether any wheel could have this radius, in centimetres.
pub(super) fn is_possible(radius: f64) -> bool {
    (MIN_RADIUS..=MAX_RADIUS).contains(&radius)
}

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Wheel(wheel)) = context.tree else { return };
    let Some(radius) = &wheel.radius else { return };
    let Some(value) = radius.value.filter(|value| !value.is_infinite() && !is_possible(*value)) else {
        return;
    };
    let written = context.short_text(radius.span);
    let message = if value <= 0.0 {
        format!("a wheel's radius must be above zero, not {written} cm")
    } else {
        format!("a wheel's radius is from {MIN_RADIUS} to {MAX_RADIUS} cm, not {written}")
    };
    let problem = RULE.problem(radius.span, message);
    problems.push(problem.help("write the radius in centimetres, such as `4.5`"));
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn a_radius_is_above_zero() {
        check(
            "wheel a with radius 0\nwheel b with radius -4.5",
            &expect![[r#"
            error[invalid-radius] 1:21 "0" a wheel's radius must be above zero, not 0 cm
              help: write the radius in centimetres, such as `4.5`
            error[invalid-radius] 2:21 "-4.5" a wheel's radius must be above zero, not -4.5 cm
              help: write the radius in centimetres, such as `4.5`
        "#]],
        );
        check_clean("wheel a with radius 0.5");
    }

    #[test]
    fn a_radius_is_one_that_wheels_have() {
        check(
            &format!("wheel a with radius 0.{}1\nwheel b with radius 1{}", "0".repeat(299), "0".repeat(300)),
            &expect![[r#"
                error[invalid-radius] 1:21 "0.000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001" a wheel's radius is from 0.001 to 100000 cm, not 0.000000000000000000…
                  help: write the radius in centimetres, such as `4.5`
                error[invalid-radius] 2:21 "1000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000" a wheel's radius is from 0.001 to 100000 cm, not 10000000000000000000…
                  help: write the radius in centimetres, such as `4.5`
            "#]],
        );
    }
}
