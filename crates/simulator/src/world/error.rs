//! Why there is no world.

use std::fmt;

use pydslrep_kinematics::ModelError;

/// The longest step, seconds: within a longer one no controller could correct anything.
pub(super) const MAX_STEP: f64 = 10.0;

/// Why a scene cannot be simulated.
#[derive(Debug, Clone, PartialEq)]
pub enum WorldError {
    /// A robot has no kinematic model.
    Model {
        /// Its name.
        robot: String,
        /// The cause.
        error: ModelError,
    },
    /// A robot's motors have no speed or acceleration.
    Motor {
        /// Its name.
        robot: String,
    },
    /// The step is not positive, or too long.
    Step {
        /// Seconds.
        step: f64,
    },
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model { robot, error } => write!(f, "robot `{robot}` cannot drive: {error}"),
            Self::Motor { robot } => {
                write!(
                    f,
                    "robot `{robot}` cannot drive: the acceleration and speed of its motors must be positive"
                )
            }
            Self::Step { step } => {
                write!(f, "the simulation step must be above 0 and up to {MAX_STEP} s, but it is {step:e} s")
            }
        }
    }
}

impl std::error::Error for WorldError {}
