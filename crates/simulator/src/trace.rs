//! What happened, step by step.

use serde::Serialize;

/// One robot at one moment, in the form of a line of `--trace` files.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    pub wheels: Vec<f64>,
    /// The movement that runs; the simulator cannot know it.
    pub movement: Option<String>,
    /// The action that runs; the simulator cannot know it.
    pub action: Option<String>,
}
