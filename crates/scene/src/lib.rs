//! The world robots drive in: their bodies, start poses, wheels and sensor mounts.
//!
//! Knows `kinematics` and plain data. Must never know the language, files, clocks or sockets.
//! Units: metres and radians; x forward, y left, θ counter-clockwise.

pub mod defaults;
mod mount;
mod robot;

pub use mount::{Mount, mounts_by_name};
pub use robot::{Body, Robot, Sensor, SensorKind, Wheel};

/// A world: so far an empty floor with robots on it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// The robots, in the order the program's environment lists them.
    pub robots: Vec<Robot>,
}

impl Scene {
    /// An empty floor with each robot at its default start ([`defaults::start`]).
    pub fn empty_floor(mut robots: Vec<Robot>) -> Self {
        for (index, robot) in robots.iter_mut().enumerate() {
            robot.start = defaults::start(index);
        }
        Self { robots }
    }
}
