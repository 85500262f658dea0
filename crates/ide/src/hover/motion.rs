//! Movements and environments: their poses and durations.

use pydslrep_analysis::environment::{Environment, Movement, Robot};
use pydslrep_analysis::{Database, EntityId, plan, plan_movement, scene, summary_of_movement};
use pydslrep_kinematics::{ActionIndex, Leg, Place, Plan, RobotPath};
use pydslrep_syntax::EntityKind;

use super::action::open_end;
use super::format::{names, pose, time};
use super::parts::used_by;
use super::way::Way;

/// The number of the statement of the movement itself that leads to an action.
fn top_level(index: ActionIndex, place: &Place) -> usize {
    place.calls().first().map_or(index.action, |call| call.action) + 1
}

pub(super) fn movement(database: &Database, id: EntityId) -> Option<String> {
    let (robot, movements) = database.movement(id)?;
    let facts = facts(&robot, &movements)?;
    Some(format!(
        "A movement of `{}`: {facts}\n\n{}",
        robot.name,
        used_by(database, id, EntityKind::Movement)
    ))
}

/// Describes the last of some movements: its length, duration and end pose. The others are those that it does.
pub(super) fn facts(robot: &Robot, movements: &[Movement]) -> Option<String> {
    let path = plan_movement(robot, movements).ok()?;
    let summary = summary_of_movement(robot, movements).ok()?;
    let (movement, way) = (movements.last()?, Way::of_movements(movements).pop()?);
    Some(if let Some(motion) = summary.motion {
        let end = pose(&path.end());
        format!("drives {way} in {}. It ends at {end} relative to its start.", time(motion.seconds))
    } else {
        let cause = path.unknown_after.map(|cause| top_level(cause, &path.unknown_place));
        let cause = cause.and_then(|cause| movement.statement(cause)).map_or("", |(text, _)| text);
        format!("drives {way}. Its end cannot be planned because of `{cause}`.")
    })
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
        let cause = top_level(cause, &path.unknown_place);
        let begun = movement.actions.partition_point(|action| action.number <= cause);
        let why = open_end(movement.actions.get(begun.checked_sub(1)?)?);
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

/// Returns whether the end time of a run is planned.
fn ends(path: &RobotPath, group: usize, run: usize) -> bool {
    path.unknown_after.is_none_or(|cause| (cause.group, cause.run) > (group, run))
}
