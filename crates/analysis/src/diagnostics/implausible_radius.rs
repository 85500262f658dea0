//! `implausible-radius`: a wheel taller than a person was probably measured in millimetres.

use pydslrep_syntax::ast::Entity;

use super::context::{Context, Problem};
use super::{Page, Remedy, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "implausible-radius",
    severity: Severity::Warning,
    summary: "a wheel's radius is above 100 cm, so it was probably measured in millimetres",
    tag: None,
    remedy: Remedy::Suggested,
    seeks_names: false,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A wheel's radius is more than 100 centimetres, so that the wheel would be taller than a person.",
    why: "A radius is written in centimetres, but many data sheets give millimetres. A number copied from \
        there makes the wheel ten times too large. The script would then turn it ten times too slowly, and \
        the robot would only creep.",
    imports: &[],
    example: "wheel wheelL with radius 225",
    fixed: "wheel wheelL with radius 22.5",
};

/// Centimetres.
const LARGEST: f64 = 100.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Wheel(wheel)) = context.tree else { return };
    let Some(radius) = &wheel.radius else { return };
    let Some(value) = radius.value.filter(|value| value.is_finite() && *value > LARGEST) else { return };
    let problem = RULE
        .problem(radius.span, format!("with a radius of {value} cm this wheel is taller than a person"))
        .note("a radius is in centimetres; was this one measured in millimetres?");
    let tenth = value / 10.0;
    problems.push(if tenth <= LARGEST {
        problem.suggestion(format!("change to {tenth}"), [context.replace(radius.span, tenth.to_string())])
    } else {
        problem
    });
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn millimetres_are_suspected() {
        check(
            "wheel a with radius 450\nwheel b with radius 4500.5",
            &expect![[r#"
                warning[implausible-radius] 1:21 "450" with a radius of 450 cm this wheel is taller than a person
                  note: a radius is in centimetres; was this one measured in millimetres?
                  suggestion: change to 45 -> wheel a with radius 45
                warning[implausible-radius] 2:21 "4500.5" with a radius of 4500.5 cm this wheel is taller than a person
                  note: a radius is in centimetres; was this one measured in millimetres?
            "#]],
        );
        check_clean("wheel a with radius 100");
    }
}
