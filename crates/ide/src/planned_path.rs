//! Planned paths: where each robot of an environment will be and when, for a preview beside the program.

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{Blocked, Database, EntityId, plan};
use pydslrep_kinematics::{Leg, Pose, RobotPath};
use pydslrep_notation::Problem;
use pydslrep_scene::ENDING;

/// The planned path of an environment in its scene.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPath {
    /// Its name.
    pub environment: String,
    /// Seconds until the last movement ends; `None` where that cannot be planned.
    pub duration: Option<f64>,
    /// In listed order.
    pub robots: Vec<PlannedRobot>,
}

/// The planned path of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRobot {
    /// Its name.
    pub name: String,
    /// Its first pose is where it starts.
    pub poses: Vec<PlannedPose>,
    /// The action after which its poses cannot be planned.
    pub unknown_after: Option<PlannedAction>,
}

/// A pose on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPose {
    /// Seconds from the start; `None` where an earlier action takes an unknown time.
    pub time: Option<f64>,
    /// Absolute; metres and radians.
    pub pose: Pose,
    /// The action that leads to it; `None` for the start.
    pub action: Option<PlannedAction>,
}

/// An action of a planned path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedAction {
    /// The movement's name.
    pub movement: String,
    /// Counts the movement's actions from 0.
    pub index: usize,
    /// The action as written.
    pub text: String,
}

/// Poses of a planned action, at equal intervals of time: enough for a curve and for the ramps at its ends.
const POSES_PER_ACTION: u32 = 8;

/// The planned path of an environment; the error says why there is none.
///
/// # Errors
/// When the environment or its scene has errors, or a robot in it cannot drive.
pub fn planned_path(database: &Database, environment: EntityId) -> Result<PlannedPath, String> {
    let id = environment;
    let environment = database.environment(id).map_err(|blocked: Blocked| blocked.reason())?;
    let scene = database.scene(id, &environment).map_err(|problems| wrong_scene(&environment, &problems))?;
    let plan = plan(&environment, &scene).map_err(|error| error.to_string())?;
    let robots = environment.robots.iter().zip(&plan.robots).map(|(robot, path)| PlannedRobot {
        name: robot.name.clone(),
        poses: poses(&environment, path),
        unknown_after: path
            .unknown_after
            .and_then(|index| action(&environment, index.group, index.run, index.action)),
    });
    let robots = robots.collect();
    Ok(PlannedPath { environment: environment.name, duration: plan.duration, robots })
}

/// Why nothing is planned in a scene, in words.
fn wrong_scene(environment: &Environment, problems: &[Problem]) -> String {
    let first = problems.first().map_or("it has mistakes", |problem| problem.message.as_str());
    format!("`{}{ENDING}`: {first}", environment.name)
}

fn poses(environment: &Environment, path: &RobotPath) -> Vec<PlannedPose> {
    let start = PlannedPose { time: Some(0.0), pose: path.start, action: None };
    std::iter::once(start).chain(path.legs.iter().flat_map(|leg| on_leg(environment, leg))).collect()
}

fn on_leg(environment: &Environment, leg: &Leg) -> Vec<PlannedPose> {
    let action = action(environment, leg.index.group, leg.index.run, leg.index.action);
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

fn action(environment: &Environment, group: usize, run: usize, index: usize) -> Option<PlannedAction> {
    let movement = environment.movements.get(*environment.schedule.get(group)?.get(run)?)?;
    let text = movement.actions.get(index)?.text.clone();
    Some(PlannedAction { movement: movement.name.clone(), index, text })
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
