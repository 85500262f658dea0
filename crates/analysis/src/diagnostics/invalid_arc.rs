//! `invalid-arc`: a circle that nobody can drive on.

use pydslrep_syntax::ast::{ActionKind, Circle, Turn};

use super::context::Context;
use super::example::trip;
use super::number_out_of_range::MAX_DISTANCE;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-arc",
    severity: Severity::Error,
    summary: "a circle that nobody can drive on",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The radius of a circle is zero, negative or beyond 1000 kilometres, a turn by 0 degrees has a \
        circle, or a turn in place is `in reverse`.",
    why: "A robot drives forward or in reverse along a circle whose radius is above zero. A turn in place has \
        no circle and no direction: leave out `in reverse`, or say `with radius`.",
    imports: &[],
    example: trip!("{ turn left with radius 0 meters }"),
    fixed: trip!("{ turn left with radius 1 meters }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let ActionKind::Turn(turn) = &action.kind else { continue };
        match &turn.circle {
            Some(circle) => {
                problems.extend(radius(context, circle));
                problems.extend(no_turn(turn));
            }
            None => problems.extend(turn.reverse.map(|reverse| {
                RULE.problem(reverse, "a turn in place has no reverse")
                    .help("leave out `in reverse`, or write `with radius` and how far away the centre is")
            })),
        }
    }
}

fn radius(context: &Context<'_>, circle: &Circle) -> Option<Problem> {
    let radius = circle.radius.as_ref()?;
    let value = radius.value.filter(|value| value.is_finite())?;
    let metres = value * circle.unit.map_or(1.0, |(unit, _)| unit.in_metres());
    let written = context.short_text(radius.span);
    if value <= 0.0 {
        return Some(
            RULE.problem(radius.span, format!("the radius of a circle must be above zero, not {written}"))
                .help("write how far away the centre is; to turn in place, leave out `with radius`"),
        );
    }
    let problem =
        || RULE.problem(radius.span, "the radius of a circle can be at most 1000 km (1000000 meters)");
    (metres > MAX_DISTANCE).then(|| problem().help("write a shorter radius"))
}

fn no_turn(turn: &Turn) -> Option<Problem> {
    let angle = turn.angle.as_ref().filter(|angle| angle.value == Some(0.0))?;
    Some(
        RULE.problem(angle.span, "a turn by 0 degrees goes nowhere on its circle")
            .help("write by how much the heading is to change"),
    )
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn circles_have_a_radius() {
        check(
            &program("turn left with radius -1 meters turn left with radius 1000001 meters"),
            &expect![[r#"
                error[invalid-arc] 6:41 "-1" the radius of a circle must be above zero, not -1
                  help: write how far away the centre is; to turn in place, leave out `with radius`
                error[invalid-arc] 6:73 "1000001" the radius of a circle can be at most 1000 km (1000000 meters)
                  help: write a shorter radius
            "#]],
        );
        check_clean(&program(
            "turn left with radius 1000000 meters turn left with radius 100000000 centimeters",
        ));
        check(
            &program("turn left 0 with radius 1 meters turn left in reverse"),
            &expect![[r#"
            error[invalid-arc] 6:29 "0" a turn by 0 degrees goes nowhere on its circle
              help: write by how much the heading is to change
            error[invalid-arc] 6:62 "in reverse" a turn in place has no reverse
              help: leave out `in reverse`, or write `with radius` and how far away the centre is
        "#]],
        );
        check_clean(&program(
            "turn left with radius 1 centimeters turn left 720 with radius 1 meters in reverse",
        ));
    }
}
