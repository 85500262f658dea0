//! `invalid-time` of loops: a plan of more than 30 days, at the outermost `repeat`.
//!
//! How long a robot drives depends on its measures and ramps, which are not the language's. So every time is known between two
//! bounds only, and what they leave open is doubtful.

use super::robot::has_right_count;
use crate::Finding;
use crate::program::{Action, ActionKind, Body, Else, Movement, Number, Rounds, Turn};
use crate::project::{Declared, Scope};

/// Seconds.
const MAX_PLAN_DURATION: f64 = 30.0 * 86_400.0;

/// The loops whose time is certainly too long: the first such loop of a movement, if it and what precedes it depend on no
/// condition.
pub(super) fn certain(scope: Scope<'_>) -> Vec<Finding> {
    let mut clock = Clock::default();
    let mut findings = Vec::new();
    for entity in &scope.program().entities {
        let Body::Movement(movement) = &entity.body else { continue };
        if !has_sound_robot(scope, movement) {
            continue;
        }
        let times = movement.actions.iter().map(|action| (action, clock.time(scope, action)));
        let mut known = times.collect::<Vec<_>>().into_iter().take_while(|(_, time)| time.is_known);
        let too_long = known.find(|(_, time)| time.max > MAX_PLAN_DURATION);
        if let Some((action, time)) = too_long
            && time.min > MAX_PLAN_DURATION
            && !clock.does_long_one(scope, action)
            && let Some(count) = count(action)
        {
            findings.push(Finding::new("invalid-time", &count.range));
        }
    }
    findings
}

/// All other loops of a program in which anything may take too long.
pub(crate) fn doubtful(scope: Scope<'_>) -> Vec<Finding> {
    let mut clock = Clock::default();
    let program = scope.program();
    let mut plans = Vec::new();
    for (_, environment) in program.environments() {
        let listed = environment.movements.iter().filter_map(|name| scope.movement(&name.text));
        plans.push(listed.map(|movement| clock.time_of_movement(&movement).max).sum());
    }
    let mut counts = Vec::new();
    for entity in &program.entities {
        let Body::Movement(movement) = &entity.body else { continue };
        plans.push(clock.time_of_all(scope, &movement.actions).max);
        counts.extend(outermost_counts(&movement.actions));
    }
    if plans.into_iter().all(|max: f64| max <= MAX_PLAN_DURATION) {
        return Vec::new();
    }
    let certain = certain(scope);
    let findings = counts.into_iter().map(|count| Finding::new("invalid-time", &count.range));
    findings.filter(|finding| !certain.contains(finding)).collect()
}

/// The counts of loops that are in no loop with a count.
fn outermost_counts(actions: &[Action]) -> Vec<&Number> {
    let counts = |action| match count(action) {
        Some(count) => vec![count],
        None => std::iter::successors(Some(action), |action| action.else_if())
            .flat_map(Action::blocks)
            .flat_map(|block| outermost_counts(&block.actions))
            .collect(),
    };
    actions.iter().flat_map(counts).collect()
}

fn count(action: &Action) -> Option<&Number> {
    match &action.kind {
        ActionKind::Repeat { rounds: Rounds::Times(count), .. } => Some(count),
        _ => None,
    }
}

/// Whether nothing is wrong with a movement's robot, so that there is a plan.
fn has_sound_robot(scope: Scope<'_>, movement: &Movement) -> bool {
    scope.robot(&movement.robot.text).is_some_and(|robot| {
        let wheels = || robot.wheels.iter().map(|name| robot.home.wheel(&name.text));
        has_right_count(&robot) && wheels().all(|wheel| wheel.is_some_and(|wheel| wheel.radius.value() > 0.0))
    })
}

/// Seconds.
#[derive(Debug, Clone, Copy)]
struct Time {
    min: f64,
    max: f64,
    /// Whether it depends on no condition and no mistake.
    is_known: bool,
}

impl Time {
    const NONE: Self = Self { min: 0.0, max: 0.0, is_known: true };
    /// Where there is no plan, for another reason: nothing is concluded.
    const NO_PLAN: Self = Self { min: 0.0, max: 0.0, is_known: false };

    fn known(min: f64, max: f64) -> Self {
        if max.is_finite() { Self { min, max, is_known: true } } else { Self::NO_PLAN }
    }

    fn unknown(self) -> Self {
        Self { is_known: false, ..self }
    }

    fn then(self, next: Self) -> Self {
        Self { min: self.min + next.min, max: self.max + next.max, is_known: self.is_known && next.is_known }
    }

