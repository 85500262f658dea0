//! Planned paths: the timed poses of each robot of an environment, for a preview next to the program.

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{Blocked, Database, EntityId, plan};
use pydslrep_kinematics::{ActionIndex, Leg, Plan, Pose, RobotPath};
use pydslrep_scene::{self as scenery, Body, Collision, ENDING, Obstacle, Scene, Sensor, Thing};
use pydslrep_schema::Problem;

/// The planned path of an environment in its scene.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPath {
    /// Its name.
    pub environment: String,
    /// Seconds until the last movement ends; `None` if it cannot be planned.
    pub duration: Option<f64>,
    /// In listed order.
    pub robots: Vec<PlannedRobot>,
    /// The obstacles of the scene.
    pub obstacles: Vec<Obstacle>,
    /// The planned collisions, earliest first.
    pub collisions: Vec<PlannedCollision>,
}

/// The planned path of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRobot {
    /// Its name.
    pub name: String,
    /// Its outer size.
    pub body: Body,
    /// Its sensors with their mounts.
    pub sensors: Vec<Sensor>,
    /// Its poses, beginning with the start pose.
    pub poses: Vec<PlannedPose>,
    /// The legs of its path. Poses alone do not separate them, since a movement may be listed twice.
    pub legs: Vec<PlannedLeg>,
    /// The action after which its poses cannot be planned.
    pub unknown_after: Option<PlannedAction>,
}

/// The path of one action.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLeg {
    /// The action.
    pub action: PlannedAction,
    /// Seconds from the start; `None` after an action of unknown duration.
    pub start: Option<f64>,
    /// Seconds.
    pub duration: f64,
    /// The index of its last pose among those of its robot; it starts at the last pose of the previous leg.
    pub last: usize,
}

/// A planned collision of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedCollision {
    /// Its name.
    pub robot: String,
    /// The current action.
    pub action: Option<PlannedAction>,
    /// Seconds from the start; `None` after an action of unknown duration.
    pub time: Option<f64>,
    /// The robot's pose.
    pub pose: Pose,
    /// The obstacle or robot it collides with.
    pub with: Met,
}

/// The other party of a collision, by name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Met {
    /// An obstacle.
    Obstacle(String),
    /// Another robot.
    Robot(String),
}

/// A pose on a planned path.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPose {
    /// Seconds from the start; `None` after an action of unknown duration.
    pub time: Option<f64>,
    /// In the world; metres and radians.
    pub pose: Pose,
    /// The action that leads to it; `None` for the start pose.
    pub action: Option<PlannedAction>,
}

/// An action of a planned path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedAction {
    /// The movement's name.
    pub movement: String,
    /// The zero-based index among the movement's actions.
    pub index: usize,
    /// The action's text.
    pub text: String,
}

/// Poses per action, at equal time intervals: enough for curves and speed ramps.
const POSES_PER_ACTION: u32 = 8;

/// The planned path of an environment.
///
/// # Errors
/// When the environment or its scene has errors, or a robot in it cannot drive.
pub fn planned_path(database: &Database, environment: EntityId) -> Result<PlannedPath, String> {
    let id = environment;
    let environment = database.environment(id).map_err(|blocked: Blocked| blocked.reason())?;
    let scene = database.scene(id, &environment).map_err(|problems| wrong_scene(&environment, &problems))?;
    let plan = plan(&environment, &scene).map_err(|error| error.to_string())?;
    let collisions = collisions(&environment, &scene, &plan);
    let robots = scene.robots.into_iter().zip(&plan.robots).map(|(robot, path)| PlannedRobot {
        name: robot.name,
        body: robot.body,
        sensors: robot.sensors,
        poses: poses(&environment, path),
        legs: legs(&environment, path),
        unknown_after: path.unknown_after.and_then(|index| action(&environment, index)),
    });
    let robots = robots.collect();
    let (duration, obstacles) = (plan.duration, scene.obstacles);
    Ok(PlannedPath { environment: environment.name, duration, robots, obstacles, collisions })
}

fn collisions(environment: &Environment, scene: &Scene, plan: &Plan) -> Vec<PlannedCollision> {
    let met = |thing| match thing {
        Thing::Obstacle(index) => scene.obstacles.get(index).map(|thing| Met::Obstacle(thing.name.clone())),
        Thing::Robot(index) => scene.robots.get(index).map(|robot| Met::Robot(robot.name.clone())),
    };
    let named = |collision: Collision| {
        let robot = scene.robots.get(collision.robot)?.name.clone();
        let (action, with) = (action(environment, collision.action), met(collision.with)?);
        Some(PlannedCollision { robot, action, time: collision.time, pose: collision.pose, with })
    };
    let mut collisions: Vec<_> = scenery::collisions(scene, plan).into_iter().filter_map(named).collect();
    let moment = |collision: &PlannedCollision| collision.time.unwrap_or(f64::INFINITY);
    collisions.sort_by(|a, b| moment(a).total_cmp(&moment(b)));
    collisions
}

/// The error message for a scene with errors.
fn wrong_scene(environment: &Environment, problems: &[Problem]) -> String {
    let first = problems.first().map_or("it has errors", |problem| problem.message.as_str());
    format!("`{}{ENDING}`: {first}", environment.name)
}

