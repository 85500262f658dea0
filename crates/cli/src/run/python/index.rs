//! The package index that pip uses.

use std::io;
use std::time::Duration;

use tokio::process::Command;

use super::Packages;
use super::interpreter::Interpreter;
use super::subprocess::output;
use crate::failure::Failure;

/// Long enough for a package index to answer, short enough to wait for.
const INDEX_LIMIT: Duration = Duration::from_millis(2500);

/// Asks whether the package index can be reached; if not, exits with [`ABSENT`] and prints why.
const ASK_INDEX: &str = include_str!("../../../python/ask_index.py");
const ABSENT: i32 = 3;

/// Checks that the package index can be reached before anything is created: pip itself retries for minutes.
pub(super) async fn check_index(base: &Interpreter, packages: Packages) -> Result<(), Failure> {
    let mut command = Command::new(&base.path);
    command.args(["-I", "-c", ASK_INDEX]);
    match output(&mut command, INDEX_LIMIT).await {
        Ok(output) if output.status.code() == Some(ABSENT) => {
            Err(uninstalled(packages, String::from_utf8_lossy(&output.stdout).trim()))
        }
        Err(error) if error.kind() == io::ErrorKind::TimedOut => {
            Err(uninstalled(packages, "the package index does not answer"))
        }
        // pip reports anything else.
        _ => Ok(()),
    }
}

/// The packages could not be installed.
pub(super) fn uninstalled(packages: Packages, reason: &str) -> Failure {
    Failure::new(format!("cannot install {}: {reason}", packages.names)).help(format!(
        "{} needs network access to PyPI; behind a proxy or with a mirror, set HTTPS_PROXY or PIP_INDEX_URL",
        packages.first_run
    ))
}
