//! From an environment to numbers: the scene its robots are in, and the paths they are to drive.

use pydslrep_kinematics as kinematics;
use pydslrep_scene as scenery;

use kinematics::{MotionPrimitive, StepKind};

use crate::environment::{
    COUNTS, Circle, Condition, Environment, Movement, ResolvedAction, ResolvedActionKind, Robot,
};

/// The distance that a robot drives until a condition holds, metres: a `move` fails after that, and loops hardly go
/// farther.
const OPEN_ENDED_EXTENT: f64 = 100.0;

/// The distance from its start that a robot explores, metres, unless the user says otherwise.
const SLAM_EXTENT: f64 = 20.0;

/// The environment's robots on an empty floor.
pub fn scene(environment: &Environment) -> scenery::Scene {
    floor(&environment.robots)
}

pub(crate) fn floor(robots: &[Robot]) -> scenery::Scene {
    scenery::Scene::empty_floor(robots.iter().map(robot).collect())
}

/// A model of a robot of default size.
pub(crate) fn default_model(drive: kinematics::Drive) -> Option<kinematics::Model> {
    let wheels = drive.row().wheels.iter().map(|place| scenery::Wheel::new(place.identifier, DEFAULT_RADIUS));
    scenery::Robot::new("", drive, wheels.collect(), Vec::new()).model().ok()
}

/// Metres. Times do not depend on it: speeds are those of rims.
const DEFAULT_RADIUS: f64 = 0.045;

fn robot(robot: &Robot) -> scenery::Robot {
    let wheels = robot.wheels.iter().map(|wheel| scenery::Wheel::new(&wheel.name, wheel.radius));
    let sensors = robot.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.kind));
    scenery::Robot::new(&robot.name, robot.drive, wheels.collect(), sensors.collect())
}

/// The paths that the environment's robots are to drive in a scene, and when. The group, run and action of a leg are
/// those of [`Environment::schedule`].
///
/// # Errors
/// When a robot of the scene cannot drive, because a length in it is not above zero.
pub fn plan(
    environment: &Environment,
    scene: &scenery::Scene,
) -> Result<kinematics::Plan, kinematics::ModelError> {
    let robots = scene
        .robots
        .iter()
        .map(|robot| Ok(kinematics::RobotPlan { model: robot.model()?, start: robot.start }));
    let robots: Vec<_> = robots.collect::<Result<_, _>>()?;
    let movements: Vec<kinematics::Movement> = environment.movements.iter().map(movement).collect();
    // Robots are listed by the environment itself, so no movement can name another one.
    Ok(kinematics::plan_schedule(&robots, &movements, &environment.schedule)
        .unwrap_or(kinematics::Plan { robots: Vec::new(), duration: None }))
}

/// The area that the environment's robots may get to in a scene: the least and the greatest x and y, metres.
///
/// Where a robot goes after an action that only the world ends, nobody knows: then it is all that its moves can reach.
///
/// # Errors
/// When a robot of the scene cannot drive, because a length in it is not above zero.
pub fn reach(
    environment: &Environment,
    scene: &scenery::Scene,
) -> Result<[kinematics::Pose; 2], kinematics::ModelError> {
    let paths = plan(environment, scene)?.robots;
    let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    for (robot, path) in paths.iter().enumerate() {
        let mut around = |pose: kinematics::Pose, radius: f64| {
            low = (low.0.min(pose.x - radius), low.1.min(pose.y - radius));
            high = (high.0.max(pose.x + radius), high.1.max(pose.y + radius));
        };
        around(path.start, 0.0);
        path.legs.iter().for_each(|leg| around(leg.to, 0.0));
        if path.unknown_after.is_some() {
            let known: f64 = path.legs.iter().map(|leg| leg.from.distance(&leg.to)).sum();
            around(path.end(), (way(environment, robot) - known).max(0.0));
        }
    }
    Ok([kinematics::Pose::new(low.0, low.1, 0.0), kinematics::Pose::new(high.0, high.1, 0.0)])
}

