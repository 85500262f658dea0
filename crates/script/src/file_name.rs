//! The file name of a script.

use pydslrep_analysis::environment::Environment;

/// The file name of the script of `environment`: `<environment>.py`, or `<environment>_env.py` if the former would shadow
/// a module that scripts import or is not a valid file name.
pub fn file_name(environment: &Environment) -> String {
    format!("{}.py", environment.script)
}
