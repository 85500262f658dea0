//! `implausible-radius`: a radius that was probably measured in millimetres, or in metres.

use pydslrep_syntax::ast::{Entity, Number};

use super::context::Context;
use super::invalid_radius::is_possible;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "implausible-radius",
    severity: Severity::Warning,
    summary: "a wheel's radius is above 100 cm or below 0.5 cm, so it was probably measured in another unit",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A wheel's radius is more than 100 centimetres (taller than a person) or less than half a centimetre (smaller \
        than a pea).",
    why: "A radius is written in centimetres, but many data sheets give millimetres, and the simulator metres. A \
        number copied from there makes the wheel ten times too large or a hundred times too small. The script \
        would then turn it at the wrong speed, and the robot would creep or race.",
    imports: &[],
    example: "wheel wheelL with radius 0.045",
    fixed: "wheel wheelL with radius 4.5",
};

/// Centimetres.
const MIN_PLAUSIBLE: f64 = 0.5;
const MAX_PLAUSIBLE: f64 = 100.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Wheel(wheel)) = context.tree else { return };
    let Some(radius) = &wheel.radius else { return };
    let Some(value) = radius.value.filter(|value| is_possible(*value)) else { return };
    if value > MAX_PLAUSIBLE {
        let problem = RULE
            .problem(radius.span, format!("with a radius of {value} cm this wheel is taller than a person"));
        let note = "a radius is in centimetres; was this one measured in millimetres?";
        problems.push(converted(context, problem.note(note), radius, value / 10.0));
    } else if value > 0.0 && value < MIN_PLAUSIBLE {
        let in_centimetres = rounded(value * 100.0);
        let problem = if is_plausible(in_centimetres) {
            RULE.problem(radius.span, format!("did you mean {in_centimetres} cm? radii are in centimetres"))
        } else {
            RULE.problem(radius.span, format!("with a radius of {value} cm this wheel is smaller than a pea"))
        };
        let note = "a radius is in centimetres; was this one measured in metres?";
        problems.push(converted(context, problem.note(note), radius, in_centimetres));
    }
}

fn is_plausible(value: f64) -> bool {
    (MIN_PLAUSIBLE..=MAX_PLAUSIBLE).contains(&value)
}

/// Without what a multiplication of binary fractions adds: 0.07 · 100 is 7.000000000000001.
fn rounded(value: f64) -> f64 {
    const DIGITS: f64 = 1e9;
    (value * DIGITS).round() / DIGITS
}

/// Offers the value in centimetres, if it is plausible.
fn converted(context: &Context<'_>, problem: Problem, radius: &Number, in_centimetres: f64) -> Problem {
    if !is_plausible(in_centimetres) {
        return problem;
    }
    problem.suggestion(
        format!("change to {in_centimetres}"),
        [context.replace(radius.span, in_centimetres.to_string())],
    )
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

    #[test]
    fn metres_are_suspected() {
        check(
            "wheel a with radius 0.045\nwheel b with radius 0.07\nwheel c with radius 0.001",
            &expect![[r#"
                warning[implausible-radius] 1:21 "0.045" did you mean 4.5 cm? radii are in centimetres
                  note: a radius is in centimetres; was this one measured in metres?
                  suggestion: change to 4.5 -> wheel a with radius 4.5
                warning[implausible-radius] 2:21 "0.07" did you mean 7 cm? radii are in centimetres
                  note: a radius is in centimetres; was this one measured in metres?
                  suggestion: change to 7 -> wheel b with radius 7
                warning[implausible-radius] 3:21 "0.001" with a radius of 0.001 cm this wheel is smaller than a pea
                  note: a radius is in centimetres; was this one measured in metres?
            "#]],
        );
        check_clean("wheel a with radius 0.5");
    }
}
