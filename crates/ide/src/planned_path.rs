//! Planned paths: the timed poses of each robot of an environment, for a preview next to the program.
//!
//! These structs are what clients receive, field by field: `editors/preview/host/protocol.ts` has the same shape in
//! TypeScript, and a test below holds it there.

use std::fmt;

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{Blocked, Database, EntityId, check_cancelled, plan};
use pydslrep_kinematics::{ActionIndex, Leg, ModelError, Place, Plan, Pose, RobotPath};
use pydslrep_scene::{self as scenery, Collision, ENDING, Mount, Robot, Scene, SceneObject, Shape};
use pydslrep_schema::Problem;
use serde::{Deserialize, Serialize};

use crate::planned_action::PlannedCall;

/// The planned path of an environment in its scene. Lengths are metres, angles radians, times seconds from the start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedPath {
    /// Its name.
    pub environment: String,
    /// When the last movement ends; `None` if it cannot be planned.
    pub duration: Option<f64>,
    /// In listed order.
    pub robots: Vec<PlannedRobot>,
    /// The obstacles of the scene.
    pub obstacles: Vec<Obstacle>,
    /// The planned collisions, earliest first.
    pub collisions: Vec<PlannedCollision>,
}

/// The planned path of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PlannedRobot {
    /// Its name.
    pub name: String,
    /// Its outer size.
    pub body: BodySize,
    /// Where its sensors sit and what they see.
    pub sensors: Vec<SensorCone>,
    /// Its first pose is where it starts.
    pub poses: Vec<PlannedPose>,
    /// Its drives, in order: the same movement may be listed twice, so poses alone do not tell them apart.
    pub legs: Vec<PlannedLeg>,
    /// The action after which its poses cannot be planned.
    pub unknown_after: Option<PlannedAction>,
    /// The ways that it may take from there, as far as they have a bound: one for an action that ends at the latest where
    /// this way does, or one for each branch.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub possible: Vec<PossibleWay>,
}

/// A way that a robot may take where its path becomes unknown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PossibleWay {
    /// Its first pose is where the known path ends; times are those of the latest end.
    pub poses: Vec<PlannedPose>,
    /// Its drives, in order, with the indices of these poses.
    pub legs: Vec<PlannedLeg>,
}

/// The outer size of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BodySize {
    /// Along its heading.
    pub length: f64,
    /// Across it.
    pub width: f64,
}

/// A sensor's pose on its robot, and what it sees from there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SensorCone {
    /// Its name.
    pub name: String,
    /// Forward of the robot's middle.
    pub x: f64,
    /// To the left of it.
    pub y: f64,
    /// Where it looks.
    pub theta: f64,
    /// Its range, metres.
    pub range: f64,
    /// The angle of its cone.
    pub cone: f64,
}

/// A pose on the way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedPose {
    /// When; `None` after an action of unknown duration.
    pub t: Option<f64>,
    /// Absolute.
    pub x: f64,
    /// Absolute.
    pub y: f64,
    /// Absolute.
    pub theta: f64,
    /// The action that leads to it; `None` for the start.
    pub action: Option<PlannedAction>,
}

/// The drive of one action.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedLeg {
    /// The action.
    pub action: PlannedAction,
    /// When it begins; `None` after an action of unknown duration.
    pub start: Option<f64>,
    /// Its duration, seconds.
    pub duration: f64,
    /// The index of its last pose among those of its robot; it starts at the last pose of the previous leg.
    pub last: usize,
}

/// An action of a planned path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedAction {
    /// The movement's name.
    pub movement: String,
    /// The zero-based index among the statements of its movement: the listed one, or the last that is done.
    pub index: usize,
    /// As the program writes it.
    pub text: String,
    /// The rounds of the repetitions that it is in, from 1, the outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rounds: Vec<u32>,
    /// The number of rounds of each of these repetitions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counts: Vec<u32>,
    /// The statements that lead to it by `do`, the outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calls: Vec<PlannedCall>,
    /// The movement whose statement it is, if that is one that others do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub done: Option<String>,
}

/// An obstacle seen from above.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Obstacle {
    /// Its name.
    pub name: String,
    /// Where it is; of one that moves, where it is at the start.
    #[serde(flatten)]
    pub outline: Outline,
    /// Its path, if it moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<ObstaclePath>,
}

