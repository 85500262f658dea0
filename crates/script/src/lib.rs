//! From an analysed environment to the Python script that drives it.
//!
//! Knows [`Environment`] and the page that a script is; what drives robots is the Python package in
//! `python/pydslrep_runtime`, whose files [`runtime`] hands out. Must never read or write files, run Python, or know the
//! text of programs.
//!
//! Names of a program appear in a script as string literals, in comments and the docstring, and as identifiers only
//! where they are plain ones that Python and the script do not use. None of these can become code.

mod identifiers;
mod layout;
mod page;
pub mod runtime;
mod signature;
mod statements;

use std::collections::HashSet;
use std::fmt;

use pydslrep_analysis::environment::{Environment, Robot};

pub use page::used_sensors;
pub use pydslrep_analysis::Target;
pub use signature::{Origin, origin, sha256};

/// The packages from PyPI that a script for `CoppeliaSim` needs, and one for V-REP does not: a requirements file for
/// pip, every version fixed.
pub const REQUIREMENTS: &str = include_str!("../../../python/requirements.txt");

/// The packages that `--odometry` needs in addition.
pub const REQUIREMENTS_SLAM: &str = include_str!("../../../python/requirements-slam.txt");

/// The packages that `--engine mujoco` needs, in place of [`REQUIREMENTS`].
pub const REQUIREMENTS_MUJOCO: &str = include_str!("../../../python/requirements-mujoco.txt");

/// The minimum Python version for scripts; also stated in the documentation.
pub const OLDEST_PYTHON: (u32, u32) = (3, 11);

/// V-REP's client for Python: a script for V-REP needs one of these modules beside it or on Python's path.
pub const VREP_CLIENTS: [&str; 2] = ["sim.py", "vrep.py"];

/// The files that a client needs beside it: its own constants, and one of the libraries.
pub const VREP_CLIENT_PARTS: [&str; 5] =
    ["simConst.py", "vrepConst.py", "remoteApi.so", "remoteApi.dylib", "remoteApi.dll"];

/// Why a script cannot be generated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScriptError {
    /// A robot lists a wheel more than once, so its wheels do not have distinct joints.
    RepeatedWheel {
        /// The robot's name.
        robot: String,
        /// The wheel's name.
        wheel: String,
    },
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::RepeatedWheel { robot, wheel } = self;
        write!(f, "robot `{robot}` lists wheel `{wheel}` twice; use a different wheel for each position")
    }
}

impl std::error::Error for ScriptError {}

/// The Python script that drives `environment`; deterministic. [`origin`] recognises it.
///
/// `program` is the name of the program's file, for the docstring and the hint what to do where the runtime is missing;
/// empty if it has none.
///
/// # Errors
///
/// If a robot lists a wheel twice.
pub fn generate(environment: &Environment, target: Target, program: &str) -> Result<String, ScriptError> {
    environment.robots.iter().try_for_each(check_wheels)?;
    Ok(signature::signed(&page::write(environment, target, program)))
}

fn check_wheels(robot: &Robot) -> Result<(), ScriptError> {
    let mut names = HashSet::new();
    match robot.wheels.iter().find(|wheel| !names.insert(&wheel.name)) {
        Some(wheel) => {
            Err(ScriptError::RepeatedWheel { robot: robot.name.clone(), wheel: wheel.name.clone() })
        }
        None => Ok(()),
    }
}

/// The file name of the script of `environment`: `<environment>.py`, or `<environment>_env.py` if the former would shadow
/// a module that scripts import or is not a valid file name.
pub fn file_name(environment: &Environment) -> String {
    format!("{}.py", environment.script)
}
