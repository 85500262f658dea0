//! What happened, step by step.

use pydslrep_kinematics::{Pose, TimedPose};
use serde::{Deserialize, Serialize};

/// One robot at one moment, in the form of a line of `--trace` files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TraceRecord {
    /// Simulation time, seconds.
    pub t: f64,
    /// The robot's name.
    pub robot: String,
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Radians, in (−π, π].
    pub theta: f64,
    /// Wheel rates, rad/s, in the order of the robot's wheels; positive rolls forward.
    #[serde(default)]
    pub wheels: Vec<f64>,
    /// The movement that runs; the simulator cannot know it.
    #[serde(default)]
    pub movement: Option<String>,
    /// The action that runs; the simulator cannot know it.
    #[serde(default)]
    pub action: Option<String>,
}

impl TraceRecord {
    /// Where the robot was, and when.
    pub fn timed_pose(&self) -> TimedPose {
        TimedPose { time: Some(self.t), pose: Pose::new(self.x, self.y, self.theta) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_what_was_written_and_may_leave_out_what_nobody_knows() {
        let record = TraceRecord {
            t: 0.05,
            robot: "rover".to_owned(),
            x: 1.0,
            y: -2.0,
            theta: 0.5,
            wheels: vec![1.5, 1.5],
            movement: None,
            action: Some("turn left".to_owned()),
        };
        let line = serde_json::to_string(&record).unwrap();
        assert_eq!(serde_json::from_str::<TraceRecord>(&line).unwrap(), record);
        let short = r#"{"t": 1, "robot": "rover", "x": 0, "y": 0, "theta": 0}"#;
        assert_eq!(serde_json::from_str::<TraceRecord>(short).unwrap().timed_pose().time, Some(1.0));
    }
}
