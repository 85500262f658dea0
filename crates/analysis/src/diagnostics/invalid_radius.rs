//! `invalid-radius`: a wheel without size.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::{Applicability, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-radius",
    severity: Severity::Error,
    summary: "a wheel's radius is zero or negative",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A wheel's radius is zero or negative.",
    why: "The radius is the distance from the centre of the wheel to its edge, in centimetres. The script divides by \
        it to compute how fast the wheel turns, and a wheel without size cannot roll.",
    imports: &[],
    example: "wheel wheelL with radius 0",
    fixed: "wheel wheelL with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Wheel(wheel)) = context.tree else { return };
    if let Some(radius) =
        wheel.radius.as_ref().filter(|radius| radius.value.is_some_and(|value| value <= 0.0))
    {
        let written = context.text(radius.span);
        problems.push(
            RULE.problem(radius.span, format!("a wheel's radius must be above zero, not {written} cm"))
                .help("write the radius in centimetres, such as `4.5`"),
        );
    }
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
}