/// The outline of an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Outline {
    /// A cylinder.
    Circle {
        /// x and y.
        centre: (f64, f64),
        /// Of the circle.
        radius: f64,
    },
    /// Anything else.
    Polygon {
        /// x and y of each.
        corners: Vec<(f64, f64)>,
    },
}

/// The path of a moving obstacle: straight between points, each section at a constant speed. Its heading stays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObstaclePath {
    /// Seconds, x and y of each, in the order of their times.
    pub points: Vec<(f64, f64, f64)>,
    /// True if it goes back and forth for ever; otherwise it stays at the last point.
    pub repeat: bool,
}

/// A robot that would run into something.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlannedCollision {
    /// Its name.
    pub robot: String,
    /// The action that it is doing.
    pub action: Option<PlannedAction>,
    /// When; `None` after an action of unknown duration.
    pub t: Option<f64>,
    /// Where it is then.
    pub x: f64,
    /// Where it is then.
    pub y: f64,
    /// Its heading then.
    pub theta: f64,
    /// The other side of the collision.
    pub with: CollisionTarget,
}

/// The thing that a robot collides with, by name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CollisionTarget {
    /// Something on the floor.
    Obstacle(String),
    /// Another robot.
    Robot(String),
}

/// Why there is no planned path.
#[derive(Debug, Clone, PartialEq)]
pub enum NoPath {
    /// The environment has errors.
    Blocked(Blocked),
    /// Its scene has.
    Scene {
        /// The environment's name.
        environment: String,
        /// All of them, in the order of the text.
        problems: Vec<Problem>,
    },
    /// A robot cannot drive.
    Robot(ModelError),
}

impl fmt::Display for NoPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Blocked(blocked) => f.write_str(&blocked.reason()),
            Self::Scene { environment, problems } => {
                let first = problems.first().map_or("it has errors", |problem| problem.message.as_str());
                write!(f, "`{environment}{ENDING}`: {first}")
            }
            Self::Robot(error) => error.fmt(f),
        }
    }
}

/// Poses of a planned action, at equal intervals of time: enough for a turn and for the ramps at its ends.
const POSES_PER_ACTION: u32 = 8;

/// The angle between two poses on an arc, degrees: a polyline of them looks round. No arc has more than [`MAX_ARC_POSES`].
const ARC_STEP: f64 = 5.0;
const MAX_ARC_POSES: f64 = 720.0;

/// The planned path of an environment.
///
/// # Errors
/// If the environment or its scene has errors, or a robot cannot drive.
pub fn planned_path(database: &Database, environment: EntityId) -> Result<PlannedPath, NoPath> {
    let id = environment;
    let environment = database.environment(id).map_err(NoPath::Blocked)?;
    let scene = database
        .scene(id, &environment)
        .map_err(|problems| NoPath::Scene { environment: environment.name.clone(), problems })?;
    let plan = plan(&environment, &scene).map_err(NoPath::Robot)?;
    let collisions = collisions(&environment, &scene, &plan);
    let robots = scene.robots.iter().zip(&plan.robots);
    let robots = robots.map(|(robot, path)| planned_robot(&environment, robot, path)).collect();
    let obstacles = scene.obstacles.iter().map(obstacle).collect();
    Ok(PlannedPath { duration: plan.duration, robots, obstacles, collisions, environment: environment.name })
}

fn planned_robot(environment: &Environment, robot: &Robot, path: &RobotPath) -> PlannedRobot {
    PlannedRobot {
        name: robot.name.clone(),
        body: BodySize { length: robot.body.length, width: robot.body.width },
        sensors: robot.sensors.iter().map(sensor).collect(),
        poses: poses(environment, planned_pose(Some(0.0), path.start, None), &path.legs),
        legs: legs(environment, &path.legs),
        unknown_after: path.unknown_after.and_then(|index| action(environment, index, &path.unknown_place)),
        possible: path.possible.iter().filter_map(|way| possible(environment, way)).collect(),
    }
}

fn sensor(sensor: &scenery::Sensor) -> SensorCone {
    let Mount { pose: Pose { x, y, theta }, range, cone } = sensor.mount;
    SensorCone { name: sensor.name.clone(), x, y, theta, range, cone }
}

