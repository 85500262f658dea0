//! Actions, movements and environments: their poses and durations.

use pydslrep_analysis::environment::{Action, ActionKind, Environment, Movement, Robot, nested};
use pydslrep_analysis::{Database, Driver, EntityId, plan, plan_movement, scene, summary_of_movement};
use pydslrep_kinematics::{ActionIndex, Leg, Place, Plan, Pose, RobotPath};
use pydslrep_syntax::EntityKind;

use super::format::{names, number, pose, time};
use super::parts::used_by;

/// The statement with a number, which is the action with an index or in its blocks, of a movement that starts at the
/// origin.
pub(super) fn action(database: &Database, id: EntityId, index: usize, number: usize) -> Option<String> {
    let (robot, movements) = database.movement_start(id, index + 1)?;
    let path = plan_movement(&robot, &movements).ok()?;
    let (movement, done) = movements.split_last()?;
    let outer = movement.actions.get(index)?;
    let action = nested(std::slice::from_ref(outer)).into_iter().find(|action| action.number == number)?;
    let details = if action.number == outer.number {
        describe_action(&robot, done, movement, &path, action)
    } else {
        describe_nested(&robot, done, movement, &path, action)
    };
    Some(format!("```pydslrep\n{}\n```\n{details}", action.text))
}

/// The details of an action, given the planned path of its movement.
fn describe_action(
    robot: &Robot,
    done: &[Movement],
    movement: &Movement,
    path: &RobotPath,
    action: &Action,
) -> String {
    let cause = path.unknown_after.map(|cause| top_level(cause, &path.unknown_place));
    let is_known = cause.is_none_or(|cause| !contains(movement, action, cause) && action.number <= cause);
    let Some(leg) = leg(robot, done, path, action, is_known) else {
        let is_cause = cause.is_none_or(|cause| contains(movement, action, cause));
        let end = if is_cause { "end" } else { "start" };
        return format!("The {end} pose cannot be planned: {}.", unknown_reason(movement, path, action));
    };
    let poses = if is_known {
        poses_of(&leg)
    } else {
        format!("The start pose cannot be planned: {}.", unknown_reason(movement, path, action))
    };
    describe_leg(robot, &leg, &poses)
}

/// The details of an action in a block, in the first round.
fn describe_nested(
    robot: &Robot,
    done: &[Movement],
    movement: &Movement,
    path: &RobotPath,
    action: &Action,
) -> String {
    let inside = nested(std::slice::from_ref(action));
    let begins = |leg: &&Leg| {
        let number = top_level(leg.index, &leg.place);
        inside.iter().any(|part| part.number == number)
    };
    let first = path.legs.iter().find(begins);
    let from = first.map_or_else(Pose::default, |leg| leg.from);
    let leg = Driver::new(robot).ok().and_then(|driver| driver.with_done(done).drive(from, &action.kind));
    let start = match path.unknown_after {
        Some(_) => format!("The start pose cannot be planned: {}.", unknown_reason(movement, path, action)),
        None => "The start pose depends on a condition.".to_owned(),
    };
    match (leg, first) {
        (None, _) => format!("The end pose cannot be planned: {}.", open_end(action)),
        (Some(leg), None) => describe_leg(robot, &leg, &start),
        (Some(leg), Some(first)) if first.place.rounds().is_empty() => {
            describe_leg(robot, &leg, &poses_of(&leg))
        }
        (Some(leg), Some(_)) => {
            describe_leg(robot, &leg, &format!("In the first round from {}", way_of(&leg)))
        }
    }
}

/// The number of the statement of the movement itself that leads to an action.
fn top_level(index: ActionIndex, place: &Place) -> usize {
    place.calls().first().map_or(index.action, |call| call.action) + 1
}

/// Whether a statement with this number is an action of a movement, or in its blocks.
fn contains(movement: &Movement, action: &Action, number: usize) -> bool {
    let after = movement.actions.iter().map(|other| other.number).find(|other| *other > action.number);
    action.number <= number && after.is_none_or(|after| number < after)
}

/// The details of a leg; `poses` describes its poses.
pub(crate) fn describe_leg(robot: &Robot, leg: &Leg, poses: &str) -> String {
    let rates: Vec<String> = robot
        .wheels
        .iter()
        .zip(&leg.rates)
        .map(|(wheel, rate)| format!("`{}` {} rad/s", wheel.name, number(*rate, 2)))
        .collect();
    let rates =
        if rates.is_empty() { String::new() } else { format!("\n\nWheel rates: {}.", rates.join(", ")) };
    format!("Takes {}. {poses}{rates}", time(leg.duration))
}

