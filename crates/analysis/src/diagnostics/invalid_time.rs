//! `invalid-time`: a wait of no time or of more than a day, or rounds that take more than 30 days.

use pydslrep_kinematics::{Drive, LONGEST_PLAN};
use pydslrep_syntax::ast::{Action, ActionKind, Entity, Movement, Number, Repeat, Rounds, Wait};
use rustc_hash::FxHashMap;

use super::context::Context;
use super::problem::Problem;
use super::{Applicability, Page, Rule};
use crate::summary::Time;
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "invalid-time",
    severity: Severity::Warning,
    summary: "a wait of 0 seconds; an error if negative, longer than a day, or if a `repeat` takes more than 30 days",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A robot waits for a negative time, for more than a day, or for 0 seconds, which is a warning. Or the \
        rounds of a `repeat` take more than 30 days.",
    why: "A wait of 0 seconds does nothing. Nobody wants a robot to wait for days: usually there are some \
        zeros too many. For a whole day, write 86400.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { wait 0 seconds move 1 meters }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover } robots with { trip } moves",
};

/// Seconds.
const LONGEST_WAIT: f64 = 86_400.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    for action in movement.all_actions() {
        if let ActionKind::Wait(Wait { seconds: Some(seconds), .. }) = &action.kind {
            problems.extend(wait(context, action, seconds));
        }
    }
    problems.extend(too_long(context, movement));
}

fn wait(context: &Context<'_>, action: &Action, seconds: &Number) -> Option<Problem> {
    let value = seconds.value.filter(|value| value.is_finite())?;
    let written = context.short_text(seconds.span);
    if value == 0.0 {
        let problem = RULE.problem(seconds.span, "waiting for 0 seconds does nothing");
        return Some(problem.fix("remove the wait", [context.remove(action.span)]));
    }
    (!(0.0..=LONGEST_WAIT).contains(&value)).then(|| {
        RULE.problem(
            seconds.span,
            format!("a wait is from 0 to {LONGEST_WAIT} seconds (a day) long, not {written}"),
        )
        .severity(Severity::Error)
        .help("write how many seconds to wait")
    })
}

/// The first loop whose rounds take longer than a plan may, if everything up to its end is known.
fn too_long(context: &Context<'_>, movement: &Movement) -> Option<Problem> {
    let is_loop = |action: &Action| matches!(action.kind, ActionKind::Repeat(_));
    if !movement.actions.iter().any(is_loop) {
        return None;
    }
    let (robot, _) = context.robot(movement.robot.as_ref()?)?;
    let drive = context.drive(robot)?;
    let mut clock = Clock { context, drive, totals: FxHashMap::default() };
    for action in &movement.actions {
        // A number that is out of range is reported where it is.
        let seconds = clock.seconds(context.id, &Time::of_action(action)?, 0).filter(|it| it.is_finite())?;
        let ActionKind::Repeat(Repeat { rounds: Some(Rounds::Times(count)), .. }) = &action.kind else {
            continue;
        };
        if seconds > LONGEST_PLAN {
            let days = LONGEST_PLAN / 86_400.0;
            let problem = RULE.problem(count.span, format!("these rounds take more than {days} days"));
            return Some(problem.severity(Severity::Error).help("repeat the block less often"));
        }
    }
    None
}

/// Adds up how long movements take that do others.
struct Clock<'c, 'a> {
    context: &'c Context<'a>,
    drive: Drive,
    totals: FxHashMap<EntityId, Option<f64>>,
}

impl Clock<'_, '_> {
    /// What is done is done by the movement with this id.
    fn seconds(&mut self, id: EntityId, time: &Time, depth: usize) -> Option<f64> {
        let mut seconds = time.seconds[self.drive as usize];
        for (name, count) in &time.calls {
            let called = self.context.movement_of(id, name)?;
            seconds += self.total(called, depth + 1)? * count;
        }
        Some(seconds)
    }

    fn total(&mut self, id: EntityId, depth: usize) -> Option<f64> {
        /// Movements do each other far less often in a row; it also ends what goes round in circles.
        const DEEPEST: usize = 200;
        if let Some(total) = self.totals.get(&id) {
            return *total;
        }
        let time = self.context.summary(id)?.time.filter(|_| depth < DEEPEST);
        let total = time.and_then(|time| self.seconds(id, &time, depth));
        self.totals.insert(id, total);
        total
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn nobody_waits_for_days() {
        check(
            &program("turn left wait 0 seconds"),
            &expect![[r#"
            warning[invalid-time] 6:34 "0" waiting for 0 seconds does nothing
              fix: remove the wait -> movement m of r { turn left }
        "#]],
        );
        check(
            &program("wait -1 seconds wait 86401 seconds"),
            &expect![[r#"
            error[invalid-time] 6:24 "-1" a wait is from 0 to 86400 seconds (a day) long, not -1
              help: write how many seconds to wait
            error[invalid-time] 6:40 "86401" a wait is from 0 to 86400 seconds (a day) long, not 86401
              help: write how many seconds to wait
        "#]],
        );
        check_clean(&program("wait 86400 seconds wait 0.001 seconds"));
    }

    #[test]
    fn plans_end_within_a_month() {
        check(
            &program("turn left repeat 10000 times { repeat 1000 times { wait 1 seconds } }"),
            &expect![[r#"
                error[invalid-time] 6:36 "10000" these rounds take more than 30 days
                  help: repeat the block less often
            "#]],
        );
        check(
            &format!("{}\nmovement n of r {{ wait 86400 seconds }}", program("repeat 31 times { do n }")),
            &expect![[r#"
                error[invalid-time] 6:26 "31" these rounds take more than 30 days
                  help: repeat the block less often
            "#]],
        );
        check_clean(&format!(
            "{}\nmovement n of r {{ wait 86400 seconds }}",
            program("repeat 29 times { do n }")
        ));
        check_clean(&program("repeat 10000 times { wait 80000 seconds until { s } clear }"));
    }
}
