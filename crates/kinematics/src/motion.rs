//! How robots move where neither program nor scene says otherwise.
//!
//! The only place for these figures: plans, scripts and the simulator all read them here.

/// Length of a simulation step, in seconds (CoppeliaSim's default too).
pub const STEP: f64 = 0.05;

/// Rim speed of a straight move without `at`, and of every turn, in metres per second.
pub const RIM_SPEED: f64 = 0.09;

/// How fast the rim speed of a wheel may change, in metres per second squared.
pub const RIM_ACCELERATION: f64 = 0.5;

/// How long an action takes beyond its speed profile, in seconds: the last millimetres are approached more slowly, and the
/// robot has to be at rest before the next action starts. Measured in steps of [`STEP`].
pub const REST: f64 = 0.15;
