//! Actions, movements and environments: their poses and durations.

use pydslrep_analysis::environment::{Action, ActionKind, Environment, Movement, Robot};
use pydslrep_analysis::{Database, EntityId, plan, plan_movement, scene};
use pydslrep_kinematics::{Leg, Plan, RobotPath};
use pydslrep_syntax::EntityKind;

use super::format::{names, number, pose, time};
use super::parts::used_by;

/// An action of a movement that starts at the origin.
pub(super) fn action(database: &Database, id: EntityId, index: usize) -> Option<String> {
    let (robot, movement) = database.movement_start(id, index + 1)?;
    let path = plan_movement(&robot, &movement).ok()?;
    let text = &movement.actions.get(index)?.text;
    Some(format!("```pydslrep\n{text}\n```\n{}", describe_action(&robot, &movement, &path, index)))
}

/// The details of an action, given the planned path of its movement.
fn describe_action(robot: &Robot, movement: &Movement, path: &RobotPath, index: usize) -> String {
    let Some(leg) = leg(robot, movement, path, index) else {
        let is_cause = path.unknown_after.is_none_or(|cause| cause.action == index);
        let end = if is_cause { "end" } else { "start" };
        return format!("The {end} pose cannot be planned: {}.", unknown_reason(movement, path, index));
    };
    let poses = if index < path.legs.len() {
        poses_of(&leg)
    } else {
        format!("The start pose cannot be planned: {}.", unknown_reason(movement, path, index))
    };
    describe_leg(robot, &leg, &poses)
}

/// The details of a leg; `poses` describes its poses.
pub(crate) fn describe_leg(robot: &Robot, leg: &Leg, poses: &str) -> String {
    let rates: Vec<String> = robot
        .wheels
        .iter()
        .zip(&leg.rates)
        .map(|(wheel, rate)| format!("`{}` {} rad/s", wheel.name, number(*rate, 2)))
        .collect();
    format!("Takes {}. {poses}\n\nWheel rates: {}.", time(leg.duration), rates.join(", "))
}

/// The poses at the start and end of a leg.
pub(crate) fn poses_of(leg: &Leg) -> String {
    format!("From {} to {}, relative to the start of the movement.", pose(&leg.from), pose(&leg.to))
}

/// The leg of an action. Beyond the end of the planned path the action is planned alone, since its duration is still
/// known. `None` if its end depends on the world.
fn leg(robot: &Robot, movement: &Movement, path: &RobotPath, index: usize) -> Option<Leg> {
    if let Some(leg) = path.legs.get(index) {
        return Some(leg.clone());
    }
    let actions = vec![movement.actions.get(index)?.clone()];
    let alone = Movement { actions, ..movement.clone() };
    plan_movement(robot, &alone).ok()?.legs.pop()
}

/// Why the pose after an action is unknown.
fn unknown_reason(movement: &Movement, path: &RobotPath, index: usize) -> String {
    let cause = path.unknown_after.map_or(index, |cause| cause.action);
    movement.actions.get(cause).map_or_else(|| "an earlier action has an unknown end".to_owned(), open_end)
}

fn open_end(action: &Action) -> String {
    open_end_reason(&action.kind, &action.text)
}

/// Why the end of an action depends on the world.
pub(crate) fn open_end_reason(kind: &ActionKind, text: &str) -> String {
    match kind {
        ActionKind::Slam => "the path of `slam` depends on what it explores".to_owned(),
        _ => format!("`{text}` ends when the way is clear"),
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
            _ => {}
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
            format!(" in {}. It ends at {} relative to its start.", time(seconds), pose(&path.end()))
        }
        Some(cause) => {
            let action = movement.actions.get(cause.action).map_or("", |action| action.text.as_str());
            format!(". Its end cannot be planned because of `{action}`.")
        }
    };
    Some(format!("{text}\n\n{}", used_by(database, id, EntityKind::Movement)))
}

pub(super) fn environment(database: &Database, id: EntityId) -> Option<String> {
    let environment = match database.environment(id) {
        Ok(environment) => environment,
        Err(blocked) => return Some(format!("Cannot run yet: {}.", blocked.reason())),
    };
    // Errors in the scene are reported in its own file.
    let scene = database.scene(id, &environment).unwrap_or_else(|_| scene(&environment));
    let plan = plan(&environment, &scene).ok()?;
    let robots = names(environment.robots.iter().map(|robot| robot.name.as_str()));
    let total = plan.duration.map_or_else(
        || "duration unknown until it runs".to_owned(),
        |seconds| format!("takes {}", time(seconds)),
    );
    let mut text =
        format!("Runs {robots}; {total}.\n\n| from | to | robot | movement |\n|---|---|---|---|\n");
    for (group, runs) in environment.schedule.iter().enumerate() {
        for (run, movement) in runs.iter().enumerate() {
            text += &row(&environment, &plan, group, run, *movement)?;
        }
    }
    if environment.schedule.is_empty() {
        text = format!("Runs {robots} but lists no movements.");
    }
    text += &unknown(&environment, &plan);
    Some(text)
}

/// Why and from where on poses and times are unknown, for each robot.
fn unknown(environment: &Environment, plan: &Plan) -> String {
    let line = |(robot, path): (&Robot, &RobotPath)| {
        let cause = path.unknown_after?;
        let movement = *environment.schedule.get(cause.group)?.get(cause.run)?;
        let movement = environment.movements.get(movement)?;
        let why = open_end(movement.actions.get(cause.action)?);
        let (robot, movement) = (&robot.name, &movement.name);
        Some(format!(
            "\nIn `{movement}`, {why}. Later poses of `{robot}` and start times of later movements are unknown.\n"
        ))
    };
    environment.robots.iter().zip(&plan.robots).filter_map(line).collect()
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

/// Whether the end time of a run is planned.
fn ends(path: &RobotPath, group: usize, run: usize) -> bool {
    path.unknown_after.is_none_or(|cause| (cause.group, cause.run) > (group, run))
}
