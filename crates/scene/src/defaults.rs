//! What a scene is like where nothing else is said. How robots move by default stands in
//! [`pydslrep_kinematics::motion`].

use pydslrep_kinematics::{Drive, Geometry, Pose};

use crate::{Body, SensorKind};

/// Distance between wheels.
pub const GEOMETRY: Geometry = Geometry { track: 0.30, wheelbase: 0.25 };

/// Opening angle of a proximity sensor's cone, 20° in radians.
pub const CONE: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// How fast motors can change the rim speed of a wheel, metres per second squared: twice
/// [`pydslrep_kinematics::motion::RIM_ACCELERATION`], so that a controller which ramps at that rate has room to correct.
pub const MOTOR_ACCELERATION: f64 = 1.0;

/// How thick walls are, metres.
pub const WALL_THICKNESS: f64 = 0.1;

/// What noise is made from.
pub const SEED: u64 = 1;

/// Standard deviation of wheel slip where noise is on, as a share of the way a wheel rolls.
pub const WHEEL_SLIP: f64 = 0.02;

/// Standard deviation of a sensor's reading where noise is on, metres.
pub const SENSOR_NOISE: f64 = 0.01;

/// Where the robot at `index` (from 0) of an environment starts: (0, −index m, 0°).
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

/// What wheels hold across the direction they drive in, as a share of what they hold along it: tyres of rubber as much,
/// the rollers of mecanum wheels next to nothing.
pub fn grip(drive: Drive) -> f64 {
    match drive {
        Drive::TwoWheel | Drive::FourWheel => 1.0,
        Drive::FourMecanum => 0.05,
    }
}

/// How far a sensor of this kind sees, metres.
pub fn range(kind: SensorKind) -> f64 {
    match kind {
        SensorKind::Distance => 1.0,
        SensorKind::Bumper => 0.05,
    }
}
