//! What a script's file is called.

use pydslrep_analysis::environment::Environment;

/// The name of the file for the script of `environment`: `<environment>.py`, or `<environment>_env.py` where the
/// former would hide a module that scripts import, or would not do as a file's name.
pub fn file_name(environment: &Environment) -> String {
    format!("{}.py", environment.script)
}