fn obstacle(obstacle: &scenery::Obstacle) -> Obstacle {
    let outline = match obstacle.shape {
        Shape::Cylinder { radius } => Outline::Circle { centre: (obstacle.pose.x, obstacle.pose.y), radius },
        // Shapes that are not round have corners of their own.
        _ => Outline::Polygon { corners: obstacle.outline(0) },
    };
    Obstacle { name: obstacle.name.clone(), outline, path: obstacle.trajectory.as_ref().map(obstacle_path) }
}

fn obstacle_path(trajectory: &scenery::Trajectory) -> ObstaclePath {
    let points = trajectory.points().iter().map(|point| (point.time, point.x, point.y)).collect();
    ObstaclePath { points, repeat: trajectory.repeats() }
}

fn collisions(environment: &Environment, scene: &Scene, plan: &Plan) -> Vec<PlannedCollision> {
    let target = |object| match object {
        SceneObject::Obstacle(index) => {
            scene.obstacles.get(index).map(|obstacle| CollisionTarget::Obstacle(obstacle.name.clone()))
        }
        SceneObject::Robot(index) => {
            scene.robots.get(index).map(|robot| CollisionTarget::Robot(robot.name.clone()))
        }
    };
    let named = |found: Collision| {
        let robot = scene.robots.get(found.robot)?.name.clone();
        let (action, with) = (action(environment, found.action, &found.place), target(found.with)?);
        let Pose { x, y, theta } = found.pose;
        Some(PlannedCollision { robot, action, t: found.time, x, y, theta, with })
    };
    let mut found: Vec<_> = scenery::collisions(scene, plan).into_iter().filter_map(named).collect();
    let moment = |collision: &PlannedCollision| collision.t.unwrap_or(f64::INFINITY);
    found.sort_by(|a, b| moment(a).total_cmp(&moment(b)));
    found
}

fn poses(environment: &Environment, start: PlannedPose, legs: &[Leg]) -> Vec<PlannedPose> {
    std::iter::once(start).chain(legs.iter().flat_map(|leg| on_leg(environment, leg))).collect()
}

fn possible(environment: &Environment, way: &[Leg]) -> Option<PossibleWay> {
    let first = way.first()?;
    let start = planned_pose(first.start, first.from, None);
    let poses = poses(environment, start, way);
    Some(PossibleWay { poses, legs: legs(environment, way) })
}

fn on_leg(environment: &Environment, leg: &Leg) -> Vec<PlannedPose> {
    check_cancelled();
    let action = action(environment, leg.index, &leg.place);
    let count = pose_count(leg);
    let at = |number: u32| {
        let seconds = leg.duration * f64::from(number) / f64::from(count);
        planned_pose(leg.start.map(|start| start + seconds), leg.pose_at(seconds), action.clone())
    };
    (1..=count).map(at).collect()
}

fn pose_count(leg: &Leg) -> u32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is within bounds")]
    let on_arc = (leg.arc().to_degrees() / ARC_STEP).ceil().clamp(0.0, MAX_ARC_POSES) as u32;
    on_arc.max(POSES_PER_ACTION)
}

fn planned_pose(t: Option<f64>, Pose { x, y, theta }: Pose, action: Option<PlannedAction>) -> PlannedPose {
    PlannedPose { t, x, y, theta, action }
}

fn legs(environment: &Environment, legs: &[Leg]) -> Vec<PlannedLeg> {
    let mut last = 0;
    let planned = |leg: &Leg| {
        last += pose_count(leg) as usize;
        let action = action(environment, leg.index, &leg.place)?;
        Some(PlannedLeg { action, start: leg.start, duration: leg.duration, last })
    };
    legs.iter().filter_map(planned).collect()
}

fn action(environment: &Environment, at: ActionIndex, place: &Place) -> Option<PlannedAction> {
    let found = environment.place(at, place)?;
    let calls = found.calls.iter();
    let done = place.calls().last().and_then(|call| environment.movements.get(call.movement));
    Some(PlannedAction {
        movement: found.movement.to_owned(),
        index: found.number - 1,
        text: found.text.to_owned(),
        calls: calls
            .map(|call| PlannedCall { movement: call.movement.to_owned(), index: call.number - 1 })
            .collect(),
        rounds: found.rounds,
        counts: found.counts,
        done: done.map(|movement| movement.name.clone()),
    })
}

#[cfg(test)]
mod tests {
    use expect_test::expect_file;

    use super::*;
    use crate::fixture::PARTS;

