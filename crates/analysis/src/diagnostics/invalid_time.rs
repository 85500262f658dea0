//! `invalid-time`: a wait of no time or of more than a day, or a plan of more than 30 days.

use pydslrep_kinematics::{Drive, MAX_PLAN_DURATION};
use pydslrep_syntax::ast::{Action, ActionKind, Entity, Movement, Number, Repeat, Rounds, Wait};
use rustc_hash::FxHashMap;

use super::calls;
use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::summary::Time;
use crate::{EntityId, Severity};

pub(super) static RULE: Rule = Rule {
    code: "invalid-time",
    severity: Severity::Warning,
    summary: "a wait of 0 seconds; an error if negative, longer than a day, or if rounds take more than 30 days",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot waits for a negative time, for more than a day, or for 0 seconds, which is a warning. Or the \
        rounds of a `repeat` take more than 30 days, alone or with the rest of their movement: then the longest \
        `repeat` is marked. Where a condition decides, the shortest time counts.",
    why: "A wait of 0 seconds does nothing. Nobody wants a robot to wait for days: usually there are some \
        zeros too many. For a whole day, write 86400.",
    imports: &[],
    example: trip!("{ wait 0 seconds move 1 meters }"),
    fixed: trip!("{ move 1 meters }"),
};

/// Seconds.
const MAX_WAIT: f64 = 86_400.0;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    for action in context.actions() {
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
    (!(0.0..=MAX_WAIT).contains(&value)).then(|| {
        RULE.problem(
            seconds.span,
            format!("a wait is from 0 to {MAX_WAIT} seconds (a day) long, not {written}"),
        )
        .severity(Severity::Error)
        .help("write how many seconds to wait")
    })
}

/// The outermost loops that take longer than a plan may; if only all actions together do, the longest of the loops.
fn too_long(context: &Context<'_>, movement: &Movement) -> Vec<Problem> {
    // Times are expensive to compute: skip it where there are no loops.
    if !context.actions().any(|action| matches!(action.kind, ActionKind::Repeat(_))) {
        return Vec::new();
    }
    let mut loops = Vec::new();
    let rest = outermost_loops(&movement.actions, true, &mut loops);
    let robot = movement.robot.as_ref().and_then(|name| context.robot(name));
    let drive = robot.and_then(|(robot, _)| context.drive(robot));
    let (false, Some(drive)) = (loops.is_empty(), drive) else { return Vec::new() };
    let mut clock = Clock { context, drive, totals: FxHashMap::default() };
    let times: Vec<f64> = loops.iter().map(|found| clock.seconds(context.id, &found.time, 0)).collect();
    let timed = || loops.iter().zip(times.iter().copied());
    let alone: Vec<Problem> = timed()
        .filter(|(_, seconds)| *seconds > MAX_PLAN_DURATION)
        .map(|(found, _)| problem(found))
        .collect();
    let always = || timed().filter(|(found, _)| found.is_always_driven);
    let together = clock.seconds(context.id, &rest, 0) + always().map(|(_, seconds)| seconds).sum::<f64>();
    if !alone.is_empty() || together <= MAX_PLAN_DURATION {
        return alone;
    }
    let longest = always().max_by(|(_, one), (_, other)| one.total_cmp(other));
    longest.map(|(found, _)| problem(found)).into_iter().collect()
}

/// A `repeat N times` that is in no other.
struct Loop<'a> {
    count: &'a Number,
    time: Time,
    /// No condition decides about it.
    is_always_driven: bool,
}

/// Adds the loops; returns the time of the other actions. Computes each action's time once, because that takes a while.
fn outermost_loops<'a>(actions: &'a [Action], is_always_driven: bool, found: &mut Vec<Loop<'a>>) -> Time {
    let mut others = Time::default();
    for action in actions {
        if let ActionKind::Repeat(Repeat { rounds: Some(Rounds::Times(count)), .. }) = &action.kind {
            found.push(Loop { count, time: Time::of_action(action), is_always_driven });
            continue;
        }
        if is_always_driven {
            others.add(&Time::of_action(action), 1.0);
        }
        for block in action.blocks() {
            outermost_loops(&block.actions, false, found);
        }
    }
    others
}

fn problem(found: &Loop<'_>) -> Problem {
    let days = MAX_PLAN_DURATION / 86_400.0;
    let problem = RULE.problem(found.count.span, format!("these rounds take more than {days} days"));
    problem.severity(Severity::Error).help("repeat the block less often")
}

/// Adds up how long movements take at least that do others.
struct Clock<'c, 'a> {
    context: &'c Context<'a>,
    drive: Drive,
    totals: FxHashMap<EntityId, f64>,
}

impl Clock<'_, '_> {
    /// Returns `time` in seconds, with that of the movements it includes, whose names are those of the movement `id`.
    fn seconds(&mut self, id: EntityId, time: &Time, depth: usize) -> f64 {
        let mut seconds = time.seconds[self.drive as usize];
        for (name, count) in &time.calls {
            if let Some(called) = self.context.movement_of(id, name) {
                seconds += self.total(called, depth + 1) * count;
            }
        }
        seconds
    }

    fn total(&mut self, id: EntityId, depth: usize) -> f64 {
        if let Some(total) = self.totals.get(&id) {
            return *total;
        }
        // Circles, and chains that are too long, are reported by another rule.
        self.totals.insert(id, 0.0);
        let summary = self.context.summary(id).filter(|_| depth < calls::MAX_CALL_DEPTH);
        let total = summary.map_or(0.0, |summary| self.seconds(id, &summary.time, depth));
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

    #[test]
    fn a_plan_counts_as_a_whole() {
        let told = |actions: &str| {
            let text = program(actions);
            let mut database = crate::Database::new();
            let file = database.open("a.pyr", &text);
            let all = database.diagnostics(file).into_iter();
            let own = all.filter(|found| found.code() == super::RULE.code);
            own.map(|found| found.span.text(&text).to_owned()).collect::<Vec<_>>()
        };
        let day = "wait 86400 seconds";
        let none: [&str; 0] = [];
        assert_eq!(told(&format!("repeat 30 times {{ {day} }}")), none, "exactly thirty days");
        assert_eq!(told(&format!("repeat 30 times {{ {day} }} wait 1 seconds")), ["30"]);
        assert_eq!(
            told(&format!("repeat 20 times {{ {day} }} repeat 11 times {{ {day} }}")),
            ["20"],
            "the longest"
        );
        // It takes so long at least, whatever the sensors say.
        assert_eq!(told(&format!("repeat 40 times {{ wait until {{ s }} clear {day} }}")), ["40"]);
        assert_eq!(told(&format!("wait until {{ s }} clear repeat 31 times {{ {day} }}")), ["31"]);
        let ways = |other: &str| {
            told(&format!("repeat 31 times {{ if {{ s }} clear {{ {day} }} else {{ {other} }} }}"))
        };
        assert_eq!((ways(day).len(), ways("turn left").len()), (1, 0), "the shortest way counts");
    }
}
