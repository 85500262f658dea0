//! A robot of a scene.

use std::collections::BTreeMap;

use pydslrep_kinematics::{Drive, Geometry, Model, ModelError, Pose, Traction, scrub_factor};

use crate::{Mount, Ros2, defaults, mounts_by_name};

/// A robot: a rectangular body on driven wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its name, also for clients of the remote API.
    pub name: String,
    /// Its type.
    pub drive: Drive,
    /// As many as its type has, in its order.
    pub wheels: Vec<Wheel>,
    /// Sensors with their mounts.
    pub sensors: Vec<Sensor>,
    /// The pose of the body's centre at the start of a run.
    pub start: Pose,
    /// Outer size.
    pub body: Body,
    /// Distance between wheels; their middle is the body's centre.
    pub geometry: Geometry,
    /// The friction of its wheels across their rolling direction, as a share of that along it; see
    /// [`pydslrep_kinematics::Traction`].
    pub lateral_friction: f64,
    /// The greatest acceleration of the wheels' rims, metres per second squared.
    pub motor_acceleration: f64,
    /// The greatest speed of the wheels' rims, metres per second; infinite for no limit.
    pub motor_speed: f64,
    /// The gain of the motors that hold their speed: newtons at the wheels' rims for each metre per second that it is
    /// off.
    pub motor_gain: f64,
    /// The width of its wheels if they are standard ones, metres.
    pub wheel_width: f64,
    /// The frame that clients of the remote API see of the object with its name.
    pub frame: Frame,
    /// Where it and its parts are in `CoppeliaSim`'s scene, if their objects have other names there.
    pub objects: Objects,
    /// The settings of its topics in ROS 2 that are not the usual ones.
    pub ros2: Ros2,
}

/// The paths of a robot and its parts in a simulator's scene, by name. Parts of different kinds may share one.
pub type Objects = BTreeMap<String, Vec<String>>;

/// The frame of the object that has a robot's name. Scripts can drive the first kind only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frame {
    /// x ahead, y to the left, z up.
    #[default]
    Ahead,
    /// x up, y to the left, z behind.
    XUp,
    /// x to the left, y behind, z up.
    XLeft,
    /// x down, y to the left, z ahead.
    ZAhead,
    /// The object stays at the robot's start; what moves is below it.
    Static,
}

impl Frame {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Ahead, Self::XUp, Self::XLeft, Self::ZAhead, Self::Static];

    /// Its name in scene files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Ahead => "ahead",
            Self::XUp => "x-up",
            Self::XLeft => "x-left",
            Self::ZAhead => "z-ahead",
            Self::Static => "static",
        }
    }

    /// The frame of this name.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|frame| frame.word() == word)
    }
}

/// The distances between wheels at these places, which are in the order of the type; metres ahead and to the left of any
/// point. A type whose wheels are on one axle has the default wheelbase.
pub fn geometry_of(drive: Drive, wheels: &[(f64, f64)]) -> Geometry {
    let places = || drive.row().wheels.iter().zip(wheels);
    // Least squares: each wheel is by a share of half of the distance away from the middle.
    let fitted = |wheels: Vec<(f64, f64)>| {
        let sum: f64 = wheels.iter().map(|(share, along)| share * along).sum();
        2.0 * sum / wheels.iter().map(|(share, _)| share * share).sum::<f64>()
    };
    let track = fitted(places().map(|(place, at)| (place.left, at.1)).collect());
    let ahead = places().map(|(place, at)| (place.ahead, at.0)).collect();
    let wheelbase = if drive.row().has_wheelbase() { fitted(ahead) } else { defaults::GEOMETRY.wheelbase };
    Geometry { track, wheelbase }
}

/// A driven wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Its name, which is also that of its joint.
    pub name: String,
    /// Metres.
    pub radius: f64,
    /// True if its joint's axis points to the body's right (−y) instead of the left: then positive rates roll the robot
    /// backwards.
    pub mirrored: bool,
}

impl Wheel {
    /// A wheel whose joint's axis points to the body's left; `radius` in metres.
    pub fn new(name: impl Into<String>, radius: f64) -> Self {
        Self { name: name.into(), radius, mirrored: false }
    }
}