    fn path(rest: &str) -> Result<PlannedPath, NoPath> {
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
        assert!(path.unwrap_err().to_string().contains("sensors"));
        let path = self::path(
            "movement m of rover { move 1 meters turn left turn left until { front } move 1 meters }\nenvironment e has { rover } robots with { m } moves",
        )
        .unwrap();
        assert_eq!((path.environment.as_str(), path.duration), ("e", None));
        let rover = &path.robots[0];
        assert_eq!(rover.poses.len(), 1 + 2 * 8);
        assert_eq!(rover.poses[0], PlannedPose { t: Some(0.0), x: 0.0, y: 0.0, theta: 0.0, action: None });
        let last = rover.poses.last().unwrap();
        assert!((last.x - 1.0).hypot(last.y) < 1e-9);
        assert_eq!(last.action.as_ref().unwrap().text, "turn left");
        assert!(rover.poses.windows(2).all(|pair| pair[0].t < pair[1].t));
        assert_eq!(rover.unknown_after.as_ref().unwrap().index, 2);
        let legs: Vec<_> = rover.legs.iter().map(|leg| (leg.action.index, leg.last)).collect();
        assert_eq!(legs, [(0, 8), (1, 16)]);
        let turn = &rover.legs[1];
        assert_eq!(rover.poses[turn.last].t, turn.start.map(|start| start + turn.duration));
    }

    #[test]
    fn actions_say_their_rounds_and_the_movements_that_lead_to_them() {
        let path = path(
            "movement m of rover { turn left repeat 2 times { do side } }
            movement side of rover { move 1 meters }
            environment e has { rover } robots with { m } moves",
        )
        .unwrap();
        let actions: Vec<_> = path.robots[0].legs.iter().map(|leg| &leg.action).collect();
        assert_eq!(
            (&actions[0].rounds[..], &actions[0].calls[..], &actions[0].done),
            (&[][..], &[][..], &None)
        );
        let call = PlannedCall { movement: "m".to_owned(), index: 2 };
        for (round, action) in (1..).zip(&actions[1..]) {
            assert_eq!((action.movement.as_str(), action.index), ("m", 0));
            assert_eq!((&action.rounds[..], &action.counts[..]), (&[round][..], &[2][..]));
            assert_eq!(action.calls, std::slice::from_ref(&call));
            assert_eq!(action.done.as_deref(), Some("side"));
        }
        assert_eq!(actions.len(), 3);
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
        let outline = Outline::Circle { centre: (0.0, 1.0), radius: 0.1 };
        let pole = Obstacle { name: "pole".to_owned(), outline, path: None };
        assert_eq!(path.obstacles, [pole]);
        let [collision] = &path.collisions[..] else { panic!("{:?}", path.collisions) };
        assert_eq!(
            (collision.robot.as_str(), &collision.with),
            ("rover", &CollisionTarget::Obstacle("pole".to_owned()))
        );
        assert_eq!(collision.action.as_ref().unwrap().text, "move 3 meters");
        let front = collision.y + path.robots[0].body.length / 2.0;
        assert!((front - 0.9).abs() < 0.002, "{collision:?}");
        let leg = &path.robots[0].legs[1];
        assert!(collision.t > leg.start && collision.t < Some(path.duration.unwrap()), "{leg:?}");
    }

    #[test]
    fn paths_start_where_the_scene_says() {
        let mut database = Database::new();
        let rest =
            "movement m of rover { move 1 meters }\nenvironment e has { rover } robots with { m } moves";
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let id = database.environments(file)[0].0;
        database.set_scene(file, "e", Some("[robots.rover]\nstart = [1, 2, 90]"));
        let path = planned_path(&database, id).unwrap();
        let end = path.robots[0].poses.last().unwrap();
        assert!((end.x - 1.0).hypot(end.y - 3.0) < 1e-9, "{end:?}");
        database.set_scene(file, "e", Some("[robots.rovr]\nstart = [1, 2, 90]"));
        let why = planned_path(&database, id).unwrap_err();
        assert_eq!(why.to_string(), "`e.scene.toml`: the environment has no robot `rovr`");
    }