/// Returns the longest distance that a robot may drive, metres.
fn way(environment: &Environment, robot: usize) -> f64 {
    let mut ways: Vec<f64> = Vec::with_capacity(environment.movements.len());
    for movement in &environment.movements {
        // Movements that are done come first.
        let way = way_of_all(&movement.actions, &ways);
        ways.push(way);
    }
    let listed = environment.schedule.iter().flatten();
    let own = listed.filter(|index| environment.movements.get(**index).is_some_and(|run| run.robot == robot));
    own.filter_map(|index| ways.get(*index)).sum()
}

fn way_of_all(actions: &[ResolvedAction], done: &[f64]) -> f64 {
    actions.iter().map(|action| way_of(action, done)).sum()
}

fn way_of(action: &ResolvedAction, done: &[f64]) -> f64 {
    match &action.kind {
        ResolvedActionKind::Repeat { count, body } => f64::from(*count) * way_of_all(body, done),
        ResolvedActionKind::RepeatUntil { body, .. } => {
            OPEN_ENDED_EXTENT.min(way_of_all(body, done) * *COUNTS.end())
        }
        ResolvedActionKind::If { .. } => {
            action.kind.blocks().map(|body| way_of_all(body, done)).fold(0.0, f64::max)
        }
        ResolvedActionKind::Do { movement } => done.get(*movement).copied().unwrap_or_default(),
        kind => match step_kind(kind) {
            StepKind::Action(drive) | StepKind::Until { limit: drive } => drive.reach(),
            // They are those above.
            StepKind::Repeat { .. } | StepKind::Branch { .. } | StepKind::Call { .. } => 0.0,
        },
    }
}

/// The path of the last of some movements alone, from the origin at time 0, with a robot of default size. The others are those
/// that it does, each after those that it does itself.
///
/// # Errors
/// When the robot cannot drive, because a radius is not above zero.
pub fn plan_movement(
    driven: &Robot,
    movements: &[Movement],
) -> Result<kinematics::RobotPath, kinematics::ModelError> {
    let model = robot(driven).model()?;
    let mut done: Vec<Vec<kinematics::Step>> =
        movements.iter().map(|movement| steps(&movement.actions)).collect();
    let steps = done.pop().unwrap_or_default();
    Ok(kinematics::plan_steps(&model, kinematics::Pose::default(), &steps, &done))
}

/// Returns the summary of the last of some movements, with a robot of default size; the others are as for
/// [`plan_movement`].
///
/// # Errors
/// When the robot cannot drive, because a radius is not above zero.
pub fn summary_of_movement(
    driven: &Robot,
    movements: &[Movement],
) -> Result<kinematics::Summary, kinematics::ModelError> {
    Ok(summaries(&robot(driven).model()?, movements).pop().unwrap_or_default())
}

/// Returns the summaries of movements, each of which may do those before it.
fn summaries(model: &kinematics::Model, movements: &[Movement]) -> Vec<kinematics::Summary> {
    let mut summaries: Vec<kinematics::Summary> = Vec::with_capacity(movements.len());
    for movement in movements {
        let called = |index: usize| summaries.get(index).copied();
        let summary = kinematics::Summary::of(model, &steps(&movement.actions), &called);
        summaries.push(summary);
    }
    summaries
}

/// A robot of default size, to be driven one action at a time.
#[derive(Debug)]
pub struct Driver {
    model: kinematics::Model,
    /// The summaries of the movements that it may do.
    done: Vec<kinematics::Summary>,
}

impl Driver {
    /// One of a robot.
    ///
    /// # Errors
    /// When the robot cannot drive, because a radius is not above zero.
    pub fn new(driven: &Robot) -> Result<Self, kinematics::ModelError> {
        Ok(Self { model: robot(driven).model()?, done: Vec::new() })
    }

    /// The same, of a robot that may do some movements, each after those that it does itself.
    #[must_use]
    pub fn with_done(mut self, movements: &[Movement]) -> Self {
        self.done = summaries(&self.model, movements);
        self
    }

    /// Returns its drive model.
    pub fn model(&self) -> &kinematics::Model {
        &self.model
    }