    fn times(self, count: f64) -> Self {
        if count == 0.0 {
            return Self::NO_PLAN;
        }
        Self { min: self.min * count, max: self.max * count, is_known: self.is_known }
    }
}

/// The times of movements that are already worked out, so that each is worked out once.
#[derive(Default)]
struct Clock {
    times: Vec<(*const Movement, Time)>,
    running: Vec<*const Movement>,
}

impl Clock {
    fn time_of_movement(&mut self, movement: &Declared<'_, Movement>) -> Time {
        let key: *const Movement = &raw const **movement;
        if let Some((_, time)) = self.times.iter().find(|(other, _)| *other == key) {
            return *time;
        }
        if self.running.contains(&key) {
            return Time::NO_PLAN;
        }
        self.running.push(key);
        let time = self.time_of_all(movement.home, &movement.actions);
        self.running.pop();
        self.times.push((key, time));
        time
    }

    fn time_of_all(&mut self, scope: Scope<'_>, actions: &[Action]) -> Time {
        actions.iter().fold(Time::NONE, |sum, action| sum.then(self.time(scope, action)))
    }

    fn time(&mut self, scope: Scope<'_>, action: &Action) -> Time {
        let time = match &action.kind {
            ActionKind::Move { distance, speed, .. } => {
                let metres = distance.as_ref().map_or(100.0, |distance| distance.value().abs());
                driving(metres, metres, speed.as_ref())
            }
            ActionKind::Turn(turn) => turning(turn),
            ActionKind::Wait { seconds, .. } => {
                let seconds = seconds.as_ref().map_or(600.0, Number::value);
                if seconds >= 0.0 { Time::known(seconds, seconds) } else { Time::NO_PLAN }
            }
            ActionKind::Repeat { rounds, body } => {
                let count = match rounds {
                    Rounds::Times(count) => count.value(),
                    // Nobody knows; a plan shows one at most.
                    Rounds::Until(_) => 1.0,
                };
                let round = self.time_of_all(scope, &body.actions);
                // A round takes one step at least, when it is driven.
                let time = Time { max: round.max + 1.0, ..round }.times(count.max(0.0));
                if count.fract() == 0.0 { time } else { time.unknown() }
            }
            ActionKind::If { then, otherwise, .. } => {
                let one = self.time_of_all(scope, &then.actions);
                let other = match otherwise {
                    Some(Else::Block(block)) => self.time_of_all(scope, &block.actions),
                    Some(Else::If(action)) => self.time(scope, action),
                    None => Time::NONE,
                };
                Time { min: one.min.min(other.min), max: one.max.max(other.max), is_known: false }
            }
            ActionKind::Do { movement } => match scope.movement(&movement.text) {
                Some(movement) => self.time_of_movement(&movement),
                None => Time::NO_PLAN,
            },
            ActionKind::Slam => Time::NO_PLAN,
        };
        if action.condition().is_some() { Time { min: 0.0, ..time }.unknown() } else { time }
    }

    /// Whether a statement does a movement that may be too long by itself: then that one has the error.
    fn does_long_one(&mut self, scope: Scope<'_>, action: &Action) -> bool {
        let done = crate::program::flattened(std::slice::from_ref(action));
        let done = done.into_iter().filter_map(Action::done).filter_map(|name| scope.movement(&name.text));
        done.collect::<Vec<_>>()
            .into_iter()
            .any(|movement| self.time_of_movement(&movement).max > MAX_PLAN_DURATION)
    }
}

/// A way of these metres. The ramps of 0.5 m/s² take the second term, generously.
fn driving(min: f64, max: f64, speed: Option<&Number>) -> Time {
    let metres_per_second = speed.map_or(0.09, |speed| speed.value() / 100.0);
    if metres_per_second > 0.0 {
        Time::known(min / metres_per_second, max / metres_per_second + 10.0 + 4.0 * metres_per_second)
    } else {
        Time::NO_PLAN
    }
}

/// Robots are at most 10 m wide, and at least of no width.
fn turning(turn: &Turn) -> Time {
    let degrees = turn.angle.as_ref().map_or(if turn.until.is_some() { 360.0 } else { 90.0 }, Number::value);
    let radius = turn.circle.as_ref().map_or(0.0, |circle| circle.value.value().abs());
    let radians = degrees.abs().to_radians();
    driving(radians * radius, radians * (radius + 10.0), turn.speed.as_ref().map(|speed| &speed.value))
}
