//! The world robots drive in: their bodies, start poses, wheels and sensor mounts, and the obstacles around them.
//!
//! Knows `kinematics`, plain data, and the format of scene files. Must never know the language, clocks, sockets or
//! where files are. Units: metres and radians; x forward, y left, θ counter-clockwise.
//!
//! * [`Scene`] is the value. [`read`] makes one from a scene file; [`SCHEMA`] is the list of what it can contain.
//! * [`Space`] computes distances and what a sensor sees; [`collisions`] finds those of planned paths.
//! * [`mjcf()`] writes it for `MuJoCo`.
//! * [`Trajectory`] says where an obstacle that moves is at which time.

mod collision;
pub mod defaults;
mod file;
mod mjcf;
mod mount;
mod obstacle;
mod robot;
mod ros2;
mod space;
mod trajectory;

pub use collision::{Collision, collisions};
pub use file::{ENDING, SCHEMA, json_schema, manual, problems, read};
pub use mjcf::mjcf;
pub use mount::{Mount, mounts_by_name};
pub use obstacle::{Obstacle, Shape};
pub use robot::{Body, Frame, Objects, Robot, Sensor, SensorKind, Wheel, geometry_of};
pub use ros2::{Ros2, Ros2Value, Topics};
pub use space::{Near, SceneObject, Sighting, Space, distance_between, triangulate};
pub use trajectory::{Trajectory, TrajectoryError, TrajectorySegment, Waypoint};

/// A world: robots on a floor with obstacles.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The robots, in the order the program's environment lists them.
    pub robots: Vec<Robot>,
    /// The obstacles on the floor, including the walls around it.
    pub obstacles: Vec<Obstacle>,
    /// Deviations from an ideal world, if there are any.
    pub noise: Option<Noise>,
    /// The seed of noise.
    pub seed: u64,
    /// True if robots are stopped by what they touch.
    pub collisions: bool,
    /// The coefficient of sliding friction between wheels and the floor.
    pub friction: f64,
}

/// Deviations from an ideal world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of the distance that a wheel drives the robot, as a share of the distance that it rolls: a standard deviation.
    pub wheel_slip: f64,
    /// By which share of it the track is wider than [`Robot::geometry`] says.
    pub track_error: f64,
    /// By which share of it the radius of each wheel is larger than [`Wheel::radius`] says.
    pub radius_error: f64,
    /// Of the readings of distances, metres: a standard deviation.
    pub sensor: f64,
}

impl Default for Noise {
    fn default() -> Self {
        Self {
            wheel_slip: defaults::WHEEL_SLIP,
            track_error: 0.0,
            radius_error: 0.0,
            sensor: defaults::SENSOR_NOISE,
        }
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
            friction: defaults::FRICTION,
        }
    }
}

impl Scene {
    /// An empty floor with each robot at its default start ([`defaults::start`]). Since these positions are not chosen by
    /// anyone, robots are not stopped by each other.
    pub fn empty_floor(mut robots: Vec<Robot>) -> Self {
        for (index, robot) in robots.iter_mut().enumerate() {
            robot.start = defaults::start(index);
        }
        Self { robots, collisions: false, ..Self::default() }
    }

    /// Robots that touch something at their start: each with the first obstacle or earlier robot that it touches.
    pub fn overlaps(&self) -> Vec<(usize, SceneObject)> {
        let space = Space::of(self);
        let touches = |index: usize| {
            let robot = &self.robots[index];
            let near = space.nearest(robot.body, robot.start, f64::MIN_POSITIVE);
            let mut before = self.robots[..index].iter();
            let other = before.position(|other| {
                distance_between((other.body, other.start), (robot.body, robot.start)) == 0.0
            });
            near.map(|near| SceneObject::Obstacle(near.obstacle)).or(other.map(SceneObject::Robot))
        };
        (0..self.robots.len()).filter_map(|index| Some((index, touches(index)?))).collect()
    }
}
