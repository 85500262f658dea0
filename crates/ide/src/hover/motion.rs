//! Actions, movements and environments: where they lead and how long that takes.

use pydslrep_analysis::environment::{ActionKind, Environment, Movement};
use pydslrep_analysis::{Database, EntityId, plan, plan_movement, scene};
use pydslrep_kinematics::{Leg, Plan, RobotPath};
use pydslrep_syntax::EntityKind;

use super::drawing::{names, number, pose, time};
use super::parts::used_by;

/// An action of a movement that starts at the origin.
pub(super) fn action(database: &Database, id: EntityId, index: usize) -> Option<String> {
    let (robot, movement) = database.movement(id)?;
    let path = plan_movement(&robot, &movement).ok()?;
    let text = &movement.actions.get(index)?.text;
    let head = format!("```pydslrep\n{text}\n```\n");
    let Some(leg) = path.legs.get(index) else {
        return Some(head + &unknown(&movement, &path, index));
    };
    let rates: Vec<String> = robot
        .wheels
        .iter()
        .zip(&leg.rates)
        .map(|(wheel, rate)| format!("`{}` {} rad/s", wheel.name, number(*rate, 2)))
        .collect();
    Some(format!(
        "{head}Takes {}. From {} to {}, counted from where the movement starts.\n\nWheel rates: {}.",
        time(leg.duration),
        pose(&leg.from),
        pose(&leg.to),
        rates.join(", ")
    ))
}

fn unknown(movement: &Movement, path: &RobotPath, index: usize) -> String {
    let cause = path.unknown_after.map_or(index, |cause| cause.action);
    let why = match movement.actions.get(cause).map(|action| (&action.kind, &action.text)) {
        Some((ActionKind::Slam, _)) => "`slam` goes where the world lets it".to_owned(),
        Some((_, text)) => format!("`{text}` ends when the way is free"),
        None => "an action before it has an open end".to_owned(),
    };
    if cause == index {
        format!("Where it ends cannot be planned: {why}.")
    } else {
        format!("Where it starts cannot be planned: {why}.")
    }
}

pub(super) fn movement(database: &Database, id: EntityId) -> Option<String> {
    let (robot, movement) = database.movement(id)?;
    let path = plan_movement(&robot, &movement).ok()?;
    let mut length = 0.0;
    let mut turning = 0.0;
    for action in &movement.actions {
        match action.kind {
            ActionKind::Move { distance, .. } => length += distance.abs(),
            ActionKind::Turn { degrees } => turning += degrees.abs(),
            ActionKind::TurnUntil { .. } | ActionKind::Slam => {}
        }
    }
    let mut text = format!(
        "A movement of `{}`: drives {} m and turns {}°",
        robot.name,
        number(length, 3),
        number(turning, 1)
    );
    text += &match path.unknown_after {
        None => {
            let seconds = path.legs.iter().map(|leg| leg.duration).sum();
            format!(" in {}. It ends at {} from where it starts.", time(seconds), pose(&path.end()))
        }
        Some(cause) => {
            let action = movement.actions.get(cause.action).map_or("", |action| action.text.as_str());
            format!(". Its end cannot be planned, because of `{action}`.")
        }
    };
    Some(format!("{text}\n\n{}", used_by(database, id, EntityKind::Movement)))
}

pub(super) fn environment(database: &Database, id: EntityId) -> Option<String> {
    let environment = match database.environment(id) {
        Ok(environment) => environment,
        Err(blocked) => return Some(format!("It cannot run yet: {}.", blocked.reason())),
    };
    let plan = plan(&environment, &scene(&environment)).ok()?;
    let robots = names(environment.robots.iter().map(|robot| robot.name.as_str()));
    let total = plan.duration.map_or_else(|| "a time that cannot be planned".to_owned(), time);
    let mut text =
        format!("Runs {robots}; takes {total}.\n\n| from | to | robot | movement |\n|---|---|---|---|\n");
    for (group, runs) in environment.schedule.iter().enumerate() {
        for (run, movement) in runs.iter().enumerate() {
            text += &row(&environment, &plan, group, run, *movement)?;
        }
    }
    if environment.schedule.is_empty() {
        text = format!("Runs {robots}, but lists no movements: nothing drives.");
    }
    Some(text)
}

fn row(environment: &Environment, plan: &Plan, group: usize, run: usize, movement: usize) -> Option<String> {
    let movement = environment.movements.get(movement)?;
    let robot = environment.robots.get(movement.robot)?;
    let path = plan.robots.get(movement.robot)?;
    let mut legs = path.legs.iter().filter(|leg| (leg.index.group, leg.index.run) == (group, run));
    let start = legs.next().and_then(|leg| leg.start);
    let mut planned = path.legs.iter().filter(|leg| (leg.index.group, leg.index.run) == (group, run));
    let end = planned.next_back().and_then(Leg::end).filter(|_| ends(path, group, run));
    let cell = |seconds: Option<f64>| seconds.map_or_else(|| "?".to_owned(), time);
    Some(format!("| {} | {} | `{}` | `{}` |\n", cell(start), cell(end), robot.name, movement.name))
}

/// Whether a run ends at a planned time: nothing of it is unknown.
fn ends(path: &RobotPath, group: usize, run: usize) -> bool {
    path.unknown_after.is_none_or(|cause| (cause.group, cause.run) > (group, run))
}