fn poses(environment: &Environment, path: &RobotPath) -> Vec<PlannedPose> {
    let start = PlannedPose { time: Some(0.0), pose: path.start, action: None };
    std::iter::once(start).chain(path.legs.iter().flat_map(|leg| on_leg(environment, leg))).collect()
}

fn on_leg(environment: &Environment, leg: &Leg) -> Vec<PlannedPose> {
    let action = action(environment, leg.index);
    let at = |number: u32| {
        let seconds = leg.duration * f64::from(number) / f64::from(POSES_PER_ACTION);
        PlannedPose {
            time: leg.start.map(|start| start + seconds),
            pose: leg.pose_at(seconds),
            action: action.clone(),
        }
    };
    (1..=POSES_PER_ACTION).map(at).collect()
}

fn legs(environment: &Environment, path: &RobotPath) -> Vec<PlannedLeg> {
    let ends = (1..).map(|number| number * POSES_PER_ACTION as usize);
    let planned = |(leg, last): (&Leg, usize)| {
        let action = action(environment, leg.index)?;
        Some(PlannedLeg { action, start: leg.start, duration: leg.duration, last })
    };
    path.legs.iter().zip(ends).filter_map(planned).collect()
}

fn action(environment: &Environment, at: ActionIndex) -> Option<PlannedAction> {
    let movement = environment.movements.get(*environment.schedule.get(at.group)?.get(at.run)?)?;
    let text = movement.actions.get(at.action)?.text.clone();
    Some(PlannedAction { movement: movement.name.clone(), index: at.action, text })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::PARTS;

    fn path(rest: &str) -> Result<PlannedPath, String> {
        let mut database = Database::new();
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let environment = database.environments(file)[0].0;
        planned_path(&database, environment)
    }

    #[test]
    fn poses_lead_from_the_start_through_every_action() {
        let path = path(
            "movement m of rover { move 1 meters turn left slam move 1 meters }\nenvironment e has { rover } robots with { m } moves",
        );
        // `slam` needs sensors that this robot does not have.
        assert!(path.unwrap_err().contains("sensors"));
        let path = self::path(
            "movement m of rover { move 1 meters turn left turn left until { front } move 1 meters }\nenvironment e has { rover } robots with { m } moves",
        )
        .unwrap();
        assert_eq!((path.environment.as_str(), path.duration), ("e", None));
        let rover = &path.robots[0];
        assert_eq!(rover.poses.len(), 1 + 2 * 8);
        assert_eq!(rover.poses[0], PlannedPose { time: Some(0.0), pose: Pose::default(), action: None });
        let last = rover.poses.last().unwrap();
        assert!(last.pose.distance(&Pose::new(1.0, 0.0, 0.0)) < 1e-9);
        assert_eq!(last.action.as_ref().unwrap().text, "turn left");
        assert!(rover.poses.windows(2).all(|pair| pair[0].time < pair[1].time));
        assert_eq!(rover.unknown_after.as_ref().unwrap().index, 2);
        let legs: Vec<_> = rover.legs.iter().map(|leg| (leg.action.index, leg.last)).collect();
        assert_eq!(legs, [(0, 8), (1, 16)]);
        let turn = &rover.legs[1];
        assert_eq!(rover.poses[turn.last].time, turn.start.map(|start| start + turn.duration));
    }

    #[test]
    fn collisions_say_when_and_with_what() {
        let mut database = Database::new();
        let rest = "movement m of rover { turn left move 3 meters }
            environment e has { rover } robots with { m } moves";
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let id = database.environments(file)[0].0;
        database.set_scene(file, "e", Some("[[cylinder]]\nname = \"pole\"\nat = [0, 1]\nradius = 0.1"));
        let path = planned_path(&database, id).unwrap();
        assert_eq!(path.obstacles[0].name, "pole");
        let [collision] = &path.collisions[..] else { panic!("{:?}", path.collisions) };
        assert_eq!((collision.robot.as_str(), &collision.with), ("rover", &Met::Obstacle("pole".to_owned())));
        assert_eq!(collision.action.as_ref().unwrap().text, "move 3 meters");
        let front = collision.pose.y + path.robots[0].body.length / 2.0;
        assert!((front - 0.9).abs() < 0.002, "{collision:?}");
        let leg = &path.robots[0].legs[1];
        assert!(collision.time > leg.start && collision.time < Some(path.duration.unwrap()), "{leg:?}");
    }

    #[test]
    fn paths_start_where_the_scene_says() {
        let mut database = Database::new();
        let rest =
            "movement m of rover { move 1 meters }\nenvironment e has { rover } robots with { m } moves";
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let id = database.environments(file)[0].0;
        database.set_scene(file, "e", Some("[robots.rover]\nstart = [1, 2, 90]"));
        let end = planned_path(&database, id).unwrap().robots[0].poses.last().unwrap().pose;
        assert!(end.distance(&Pose::new(1.0, 3.0, 0.0)) < 1e-9, "{end:?}");
        database.set_scene(file, "e", Some("[robots.rovr]\nstart = [1, 2, 90]"));
        let why = planned_path(&database, id).unwrap_err();
        assert_eq!(why, "`e.scene.toml`: the environment has no robot `rovr`");
    }
}
