//! The Python interpreters of this machine.

use std::env;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use pydslrep_script::OLDEST_PYTHON;
use tokio::process::Command;

use super::subprocess::output;
use crate::failure::Failure;

const ASK_LIMIT: Duration = Duration::from_secs(30);

/// Prints version, path, and the modules that it finds among those that are named, one line each.
const QUESTION: &str = include_str!("../../../python/ask.py");

/// The command that installs Python on this system.
const INSTALL_PYTHON: &str = if cfg!(target_os = "macos") {
    "brew install python"
} else if cfg!(windows) {
    "winget install Python.Python.3.13"
} else {
    "sudo apt install python3 python3-venv"
};

/// Returns the advice if there is no suitable Python.
fn install_python() -> String {
    let (major, minor) = OLDEST_PYTHON;
    format!(
        "install Python {major}.{minor} or later, e.g. `{INSTALL_PYTHON}`, or choose one with --python PATH"
    )
}

/// A Python interpreter on this machine.
#[derive(Debug, Clone)]
pub(super) struct Interpreter {
    pub(super) path: PathBuf,
    pub(super) version: String,
    /// Those of the modules that it was asked about which isolated scripts can import.
    pub(super) modules: Vec<String>,
}

/// The chosen interpreter, or else the one of the environment that this command is installed in, or else the one on the
/// `PATH`; and which modules it has.
///
/// # Errors
/// If there is no suitable one.
pub(super) async fn find(chosen: Option<&Path>, modules: &[&str]) -> Result<Interpreter, Failure> {
    let Some(chosen) = chosen else {
        let mut found = Err(Failure::new("no Python on the PATH").help(install_python()));
        let names = ["python3", "python"].map(PathBuf::from);
        for path in beside_this_command().into_iter().chain(names) {
            found = match ask(&path, modules).await {
                Ok(interpreter) => return Ok(interpreter),
                // A Python that cannot be used says more than a missing one.
                Err(Some(failure)) => Err(failure),
                Err(None) => found,
            };
        }
        return found;
    };
    ask(chosen, modules).await.map_err(|failure| {
        let missing = || Failure::new(format!("no Python at {}", chosen.display())).help(install_python());
        failure.unwrap_or_else(missing)
    })
}

/// The interpreter of the environment that this command is installed in, if it is.
fn beside_this_command() -> Option<PathBuf> {
    let name = if cfg!(windows) { "python.exe" } else { "python3" };
    let path = env::current_exe().ok()?.with_file_name(name);
    path.exists().then_some(path)
}

/// Asks an interpreter about itself; `Err(None)` if there is none.
async fn ask(path: &Path, modules: &[&str]) -> Result<Interpreter, Option<Failure>> {
    let mut command = Command::new(path);
    command.args(["-c", QUESTION]).args(modules);
    let output = match output(&mut command, ASK_LIMIT).await {
        Ok(output) => output,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Err(None),
        Err(error) => return Err(Some(unusable(path, &error.to_string()))),
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let mut lines = text.lines();
    let (Some(version), Some(place), true) = (lines.next(), lines.next(), output.status.success()) else {
        return Err(Some(unusable(path, "it is not a Python interpreter")));
    };
    let mut numbers = version.split('.').map_while(|number| number.parse::<u32>().ok());
    let release = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    if release < OLDEST_PYTHON {
        let (major, minor) = OLDEST_PYTHON;
        let reason = format!("it is version {version}, scripts need {major}.{minor} or later");
        return Err(Some(unusable(path, &reason)));
    }
    let modules = lines.next().unwrap_or_default().split_whitespace().map(str::to_owned).collect();
    Ok(Interpreter { path: place.into(), version: version.to_owned(), modules })
}

fn unusable(path: &Path, reason: &str) -> Failure {
    Failure::new(format!("cannot use the Python `{}`: {reason}", path.display())).help(install_python())
}
