//! The defaults of a scene. Those for the motion of robots are in [`pydslrep_kinematics::motion`], those of a type of robot in
//! its row ([`Drive::row`]).

use pydslrep_kinematics::{Drive, Geometry, Pose};

use crate::{Body, SensorKind};

/// Distances between wheels.
pub const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

/// Opening angle of a proximity sensor's cone, radians.
pub const CONE: f64 = CONE_DEGREES * std::f64::consts::PI / 180.0;

/// The same in degrees.
pub const CONE_DEGREES: f64 = 20.0;

/// The greatest acceleration of a wheel's rim, metres per second squared: twice
/// [`pydslrep_kinematics::motion::RIM_ACCELERATION`], which leaves controllers room to correct.
pub const MOTOR_ACCELERATION: f64 = 1.0;

/// The thickness of walls, metres.
pub const WALL_THICKNESS: f64 = 0.1;

/// The height of obstacles, metres: above every robot.
pub const HEIGHT: f64 = 0.5;

/// The coefficient of sliding friction between wheels and the floor.
pub const FRICTION: f64 = 0.8;

/// The gain of motors that hold their speed: newtons at the rim for each metre per second that it is off.
pub const MOTOR_GAIN: f64 = 500.0;

/// The width of standard wheels, metres.
pub const WHEEL_WIDTH: f64 = 0.024;

/// The seed of noise.
pub const SEED: u64 = 1;

/// The standard deviation of wheel slip if noise is on, as a share of the distance that a wheel rolls.
pub const WHEEL_SLIP: f64 = 0.02;

/// The standard deviation of a sensor's readings if noise is on, metres.
pub const SENSOR_NOISE: f64 = 0.01;

/// The start of the robot at `index` (from 0) of an environment: (0, −index m, 0°).
pub fn start(index: usize) -> Pose {
    let row = u32::try_from(index).unwrap_or(u32::MAX);
    // Not −row: the first robot starts at 0, not at −0.
    Pose::new(0.0, 0.0 - f64::from(row), 0.0)
}

/// The body of a robot of this type.
pub fn body(drive: Drive) -> Body {
    let (length, width) = drive.row().body;
    Body { length, width }
}

/// The range of a sensor of this kind, metres.
pub fn range(kind: SensorKind) -> f64 {
    match kind {
        SensorKind::Distance => 1.0,
        SensorKind::Bumper => 0.05,
    }
}
