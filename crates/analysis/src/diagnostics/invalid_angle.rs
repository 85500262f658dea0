//! `invalid-angle`: an angle that is none, more than a turn, or the other way round.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Action, ActionKind, Direction, Number, Turn};

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-angle",
    severity: Severity::Warning,
    summary: "an angle is negative, zero or more than a full turn; an error beyond 100 turns",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The angle of a turn is negative, zero, or more than 360 degrees.",
    why: "`left` and `right` already give the direction; a minus sign would reverse it, which is hard to read. A turn \
        by 0 degrees does nothing. More than 360 degrees is more than a full turn: a smaller angle ends at the same \
        heading sooner. Beyond 36000 degrees, which are 100 turns, it is an error: no robot is meant to turn for so \
        long.",
    imports: &[],
    example: trip!("{ turn left -90 }"),
    fixed: trip!("{ turn right 90 }"),
};

/// Degrees.
const FULL_TURN: f64 = 360.0;
const MAX_ANGLE: f64 = 100.0 * FULL_TURN;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let ActionKind::Turn(turn) = &action.kind else { continue };
        let Some(angle) = &turn.angle else { continue };
        match angle.value.filter(|value| value.is_finite()) {
            Some(value) if value.abs() > MAX_ANGLE => problems.push(beyond(context, angle)),
            Some(value) if value < 0.0 => problems.push(backwards(context, turn, angle)),
            // `invalid-arc` says what is wrong with it.
            Some(0.0) if turn.circle.is_some() => {}
            Some(0.0) => problems.push(nothing(context, action, angle)),
            Some(value) if value > FULL_TURN && turn.circle.is_none() => {
                problems.push(too_far(context, action, angle, value));
            }
            _ => {}
        }
    }
}

fn beyond(context: &Context<'_>, angle: &Number) -> Problem {
    let written = context.short_text(angle.span);
    RULE.problem(angle.span, format!("an angle is at most {MAX_ANGLE} degrees (100 turns), not {written}"))
        .severity(Severity::Error)
        .help("write how far to turn, up to 360")
}

fn nothing(context: &Context<'_>, action: &Action, angle: &Number) -> Problem {
    RULE.problem(angle.span, "turning by 0 degrees does nothing")
        .fix("remove the turn", [context.remove(action.span)])
}

fn backwards(context: &Context<'_>, turn: &Turn, angle: &Number) -> Problem {
    let Some((direction, span)) = turn.direction else {
        return RULE.problem(angle.span, "a negative angle turns the other way");
    };
    let (this, other) = match direction {
        Direction::Left => ("left", "right"),
        Direction::Right => ("right", "left"),
    };
    let written = context.text(angle.span);
    let problem = RULE.problem(angle.span, format!("turning {this} by {written} degrees is turning {other}"));
    let sign = Span::new(angle.span.start, angle.span.start + 1);
    problem.fix(format!("turn {other} instead"), [context.replace(span, other), context.replace(sign, "")])
}

fn too_far(context: &Context<'_>, action: &Action, angle: &Number, value: f64) -> Problem {
    let rest = value % FULL_TURN;
    let problem = RULE.problem(angle.span, format!("{value} degrees are more than a full turn of 360"));
    if rest > 0.0 {
        problem
            .note(format!("the robot ends up facing as after {rest} degrees"))
            .suggestion(format!("reduce to {rest}"), [context.replace(angle.span, rest.to_string())])
    } else {
        problem
            .note("the robot ends up facing as it did before")
            .suggestion("remove the turn", [context.remove(action.span)])
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    fn program(action: &str) -> String {
        format!(
            "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has {{ a b }} wheels\nmovement m of r {{ move 1 meters {action} }}"
        )
    }

    #[test]
    fn angles_are_up_to_a_full_turn() {
        check(
            &program("turn left 0"),
            &expect![[r#"
                warning[invalid-angle] 4:43 "0" turning by 0 degrees does nothing
                  fix: remove the turn -> movement m of r { move 1 meters }
            "#]],
        );
        check(
            &program("turn left 450"),
            &expect![[r#"
                warning[invalid-angle] 4:43 "450" 450 degrees are more than a full turn of 360
                  note: the robot ends up facing as after 90 degrees
                  suggestion: reduce to 90 -> movement m of r { move 1 meters turn left 90 }
            "#]],
        );
        check(
            &program("turn left 720"),
            &expect![[r#"
                warning[invalid-angle] 4:43 "720" 720 degrees are more than a full turn of 360
                  note: the robot ends up facing as it did before
                  suggestion: remove the turn -> movement m of r { move 1 meters }
            "#]],
        );
        check(
            &program("turn right -45.5"),
            &expect![[r#"
                warning[invalid-angle] 4:44 "-45.5" turning right by -45.5 degrees is turning left
                  fix: turn left instead -> movement m of r { move 1 meters turn left 45.5 }
            "#]],
        );
        check_clean(&program("turn right 360 turn left 0.5"));
    }

    #[test]
    fn nobody_turns_for_hours() {
        check(
            &program(&format!("turn left 1{} turn right -36000.1", "0".repeat(300))),
            &expect![[r#"
            error[invalid-angle] 4:43 "1000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000" an angle is at most 36000 degrees (100 turns), not 10000000000000000000…
              help: write how far to turn, up to 360
            error[invalid-angle] 4:356 "-36000.1" an angle is at most 36000 degrees (100 turns), not -36000.1
              help: write how far to turn, up to 360
        "#]],
        );
    }
}