    /// The drive of one action, one with blocks as a whole; `None` where only the world decides when it ends.
    pub fn drive(&self, from: kinematics::Pose, action: &ResolvedActionKind) -> Option<kinematics::Leg> {
        let step = kinematics::Step { number: 0, kind: step_kind(action) };
        let kind = match step.kind {
            StepKind::Repeat { .. } | StepKind::Call { .. } => StepKind::Branch { ways: vec![vec![step]] },
            kind => kind,
        };
        let step = kinematics::Step { number: 0, kind };
        let called = |index: usize| self.done.get(index).copied();
        kinematics::plan_step(&self.model, from, step, &called).legs.pop()
    }
}

fn movement(movement: &Movement) -> kinematics::Movement {
    kinematics::Movement { robot: movement.robot, steps: steps(&movement.actions) }
}

fn steps(actions: &[ResolvedAction]) -> Vec<kinematics::Step> {
    let step = |action: &ResolvedAction| kinematics::Step {
        number: action.number - 1,
        kind: step_kind(&action.kind),
    };
    actions.iter().map(step).collect()
}

/// What an action is to kinematics: whatever else is asked of its drive, such as how long it takes and how far it may get,
/// follows from that.
pub(crate) fn step_kind(kind: &ResolvedActionKind) -> StepKind {
    match kind {
        ResolvedActionKind::Move { distance, speed, until } => {
            let drive = |distance| MotionPrimitive::Move { distance, speed: *speed };
            ended(distance.map(drive), until.as_ref(), OPEN_ENDED_EXTENT)
        }
        ResolvedActionKind::Turn { left, degrees, circle, speed, until } => {
            let angle = degrees.map(|degrees| if *left { degrees } else { -degrees }.to_radians());
            let turn = |angle| match *circle {
                Some(Circle { radius, reverse }) => {
                    MotionPrimitive::Arc { angle, radius, speed: *speed, reverse }
                }
                None => MotionPrimitive::Turn { angle, speed: *speed },
            };
            ended(angle.map(turn), until.as_ref(), turn(std::f64::consts::TAU).reach())
        }
        ResolvedActionKind::TurnUntil { .. } => StepKind::Action(MotionPrimitive::Unknown { reach: 0.0 }),
        ResolvedActionKind::Wait { seconds, until } => {
            let wait = |seconds| MotionPrimitive::Wait { seconds };
            ended(seconds.map(wait), until.as_ref(), 0.0)
        }
        ResolvedActionKind::Repeat { count, body } => StepKind::Repeat { count: *count, body: steps(body) },
        ResolvedActionKind::RepeatUntil { .. } => {
            StepKind::Action(MotionPrimitive::Unknown { reach: OPEN_ENDED_EXTENT })
        }
        ResolvedActionKind::If { branches, otherwise } => {
            let branches = branches.iter().map(|branch| steps(&branch.body));
            StepKind::Branch { ways: branches.chain([steps(otherwise)]).collect() }
        }
        ResolvedActionKind::Do { movement } => StepKind::Call { movement: *movement },
        ResolvedActionKind::Slam => StepKind::Action(MotionPrimitive::Unknown { reach: SLAM_EXTENT }),
    }
}

