//! What a script's file is called.

use pydslrep_analysis::environment::Environment;

/// Modules of Python 3.10 to 3.14, one per line.
const STANDARD_MODULES: &str = include_str!("standard_modules.txt");

/// Modules that the script's client imports, or looks for, beside the standard ones.
const CLIENT_MODULES: [&str; 6] =
    ["cbor", "cbor2", "cffi", "coppeliasim_zmqremoteapi_client", "numpy", "zmq"];

/// The name of the file for the script of `environment`: `<environment>.py`, or `<environment>_env.py` where the
/// former would hide a module that the script imports, or cannot be a file's name on Windows.
pub fn file_name(environment: &Environment) -> String {
    let name = &environment.name;
    if hides_a_module(name) || is_reserved_on_windows(name) {
        format!("{name}_env.py")
    } else {
        format!("{name}.py")
    }
}

fn hides_a_module(name: &str) -> bool {
    STANDARD_MODULES.lines().any(|module| module == name) || CLIENT_MODULES.contains(&name)
}

fn is_reserved_on_windows(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let is_port = |prefix| {
        name.strip_prefix(prefix).is_some_and(|n| matches!(n.as_bytes(), [digit] if digit.is_ascii_digit()))
    };
    ["con", "prn", "aux", "nul"].contains(&name.as_str()) || is_port("com") || is_port("lpt")
}
