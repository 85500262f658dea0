//! The behaviour of a program's robots: by the plan as far as it is known, and by the unrolled statements where it is
//! not.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use pydslrep_analysis::environment::{Condition, Environment, ResolvedAction, ResolvedActionKind};
use pydslrep_analysis::{Database, FileId, plan, scene};

/// More statements are not compared.
const MAX_STATEMENTS: usize = 50_000;

/// The behaviour of the robots of an environment.
#[derive(Debug)]
pub(crate) struct Behaviour {
    /// The pose at the end of each leg, when it starts and how long it takes; robot by robot.
    legs: Vec<Vec<[f64; 5]>>,
    duration: Option<f64>,
    /// The statements of each movement that is listed, unrolled; `None` where they are too many.
    pub(crate) statements: Option<Vec<String>>,
}

/// Returns the behaviour of each environment without errors.
pub(crate) fn behaviours(database: &Database, file: FileId) -> BTreeMap<String, Behaviour> {
    let mut all = BTreeMap::new();
    for (id, name) in database.environments(file) {
        let Ok(environment) = database.environment(id) else { continue };
        let plan = plan(&environment, &scene(&environment)).unwrap();
        let legs = |robot: &pydslrep_kinematics::RobotPath| {
            let numbers = |leg: &pydslrep_kinematics::Leg| {
                [leg.to.x, leg.to.y, leg.to.theta, leg.start.unwrap_or(-1.0), leg.duration]
            };
            robot.legs.iter().map(numbers).collect()
        };
        let behaviour = Behaviour {
            legs: plan.robots.iter().map(legs).collect(),
            duration: plan.duration,
            statements: statements(&environment),
        };
        all.insert(name.text.to_string(), behaviour);
    }
    all
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs())
}

impl Behaviour {
    /// Returns whether all legs end at the same poses and, if asked for, at the same times.
    pub(crate) fn has_same_legs(&self, other: &Self, with_times: bool) -> bool {
        let count = if with_times { 5 } else { 3 };
        let near = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).take(count).all(|(a, b)| close(*a, *b));
        let same = |a: &Vec<[f64; 5]>, b: &Vec<[f64; 5]>| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b))
        };
        self.legs.len() == other.legs.len() && self.legs.iter().zip(&other.legs).all(|(a, b)| same(a, b))
    }

    pub(crate) fn has_same_duration(&self, other: &Self) -> bool {
        match (self.duration, other.duration) {
            (Some(before), Some(now)) => close(before, now),
            (before, now) => before.is_some() == now.is_some(),
        }
    }
}

fn statements(environment: &Environment) -> Option<Vec<String>> {
    let mut all = Vec::new();
    for index in environment.schedule.iter().flatten() {
        let movement = &environment.movements[*index];
        all.push(format!("of {}", movement.robot));
        unroll(environment, &movement.actions, &mut all)?;
    }
    Some(all)
}

/// Adds what is done; `None` if it is too much.
fn unroll(environment: &Environment, actions: &[ResolvedAction], all: &mut Vec<String>) -> Option<()> {
    for action in actions {
        if all.len() > MAX_STATEMENTS {
            return None;
        }
        match &action.kind {
            ResolvedActionKind::Repeat { count, body } => {
                (0..*count).try_for_each(|_| unroll(environment, body, all))?;
            }
            ResolvedActionKind::Do { movement } => {
                unroll(environment, &environment.movements[*movement].actions, all)?;
            }
            ResolvedActionKind::RepeatUntil { until, body } => {
                let body = block(environment, body)?;
                all.push(format!("repeat until {until:?} {{ {body} }}"));
            }
            ResolvedActionKind::If { branches, otherwise } => {
                let mut rest = block(environment, otherwise)?;
                for branch in branches.iter().rev() {
                    rest = choice(&branch.condition, &block(environment, &branch.body)?, &rest);
                }
                all.push(rest);
            }
            kind => all.push(format!("{kind:?}")),
        }
    }
    Some(())
}

fn block(environment: &Environment, actions: &[ResolvedAction]) -> Option<String> {
    let mut inner = Vec::new();
    unroll(environment, actions, &mut inner)?;
    Some(inner.join("; "))
}

/// Describes a choice, equally for a condition and its negation.
fn choice(condition: &Condition, then: &str, otherwise: &str) -> String {
    let (detected, clear) = if condition.detect { (then, otherwise) } else { (otherwise, then) };
    let mut text = String::new();
    let Condition { sensors, within, .. } = condition;
    write!(text, "if {sensors:?} within {within:?} {{ {detected} }} else {{ {clear} }}").unwrap();
    text
}
