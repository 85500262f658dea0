//! The motion of robots where neither program nor scene says otherwise.
//!
//! The only place for these figures. Plans and the simulator read them here; those that scripts need are written into
//! `python/pydslrep_runtime/facts.py`, and a test fails while that file has others (`crates/script/tests/facts.rs`).

/// Length of a simulation step, in seconds: that of CoppeliaSim unless a scene chooses another one.
pub const STEP: f64 = 0.05;

/// Rim speed of a straight move without `at`, and of every turn, in metres per second.
pub const RIM_SPEED: f64 = 0.09;

/// The greatest change of a wheel's rim speed, in metres per second squared.
pub const RIM_ACCELERATION: f64 = 0.5;

/// The time an action takes beyond its speed profile, in seconds: the last millimetres are approached more slowly, and
/// the robot has to be at rest before the next action starts. Measured in steps of [`STEP`].
pub const REST: f64 = 0.15;
