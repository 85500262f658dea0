//! From an analysed environment to the Python script that drives it.
//!
//! Knows [`Environment`], the template `templates/environment.py.j2`, and the parts in `python/pydslrep_parts`: real
//! Python files with tests of their own, which the template puts together, leaving out what a program does not need.
//! Must never read or write files, run Python, or know the text of programs.
//!
//! Names of a program reach a script in three ways only, none of which can become code: as string literals, in
//! comments and the docstring, and as the end of a function's name after `movement_`, where they are plain identifiers.

mod context;
mod file_name;
mod render;

use std::fmt;

use pydslrep_analysis::environment::Environment;

pub use file_name::file_name;

/// What a generated script needs from PyPI: a requirements file for pip, every version fixed.
pub const REQUIREMENTS: &str = include_str!("../python/requirements.txt");

/// The simulator a script is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Target {
    /// `CoppeliaSim` 4.6 or later, by its ZeroMQ remote API.
    #[default]
    CoppeliaSim,
}

/// Why there is no script for an environment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ScriptError {
    /// A movement contains an action that scripts cannot do yet.
    UnsupportedAction {
        /// The action as the program writes it.
        action: String,
        /// The movement's name.
        movement: String,
        /// The file, where it is another one than the environment's.
        file: Option<String>,
        /// 1-based.
        line: u32,
    },
    /// A robot lists one wheel more than once, so it has no joint of its own for each.
    RepeatedWheel {
        /// The robot's name.
        robot: String,
        /// The wheel's name.
        wheel: String,
    },
    /// The template and what it is given do not fit: a mistake in PyDSLRep.
    Template(String),
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnsupportedAction { action, movement, file, line } => {
                write!(f, "`{action}` of movement `{movement}` (")?;
                if let Some(file) = file {
                    write!(f, "{file}, ")?;
                }
                write!(f, "line {line}) is not supported in scripts yet: remove it or leave the movement out")
            }
            Self::RepeatedWheel { robot, wheel } => {
                write!(
                    f,
                    "robot `{robot}` lists wheel `{wheel}` twice: give each of its wheels a name of its own"
                )
            }
            Self::Template(reason) => {
                write!(f, "cannot put the script together, a mistake in PyDSLRep: {reason}")
            }
        }
    }
}

impl std::error::Error for ScriptError {}

/// The Python script that drives `environment`; the same bytes for the same environment.
///
/// # Errors
///
/// When a movement contains `slam`, which scripts cannot do yet, or a robot lists a wheel twice.
pub fn generate(environment: &Environment, target: Target) -> Result<String, ScriptError> {
    match target {
        Target::CoppeliaSim => render::script(&context::Script::new(environment)?),
    }
}
