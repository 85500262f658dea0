//! `invalid-speed`: a speed of nothing, backwards, or beyond every robot.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{ActionKind, Number};

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-speed",
    severity: Severity::Error,
    summary: "a speed is zero or negative, or one that no robot has",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The speed after `at` is zero or negative, below 0.001 centimetres per second, or above 10000.",
    why: "A robot with speed zero never arrives, and one at 0.001 centimetres per second takes more than a day for a \
        metre. 10000 centimetres per second are 360 kilometres per hour. A speed has no direction: to drive \
        backwards, make the distance negative. Without `at`, the robot drives at 9 centimetres per second.",
    imports: &[],
    example: trip!("{ move 1 meters at -12 }"),
    fixed: trip!("{ move -1 meters at 12 }"),
};

/// Centimetres per second.
const MIN_SPEED: f64 = 0.001;
const MAX_SPEED: f64 = 10_000.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let (clause, distance) = match &action.kind {
            ActionKind::Move(step) => (&step.speed, step.distance.as_ref()),
            ActionKind::Turn(turn) => (&turn.speed, None),
            _ => continue,
        };
        let speed = clause.as_ref().and_then(|clause| clause.value.as_ref());
        let Some(speed) = speed else { continue };
        match speed.value.filter(|value| value.is_finite()) {
            Some(value) if value <= 0.0 => problems.push(problem(context, distance, speed)),
            Some(value) if !(MIN_SPEED..=MAX_SPEED).contains(&value) => problems.push(beyond(context, speed)),
            _ => {}
        }
    }
}

fn beyond(context: &Context<'_>, speed: &Number) -> Problem {
    let written = context.short_text(speed.span);
    RULE.problem(speed.span, format!("a speed is from {MIN_SPEED} to {MAX_SPEED} cm/s, not {written}"))
        .help("write how fast to drive, or leave out `at` and drive at 9.0 cm/s")
}

fn problem(context: &Context<'_>, distance: Option<&Number>, speed: &Number) -> Problem {
    let written = context.short_text(speed.span);
    let problem = RULE.problem(speed.span, format!("a speed must be above zero, not {written} cm/s"));
    let negative = speed.value.is_some_and(|value| value < 0.0);
    let problem = problem.help(if negative && distance.is_some() {
        "to drive backwards, make the distance negative and the speed positive"
    } else {
        "write how fast to drive, or leave out `at` and drive at 9.0 cm/s"
    });
    match distance {
        Some(distance) if negative => problem.suggestion(
            "negate the distance instead",
            [
                context.replace(Span::new(speed.span.start, speed.span.start + 1), ""),
                negated(context, distance),
            ],
        ),
        _ => problem,
    }
}

fn negated(context: &Context<'_>, distance: &Number) -> super::edits::ProblemEdit {
    if context.text(distance.span).starts_with('-') {
        context.replace(Span::new(distance.span.start, distance.span.start + 1), "")
    } else {
        context.replace(Span::at(distance.span.start), "-")
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    fn program(action: &str) -> String {
        format!(
            "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has {{ a b }} wheels\nmovement m of r {{ {action} }}"
        )
    }

    #[test]
    fn a_speed_is_above_zero() {
        check(
            &program("move 4 meters at 0"),
            &expect![[r#"
                error[invalid-speed] 4:36 "0" a speed must be above zero, not 0 cm/s
                  help: write how fast to drive, or leave out `at` and drive at 9.0 cm/s
            "#]],
        );
        check(
            &program("move 4 meters at -9.5"),
            &expect![[r#"
                error[invalid-speed] 4:36 "-9.5" a speed must be above zero, not -9.5 cm/s
                  help: to drive backwards, make the distance negative and the speed positive
                  suggestion: negate the distance instead -> movement m of r { move -4 meters at 9.5 }
            "#]],
        );
        check(
            &program("move -4 meters at -9.5"),
            &expect![[r#"
                error[invalid-speed] 4:37 "-9.5" a speed must be above zero, not -9.5 cm/s
                  help: to drive backwards, make the distance negative and the speed positive
                  suggestion: negate the distance instead -> movement m of r { move 4 meters at 9.5 }
            "#]],
        );
        check_clean(&program("move 4 meters at 0.1"));
    }

    #[test]
    fn a_speed_is_one_that_robots_have() {
        check(
            &program(&format!("move 4 meters at 0.{}1", "0".repeat(299))),
            &expect![[r#"
            error[invalid-speed] 4:36 "0.000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001" a speed is from 0.001 to 10000 cm/s, not 0.000000000000000000…
              help: write how fast to drive, or leave out `at` and drive at 9.0 cm/s
        "#]],
        );
        check(
            &program("move 4 meters at 10000.1"),
            &expect![[r#"
            error[invalid-speed] 4:36 "10000.1" a speed is from 0.001 to 10000 cm/s, not 10000.1
              help: write how fast to drive, or leave out `at` and drive at 9.0 cm/s
        "#]],
        );
        check_clean(&program("move 4 meters at 0.001 move 1 meters at 10000"));
    }
}