    #[test]
    fn an_arc_has_poses_enough_to_look_round() {
        let path = path(
            "movement m of rover { turn left turn left 360 with radius 2 meters move 1 meters }
            environment e has { rover } robots with { m } moves",
        )
        .unwrap();
        let rover = &path.robots[0];
        let lasts: Vec<_> = rover.legs.iter().map(|leg| leg.last).collect();
        assert_eq!(lasts, [8, 8 + 72, 8 + 72 + 8]);
        let circle = &rover.poses[8..=80];
        let off = circle.windows(2).map(|pair| {
            let middle = (f64::midpoint(pair[0].x, pair[1].x), f64::midpoint(pair[0].y, pair[1].y));
            2.0 - (middle.0 + 2.0).hypot(middle.1)
        });
        assert!(off.fold(0.0, f64::max) < 0.01, "a chord is less than 1 cm within its arc");
    }

    #[test]
    fn what_is_possible_is_beside_what_is_known() {
        let path = path(
            "movement m of rover { repeat 3 times {
                move 1 meters
                if { front } detect { turn left 90 with radius 1 meters } else { move 2 meters until { front } detect turn left }
            } }
            environment e has { rover } robots with { m } moves",
        )
        .unwrap();
        let rover = &path.robots[0];
        assert_eq!((path.duration, rover.legs.len(), rover.poses.len()), (None, 1, 9));
        assert_eq!(rover.unknown_after.as_ref().unwrap().text, "if { front } detect");
        let [circle, bounded] = &rover.possible[..] else { panic!("{:?}", rover.possible) };
        for (way, text, last) in [
            (circle, "turn left 90 with radius 1 meters", 18),
            (bounded, "move 2 meters until { front } detect", 8),
        ] {
            let (known, first) = (rover.poses.last().unwrap(), &way.poses[0]);
            assert_eq!((first.t, first.x, first.y, &first.action), (known.t, known.x, known.y, &None));
            let [leg] = &way.legs[..] else { panic!("{way:?}") };
            assert_eq!((leg.action.text.as_str(), leg.last, way.poses.len()), (text, last, last + 1));
            assert_eq!((&leg.action.rounds[..], &leg.action.counts[..]), (&[1][..], &[3][..]));
        }
        let [there, ahead] = [circle, bounded].map(|way| way.poses.last().unwrap());
        assert!((there.x - 2.0).hypot(there.y - 1.0) < 1e-9 && (ahead.x - 3.0).hypot(ahead.y) < 1e-9);
        assert_eq!(path.collisions, [], "nothing is said of what may be");
    }

    #[test]
    fn obstacles_that_move_say_how() {
        let mut database = Database::new();
        let rest = "environment e has { rover } robots";
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let id = database.environments(file)[0].0;
        let scene =
            "[[cylinder]]\nname = \"cart\"\nradius = 0.1\npath = [[1, 0, 2], [3, 1, 2]]\nrepeat = true";
        database.set_scene(file, "e", Some(scene));
        let path = planned_path(&database, id).unwrap();
        let outline = Outline::Circle { centre: (0.0, 2.0), radius: 0.1 };
        let way = ObstaclePath { points: vec![(1.0, 0.0, 2.0), (3.0, 1.0, 2.0)], repeat: true };
        assert_eq!(path.obstacles, [Obstacle { name: "cart".to_owned(), outline, path: Some(way) }]);
    }

    /// `tsc` holds the types of the preview against this value.
    #[test]
    fn clients_know_the_shape() {
        let mut database = Database::new();
        let rest = "movement m of rover { repeat 2 times { do side } move 1 meters until { front } detect }
            movement side of rover { move 1 meters }
            environment e has { rover } robots with { m } moves";
        let file = database.open("a.pyr", &format!("{PARTS}{rest}"));
        let id = database.environments(file)[0].0;
        let scene = "[[cylinder]]\nname = \"pole\"\nat = [0.5, 0]\nradius = 0.1\n
            [[box]]\nname = \"crate\"\nsize = [1, 1]\npath = [[0, 3, 3], [5, 4, 3]]";
        database.set_scene(file, "e", Some(scene));
        let path = serde_json::to_string_pretty(&planned_path(&database, id).unwrap()).unwrap();
        expect_file!["../../../editors/preview/tests/planned_path.sample.ts"].assert_eq(&format!(
            "// Written by a test of crates/ide/src/planned_path.rs.\n\
             import type {{ PlannedPath }} from \"../host/protocol\";\n\n\
             export const path: PlannedPath = {path};\n"
        ));
    }
}
