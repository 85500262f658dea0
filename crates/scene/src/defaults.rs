//! The defaults of a scene. Those for the motion of robots are in [`pydslrep_kinematics::motion`].

use pydslrep_kinematics::{Drive, Geometry, Pose};

use crate::{Body, SensorKind};

/// Distances between wheels.
pub const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

/// Opening angle of a proximity sensor's cone, 20° in radians.
pub const CONE: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// The greatest acceleration of a wheel's rim, metres per second squared: twice
/// [`pydslrep_kinematics::motion::RIM_ACCELERATION`], which leaves controllers room to correct.
pub const MOTOR_ACCELERATION: f64 = 1.0;

/// The thickness of walls, metres.
pub const WALL_THICKNESS: f64 = 0.1;

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

/// The body of a robot with this wheel layout.
pub fn body(drive: Drive) -> Body {
    match drive {
        Drive::TwoWheel => Body { length: 0.30, width: 0.30 },
        Drive::FourWheel | Drive::FourMecanum => Body { length: 0.36, width: 0.30 },
    }
}

/// The friction of wheels across their rolling direction, as a share of that along it: the same for rubber tyres, next to
/// nothing for the rollers of mecanum wheels.
pub fn lateral_friction(drive: Drive) -> f64 {
    match drive {
        Drive::TwoWheel | Drive::FourWheel => 1.0,
        Drive::FourMecanum => 0.05,
    }
}

/// The range of a sensor of this kind, metres.
pub fn range(kind: SensorKind) -> f64 {
    match kind {
        SensorKind::Distance => 1.0,
        SensorKind::Bumper => 0.05,
    }
}
