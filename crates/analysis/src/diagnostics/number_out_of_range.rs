//! `number-out-of-range`: a distance nobody drives, or digits without end.

use pydslrep_syntax::ast::{ActionKind, Entity, Move, Number, Within};

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "number-out-of-range",
    severity: Severity::Error,
    summary: "a distance beyond 1000 km, or a number too large to calculate with",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A move is longer than 1000 kilometres, or a radius, a speed or an angle has hundreds of digits.",
    why: "At the default 9 centimetres per second, 1000 kilometres take more than four months. Usually there are some \
        zeros too many, or `meters` was written for `centimeters`. Numbers of hundreds of digits exceed what a \
        computer calculates with.",
    imports: &[],
    example: trip!("{ move 2000000 meters }"),
    fixed: trip!("{ move 2000 meters }"),
};

/// Metres.
pub(super) const MAX_DISTANCE: f64 = 1_000_000.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    if let Some(Entity::Wheel(wheel)) = context.tree {
        problems.extend(wheel.radius.as_ref().and_then(infinite));
    }
    for action in context.actions() {
        let within = action.conditions().filter_map(|condition| condition.within.as_ref());
        let within: Vec<&Within> = within.collect();
        let lengths = within.iter().filter_map(|within| within.distance.as_ref());
        problems.extend(action.numbers().chain(lengths).filter_map(infinite));
        problems.extend(within.into_iter().filter_map(too_far_within));
        if let ActionKind::Move(step) = &action.kind {
            problems.extend(too_far(step));
        }
    }
}

fn infinite(number: &Number) -> Option<Problem> {
    let problem = || RULE.problem(number.span, "this number is too large to compute with");
    (!number.value?.is_finite()).then(|| problem().help("write fewer digits"))
}

fn too_far_within(within: &Within) -> Option<Problem> {
    let distance = within.distance.as_ref()?;
    let metres = distance.value? * within.unit.map_or(1.0, |(unit, _)| unit.in_metres());
    let problem = || RULE.problem(distance.span, "no sensor sees farther than 1000 km (1000000 meters)");
    (metres.is_finite() && metres > MAX_DISTANCE).then(|| problem().help("write a shorter distance"))
}

fn too_far(step: &Move) -> Option<Problem> {
    let distance = step.distance.as_ref()?;
    let metres = distance.value?.abs() * step.unit.map_or(1.0, |(unit, _)| unit.in_metres());
    let problem = || RULE.problem(distance.span, "a move can be at most 1000 km (1000000 meters) long");
    (metres.is_finite() && metres > MAX_DISTANCE).then(|| problem().help("write a shorter distance"))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn distances_end_at_a_thousand_kilometres() {
        let program = |distance: &str| {
            format!(
                "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has {{ a b }} wheels\nmovement m of r {{ move {distance} }}"
            )
        };
        check(
            &program("-1000000.1 meters"),
            &expect![[r#"
                error[number-out-of-range] 4:24 "-1000000.1" a move can be at most 1000 km (1000000 meters) long
                  help: write a shorter distance
            "#]],
        );
        check_clean(&program("100000000 centimeters"));
    }

    #[test]
    fn numbers_are_finite() {
        check(
            &format!("wheel a with radius {}", "9".repeat(400)),
            &expect![[r#"
            error[number-out-of-range] 1:21 "9999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999" this number is too large to compute with
              help: write fewer digits
        "#]],
        );
    }
}