/// An action that a condition may end. Without a bound nobody knows how far it leads: at most so many metres.
fn ended(action: Option<MotionPrimitive>, until: Option<&Condition>, reach: f64) -> StepKind {
    match (action, until) {
        (Some(action), None) => StepKind::Action(action),
        (Some(limit), Some(_)) => StepKind::Until { limit },
        (None, _) => StepKind::Action(MotionPrimitive::Unknown { reach }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Database;

    fn environment(program: &str) -> Environment {
        let mut database = Database::new();
        let file = database.open("reach.pyr", program);
        database.environment(database.environments(file)[0].0).unwrap()
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "of lengths in a room")]
    fn robots_reach_what_they_may_drive_to() {
        let reach = |actions: &str| {
            let program = format!(
                "wheel l with radius 4\nwheel r with radius 4\n\
                 sensor eye\nsensor b\nsensor c\nsensor d\nsensor e\n\
                 robot a type tw with port 23000 has {{ l r }} wheels with sensors {{ eye b c d e }}\n\
                 movement go of a {{ {actions} }}\nenvironment e has {{ a }} robots with {{ go }} moves\n"
            );
            let environment = environment(&program);
            let [low, high] = reach(&environment, &scene(&environment)).unwrap();
            // In millimetres.
            [low.x, low.y, high.x, high.y].map(|value| (value * 1e3).round() as i64)
        };
        assert_eq!(reach("move 12 meters turn left move 3 meters"), [0, 0, 12_000, 3_000]);
        assert_eq!(
            reach("move 2 meters turn left until { eye } move 3 meters move -1 meters"),
            [-2_000, -4_000, 6_000, 4_000]
        );
        assert_eq!(reach("slam"), [-20_000, -20_000, 20_000, 20_000]);
    }

    #[test]
    fn the_articles_square_ends_where_it_says() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/paper/table2_two_wheels.pyr");
        let mut database = Database::new();
        let file = database.open("square.pyr", &std::fs::read_to_string(path).unwrap());
        let environment = database.environment(database.environments(file)[0].0).unwrap();
        let plan = plan(&environment, &scene(&environment)).unwrap();
        let end = plan.robots[0].end();
        assert!(end.distance(&kinematics::Pose::new(0.0, -4.0, 0.0)) < 1e-9, "{end:?}");
        assert!((end.theta.abs() - std::f64::consts::PI).abs() < 1e-9, "{end:?}");
        assert!(plan.duration.is_some_and(|seconds| seconds > 3.0 * 4.0 / 0.09));
    }

    #[test]
    fn circles_are_to_the_side_that_the_program_says() {
        for (turn, (x, y, degrees)) in [
            ("turn left with radius 1 meters", (1.0, 1.0, 90.0_f64)),
            ("turn right with radius 100 centimeters at 5", (1.0, -1.0, -90.0)),
            ("turn left -90 with radius 1 meters", (1.0, -1.0, -90.0)),
            ("turn left with radius 1 meters in reverse", (-1.0, -1.0, 90.0)),
            ("turn right -90 with radius 1 meters in reverse", (-1.0, -1.0, 90.0)),
        ] {
            let environment = environment(&format!(
                "wheel l with radius 4\nwheel r with radius 4\nrobot a type tw with port 1 has {{ l r }} wheels\n\
                 movement go of a {{ {turn} }}\nenvironment e has {{ a }} robots with {{ go }} moves\n"
            ));
            let end = plan(&environment, &scene(&environment)).unwrap().robots[0].end();
            let there = kinematics::Pose::new(x, y, degrees.to_radians());
            assert!(end.distance(&there) < 1e-9 && (end.theta - there.theta).abs() < 1e-9, "{turn}: {end:?}");
        }
    }

    #[test]
    fn what_sensors_decide_is_unknown() {
        for (action, ways) in [
            ("move 1 meters until { eye } detect", 1),
            ("move until { eye } detect", 0),
            ("turn left 30 until { eye } detect", 1),
            ("turn left 30 with radius 1 meters until { eye } detect", 1),
            ("turn left with radius 1 meters until { eye } detect", 0),
            ("wait 1 seconds until { eye } detect", 1),
            ("wait until { eye } detect", 0),
            ("repeat until { eye } detect { wait 1 seconds }", 0),
            ("if { eye } clear { turn left 360 }", 1),
        ] {
            let environment = environment(&format!(
                "wheel l with radius 4\nwheel r with radius 4\nsensor eye\n\
                 robot a type tw with port 1 has {{ l r }} wheels with sensors {{ eye }}\n\
                 movement go of a {{ {action} move 1 meters }}\nenvironment e has {{ a }} robots with {{ go }} moves\n"
            ));
            let plan = plan(&environment, &scene(&environment)).unwrap();
            let path = &plan.robots[0];
            let lost = path.unknown_after.map(|index| index.action);
            assert_eq!((path.legs.len(), lost, path.possible.len()), (0, Some(0), ways), "{action}");
            assert_eq!(plan.duration, None, "{action}");
        }
    }
}
