//! What a program means where it leaves something out.

use pydslrep_kinematics::{Drive, motion};
use pydslrep_syntax::ast::{self, Name};

/// The angle of a `turn` without one, in degrees.
pub const DEFAULT_ANGLE: f64 = 90.0;

/// Metres per second at the rim.
pub(crate) fn speed(clause: Option<&ast::SpeedClause>) -> Option<f64> {
    match clause {
        Some(clause) => Some(clause.value.as_ref()?.value? / 100.0),
        None => Some(motion::RIM_SPEED),
    }
}

/// The type of a robot whose wheels are those that `wheel` finds by their names.
pub(crate) fn drive<'a>(
    robot: &ast::Robot,
    wheel: impl Fn(&Name) -> Option<&'a ast::Wheel>,
) -> Option<Drive> {
    let wheels = &robot.wheels.as_ref()?.names;
    let is_mecanum = |name: &Name| wheel(name).is_some_and(|wheel| wheel.mecanum);
    let all_mecanum = |count: usize| wheels.len() == count && wheels.iter().all(is_mecanum);
    match robot.drive.map(|clause| clause.word) {
        Some(word) => word.map(|drive| drive.driven(|| all_mecanum(drive.wheel_count()))),
        None => Drive::inferred(wheels.len(), || all_mecanum(wheels.len())),
    }
}
