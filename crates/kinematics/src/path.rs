//! The planned path of a robot.

use crate::Pose;
use crate::leg::{ActionIndex, Leg, Place};

/// Where a robot is, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPose {
    /// Seconds; `None` where that is not known.
    pub time: Option<f64>,
    /// Where it is.
    pub pose: Pose,
}

/// All that is known of one robot's drives.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotPath {
    /// Where the robot starts.
    pub start: Pose,
    /// The drive of each action up to the first unknown one, in order.
    pub legs: Vec<Leg>,
    /// True if more actions are known than are listed in `legs`.
    pub truncated: bool,
    /// The action whose outcome is unknown and, with it, every later pose of this robot.
    pub unknown_after: Option<ActionIndex>,
    /// In which rounds and calls that action is.
    pub unknown_place: Place,
    /// The possible drives from there, as far as they have a bound: the action up to its bound, or each way of a branch
    /// up to its own first unknown action, and that one to its bound. All begin where the known path ends.
    pub possible: Vec<Vec<Leg>>,
    pub(crate) end: Pose,
}

impl RobotPath {
    pub(crate) fn new(start: Pose) -> Self {
        Self {
            start,
            legs: Vec::new(),
            truncated: false,
            unknown_after: None,
            unknown_place: Place::default(),
            possible: Vec::new(),
            end: start,
        }
    }

    /// The last pose that is known, listed or not.
    pub fn end(&self) -> Pose {
        self.end
    }

    /// The known path, the start first, then `per_leg` poses (at least one) for each leg at equal intervals of time; the
    /// last of them is the leg's end.
    pub fn sample(&self, per_leg: u32) -> Vec<TimedPose> {
        let mut poses = vec![TimedPose { time: Some(0.0), pose: self.start }];
        sample_legs(&self.legs, per_leg, &mut poses);
        poses
    }

    /// Each way of [`Self::possible`] in the same manner, from where the known path ends.
    pub fn sample_possible(&self, per_leg: u32) -> Vec<Vec<TimedPose>> {
        let sample = |way: &Vec<Leg>| {
            let first = way.first().map(|leg| TimedPose { time: leg.start, pose: leg.from });
            let mut poses: Vec<TimedPose> = first.into_iter().collect();
            sample_legs(way, per_leg, &mut poses);
            poses
        };
        self.possible.iter().map(sample).collect()
    }
}

/// Adds the poses of legs to those before them.
fn sample_legs(legs: &[Leg], per_leg: u32, poses: &mut Vec<TimedPose>) {
    for leg in legs {
        let at = |seconds: f64| leg.start.map(|start| start + seconds);
        if poses.last().is_some_and(|last| last.time < leg.start) {
            // It waited for others.
            poses.push(TimedPose { time: leg.start, pose: leg.from });
        }
        let inner = (1..per_leg).map(|i| leg.duration * f64::from(i) / f64::from(per_leg));
        poses.extend(inner.map(|seconds| TimedPose { time: at(seconds), pose: leg.pose_at(seconds) }));
        poses.push(TimedPose { time: at(leg.duration), pose: leg.to });
    }
}
