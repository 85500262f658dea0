//! From an environment to numbers: the scene its robots are in, and the paths they are to drive.

use pydslrep_kinematics as kinematics;
use pydslrep_scene as scenery;

use crate::environment::{ActionKind, Environment, Movement, Robot};

/// How far from its start a robot explores, metres, unless the user says otherwise.
const SLAM_EXTENT: f64 = 20.0;

/// The environment's robots on an empty floor.
pub fn scene(environment: &Environment) -> scenery::Scene {
    floor(&environment.robots)
}

pub(crate) fn floor(robots: &[Robot]) -> scenery::Scene {
    scenery::Scene::empty_floor(robots.iter().map(robot).collect())
}

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
    let run = |index: &usize| environment.movements.get(*index).map(self::run);
    let schedule: Vec<Vec<kinematics::Run>> =
        environment.schedule.iter().map(|group| group.iter().filter_map(run).collect()).collect();
    // Robots are listed by the environment itself, so no run can name another one.
    Ok(kinematics::plan(&robots, &schedule)
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

/// How far a robot drives at most, metres.
fn way(environment: &Environment, robot: usize) -> f64 {
    let movements =
        environment.schedule.iter().flatten().filter_map(|index| environment.movements.get(*index));
    let actions = movements.filter(|movement| movement.robot == robot).flat_map(|movement| &movement.actions);
    actions
        .map(|action| match action.kind {
            ActionKind::Move { distance, .. } => distance.abs(),
            ActionKind::Slam => SLAM_EXTENT,
            ActionKind::Turn { .. } | ActionKind::TurnUntil { .. } => 0.0,
        })
        .sum()
}

/// The path of one movement alone, from the origin at time 0, with a robot of default size.
///
/// # Errors
/// When the robot cannot drive, because a radius is not above zero.
pub fn plan_movement(
    driven: &Robot,
    movement: &Movement,
) -> Result<kinematics::RobotPath, kinematics::ModelError> {
    let model = robot(driven).model()?;
    Ok(kinematics::plan_movement(&model, kinematics::Pose::default(), &run(movement).actions))
}

/// A robot of default size, to be driven one action at a time.
#[derive(Debug)]
pub struct Driver(kinematics::Model);

impl Driver {
    /// One of a robot.
    ///
    /// # Errors
    /// When the robot cannot drive, because a radius is not above zero.
    pub fn new(driven: &Robot) -> Result<Self, kinematics::ModelError> {
        robot(driven).model().map(Self)
    }

    /// The drive of one action; `None` where only the world decides when it ends.
    pub fn drive(&self, from: kinematics::Pose, action: &ActionKind) -> Option<kinematics::Leg> {
        kinematics::plan_movement(&self.0, from, &[step(action)]).legs.pop()
    }
}

fn run(movement: &Movement) -> kinematics::Run {
    let actions = movement.actions.iter().map(|action| step(&action.kind)).collect();
    kinematics::Run { robot: movement.robot, actions }
}

fn step(kind: &ActionKind) -> kinematics::Action {
    match *kind {
        ActionKind::Move { distance, speed } => kinematics::Action::Move { distance, speed },
        ActionKind::Turn { degrees } => kinematics::Action::Turn { angle: degrees.to_radians() },
        ActionKind::TurnUntil { .. } | ActionKind::Slam => kinematics::Action::Unknown,
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
}