/// A proximity sensor on a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Its name, which is also that of its object.
    pub name: String,
    /// The kind of its measurements.
    pub kind: SensorKind,
    /// Its position, and what it sees from there.
    pub mount: Mount,
}

/// Kinds of proximity sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SensorKind {
    /// Measures the distance of an obstacle.
    Distance,
    /// Detects contact with an obstacle.
    Bumper,
}

/// The outer size of a robot: a rectangle about its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Along the heading, metres.
    pub length: f64,
    /// Across it, metres.
    pub width: f64,
}

impl Body {
    /// The corners in the body's frame: front left, rear left, rear right, front right.
    pub fn corners(&self) -> [(f64, f64); 4] {
        let (x, y) = (self.length / 2.0, self.width / 2.0);
        [(x, y), (-x, y), (-x, -y), (x, -y)]
    }

    /// The radius of a circle around it, metres.
    pub fn reach(&self) -> f64 {
        self.length.hypot(self.width) / 2.0
    }
}

impl Robot {
    /// A robot of default size at the origin, with its sensors in their default positions ([`mounts_by_name`]).
    pub fn new(
        name: impl Into<String>,
        drive: Drive,
        wheels: Vec<Wheel>,
        sensors: Vec<(String, SensorKind)>,
    ) -> Self {
        let body = defaults::body(drive);
        let mounts = mounts_by_name(&sensors, body);
        let sensors = sensors
            .into_iter()
            .zip(mounts)
            .map(|((name, kind), mount)| Sensor { name, kind, mount })
            .collect();
        Self {
            name: name.into(),
            drive,
            wheels,
            sensors,
            start: Pose::default(),
            body,
            geometry: defaults::GEOMETRY,
            lateral_friction: drive.row().lateral_friction,
            motor_acceleration: defaults::MOTOR_ACCELERATION,
            motor_speed: f64::INFINITY,
            motor_gain: defaults::MOTOR_GAIN,
            wheel_width: defaults::WHEEL_WIDTH,
            frame: Frame::default(),
            objects: Objects::new(),
            ros2: Ros2::new(),
        }
    }

    /// The robot's kinematic model; that of a skid-steered one has a wider track, since its wheels scrub.
    ///
    /// # Errors
    /// If wheels and layout do not fit, or if a length is not above zero.
    pub fn model(&self) -> Result<Model, ModelError> {
        let radii: Vec<f64> = self.wheels.iter().map(|wheel| wheel.radius).collect();
        let model = Model::new(self.drive, &radii, self.geometry)?;
        model.with_scrub_factor(scrub_factor(self.drive, self.geometry, self.lateral_friction))
    }

    /// Returns its traction, if its track is wider than the geometry says by a share of it.
    pub fn traction(&self, track_error: f64) -> Traction {
        let geometry = Geometry { track: self.geometry.track * (1.0 + track_error), ..self.geometry };
        Traction::new(self.drive, geometry, self.lateral_friction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    fn wheels(names: &[&str]) -> Vec<Wheel> {
        names.iter().map(|&name| Wheel::new(name, 0.035)).collect()
    }

    #[test]
    fn robots_line_up_to_the_right_of_the_first() {
        let robot = |name: &str| Robot::new(name, Drive::TwoWheel, wheels(&["l", "r"]), vec![]);
        let scene = Scene::empty_floor(vec![robot("a"), robot("b"), robot("c")]);
        let starts: Vec<(f64, f64, f64)> =
            scene.robots.iter().map(|r| (r.start.x, r.start.y, r.start.theta)).collect();
        assert_eq!(starts, [(0.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, -2.0, 0.0)]);
        assert!(scene.robots[0].start.y.is_sign_positive(), "the first robot starts at 0, not at -0");
    }

    #[test]
    fn the_model_has_the_scenes_geometry() {
        let mut robot = Robot::new("a", Drive::FourWheel, wheels(&["a", "b", "c", "d"]), vec![]);
        robot.geometry.track = 0.5;
        assert!(robot.model().is_ok_and(|model| model.geometry() == robot.geometry));
        robot.wheels.pop();
        assert!(robot.model().is_err());
    }
}