/// The poses at the start and end of a leg.
pub(crate) fn poses_of(leg: &Leg) -> String {
    format!("From {}", way_of(leg))
}

fn way_of(leg: &Leg) -> String {
    format!("{} to {}, relative to the start of the movement.", pose(&leg.from), pose(&leg.to))
}

/// The leg of an action, one with blocks as a whole. Beyond the end of the planned path the action is planned alone, since its
/// duration is still known. `None` if its end depends on the world.
fn leg(robot: &Robot, done: &[Movement], path: &RobotPath, action: &Action, is_known: bool) -> Option<Leg> {
    let mut legs = path.legs.iter().take_while(|leg| top_level(leg.index, &leg.place) < action.number);
    let before = legs.by_ref().last().map_or(path.start, |leg| leg.to);
    let from = if is_known { before } else { Pose::default() };
    Driver::new(robot).ok()?.with_done(done).drive(from, &action.kind)
}

/// Why the pose after an action is unknown.
fn unknown_reason(movement: &Movement, path: &RobotPath, action: &Action) -> String {
    let cause = path.unknown_after.map(|cause| top_level(cause, &path.unknown_place));
    let cause =
        cause.and_then(|cause| movement.actions.iter().find(|other| contains(movement, other, cause)));
    open_end(cause.unwrap_or(action))
}

fn open_end(action: &Action) -> String {
    open_end_reason(&action.kind, &action.text)
}

/// Why the end of an action depends on the world.
pub(crate) fn open_end_reason(kind: &ActionKind, text: &str) -> String {
    match kind {
        ActionKind::Slam => "the path of `slam` depends on what it explores".to_owned(),
        ActionKind::TurnUntil { .. } => format!("`{text}` ends when the way is clear"),
        ActionKind::If { .. } => format!("what `{text}` does depends on its sensors"),
        ActionKind::Repeat { .. } | ActionKind::Do { .. } => {
            format!("what `{text}` does depends on what sensors detect")
        }
        ActionKind::Move { .. }
        | ActionKind::Turn { .. }
        | ActionKind::Wait { .. }
        | ActionKind::RepeatUntil { .. } => format!("`{text}` ends when its condition holds"),
    }
}

pub(super) fn movement(database: &Database, id: EntityId) -> Option<String> {
    let (robot, movements) = database.movement(id)?;
    let path = plan_movement(&robot, &movements).ok()?;
    let summary = summary_of_movement(&robot, &movements).ok()?;
    let mut ways: Vec<Way> = Vec::with_capacity(movements.len());
    for movement in &movements {
        let way = Way::of(&movement.actions, &ways);
        ways.push(way);
    }
    let (movement, way) = (movements.last()?, ways.pop()?);
    let mut text = format!(
        "A movement of `{}`: drives {} m and turns {}°",
        robot.name,
        number(way.length, 3),
        number(way.turning, 1)
    );
    text += &if let Some(motion) = summary.motion {
        let end = pose(&path.end());
        format!(" in {}. It ends at {end} relative to its start.", time(motion.seconds))
    } else {
        let cause = path.unknown_after.map(|cause| top_level(cause, &path.unknown_place));
        let cause = cause.and_then(|cause| movement.statement(cause)).map_or("", |(text, _)| text);
        format!(". Its end cannot be planned because of `{cause}`.")
    };
    Some(format!("{text}\n\n{}", used_by(database, id, EntityKind::Movement)))
}

/// How far a movement drives and turns: metres and degrees, what only the world decides not counted.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    length: f64,
    turning: f64,
}

impl Way {
    /// That of some actions; `done` has those of the movements that they do.
    fn of(actions: &[Action], done: &[Self]) -> Self {
        actions.iter().fold(Self::default(), |sum, action| sum.and(Self::of_action(&action.kind, done), 1.0))
    }

    fn of_action(kind: &ActionKind, done: &[Self]) -> Self {
        match kind {
            ActionKind::Move { distance: Some(distance), until: None, .. } => {
                Self { length: distance.abs(), turning: 0.0 }
            }
            ActionKind::Turn { degrees: Some(degrees), circle, until: None, .. } => Self {
                length: circle.map_or(0.0, |circle| circle.radius * degrees.abs().to_radians()),
                turning: degrees.abs(),
            },
            ActionKind::Repeat { count, body } => {
                Self::default().and(Self::of(body, done), f64::from(*count))
            }
            ActionKind::Do { movement } => done.get(*movement).copied().unwrap_or_default(),
            _ => Self::default(),
        }
    }

    fn and(self, other: Self, times: f64) -> Self {
        Self { length: self.length + other.length * times, turning: self.turning + other.turning * times }
    }
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
        let why = open_end(movement.actions.iter().find(|action| contains(movement, action, cause))?);
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
