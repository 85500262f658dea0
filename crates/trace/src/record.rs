//! The records of a trace.

use std::collections::BTreeMap;

use pydslrep_kinematics::{Pose, TimedPose};
use serde::{Deserialize, Serialize};

/// One robot at one time: a line of a `--trace` file.
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
    /// Wheel rates, rad/s, in the order of the robot's wheels; positive values roll forward.
    #[serde(default)]
    pub wheels: Vec<f64>,
    /// The readings of its sensors since its last record, by name: metres, or `None` for nothing. A bumper that is
    /// pressed reads 0. Only what a script has looked at; unknown to the simulator.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub readings: BTreeMap<String, Option<f64>>,
    /// The current movement; unknown to the simulator.
    #[serde(default)]
    pub movement: Option<String>,
    /// The current action; unknown to the simulator.
    #[serde(default)]
    pub action: Option<String>,
}

impl TraceRecord {
    /// The pose with its time.
    pub fn timed_pose(&self) -> TimedPose {
        TimedPose { time: Some(self.t), pose: Pose::new(self.x, self.y, self.theta) }
    }
}

/// Records as the lines of a `--trace` file.
pub fn lines(records: &[TraceRecord]) -> Vec<u8> {
    let mut lines = Vec::new();
    for record in records {
        // Writing plain numbers and names into memory cannot fail.
        let _ = serde_json::to_writer(&mut lines, record);
        lines.push(b'\n');
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_round_trip_and_may_omit_optional_fields() {
        let record = TraceRecord {
            t: 0.05,
            robot: "rover".to_owned(),
            x: 1.0,
            y: -2.0,
            theta: 0.5,
            wheels: vec![1.5, 1.5],
            readings: BTreeMap::from([("front".to_owned(), Some(0.25)), ("rear".to_owned(), None)]),
            movement: None,
            action: Some("turn left".to_owned()),
        };
        let line = serde_json::to_string(&record).unwrap();
        assert_eq!(serde_json::from_str::<TraceRecord>(&line).unwrap(), record);
        let short = r#"{"t": 1, "robot": "rover", "x": 0, "y": 0, "theta": 0}"#;
        assert_eq!(serde_json::from_str::<TraceRecord>(short).unwrap().timed_pose().time, Some(1.0));
    }
}
