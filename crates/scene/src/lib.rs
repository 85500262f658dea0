//! The world robots drive in: their bodies, start poses, wheels and sensor mounts, and what stands in their way.
//!
//! Knows `kinematics`, plain data, and how scene files are written. Must never know the language, clocks, sockets or
//! where files are. Units: metres and radians; x forward, y left, θ counter-clockwise.
//!
//! * [`Scene`] is the value. [`read`] makes one from a scene file; [`TABLES`] is the one list of what can stand in it.
//! * [`Space`] answers how far things are from each other and what a sensor sees; [`collisions`] where planned paths meet
//!   something.

mod collision;
pub mod defaults;
mod file;
mod mount;
mod obstacle;
mod robot;
mod space;

pub use collision::{Collision, collisions};
pub use file::{ENDING, Key, Sort, TABLES, Table, Values, json_schema, manual, problems, read};
pub use mount::{Mount, mounts_by_name};
pub use obstacle::{Obstacle, Shape};
pub use robot::{Body, Robot, Sensor, SensorKind, Wheel};
pub use space::{Near, Sighting, Space, Thing, distance_between};

/// A world: robots on a floor with obstacles.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The robots, in the order the program's environment lists them.
    pub robots: Vec<Robot>,
    /// What stands on the floor, walls around it included.
    pub obstacles: Vec<Obstacle>,
    /// What goes wrong; `None` for nothing.
    pub noise: Option<Noise>,
    /// What noise is made from.
    pub seed: u64,
    /// Whether robots are stopped by what they touch.
    pub collisions: bool,
}

/// What goes wrong in a world: standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// How much of the way that a wheel rolls is lost or gained on the floor, as a share of it.
    pub wheel_slip: f64,
    /// How far readings of a distance are off, metres.
    pub sensor: f64,
}

impl Default for Noise {
    fn default() -> Self {
        Self { wheel_slip: defaults::WHEEL_SLIP, sensor: defaults::SENSOR_NOISE }
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            robots: Vec::new(),
            obstacles: Vec::new(),
            noise: None,
            seed: defaults::SEED,
            collisions: true,
        }
    }
}

impl Scene {
    /// An empty floor with each robot at its default start ([`defaults::start`]). Where nobody said where robots stand,
    /// nobody meant them to be in each other's way: they are not stopped by each other.
    pub fn empty_floor(mut robots: Vec<Robot>) -> Self {
        for (index, robot) in robots.iter_mut().enumerate() {
            robot.start = defaults::start(index);
        }
        Self { robots, collisions: false, ..Self::default() }
    }

    /// Robots that touch something where they start: each with the first obstacle or earlier robot that it touches.
    pub fn overlaps(&self) -> Vec<(usize, Thing)> {
        let space = Space::of(self);
        let touches = |index: usize| {
            let robot = &self.robots[index];
            let near = space.nearest(robot.body, robot.start, f64::MIN_POSITIVE);
            let mut before = self.robots[..index].iter();
            let other = before.position(|other| {
                distance_between((other.body, other.start), (robot.body, robot.start)) == 0.0
            });
            near.map(|near| Thing::Obstacle(near.obstacle)).or(other.map(Thing::Robot))
        };
        (0..self.robots.len()).filter_map(|index| Some((index, touches(index)?))).collect()
    }
}
