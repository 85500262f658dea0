//! Kinematic models of wheeled robots, exact integration of their motion, and planned paths.
//!
//! Knows numbers only. Must never know the language, files, clocks or threads.
//! Units everywhere: metres, seconds, radians; x forward, y left, θ counter-clockwise.

mod drive;

pub use drive::Drive;
