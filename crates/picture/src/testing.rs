//! Routes for tests.

use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_scene::Body;
use pydslrep_trace::Map;

use crate::Route;

/// A path along x: (seconds, metres).
pub(crate) fn along(points: &[(f64, f64)]) -> Vec<TimedPose> {
    let pose = |&(time, x)| TimedPose { time: Some(time), pose: Pose { x, y: 0.0, theta: 0.0 } };
    points.iter().map(pose).collect()
}

/// A route that is planned only.
pub(crate) fn route(planned: Vec<TimedPose>) -> Route {
    Route {
        name: "robot_1".to_owned(),
        body: Body { length: 0.3, width: 0.3 },
        planned,
        unknown_after: false,
        possible: vec![],
        driven: vec![],
        seen: vec![],
        map: Map::default(),
    }
}
