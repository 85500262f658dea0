//! V-REP's Python client, which no package registry has: makes it available to a script.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use pydslrep_script::{VREP_CLIENT_PARTS, VREP_CLIENTS};
use tokio::process::Command;
use tokio::time::timeout;

use crate::failure::Failure;

/// Exits with 0 if Python finds a client itself. `-c` alone would also search the current folder; a script does not.
const QUESTION: &str = "import sys; sys.path.pop(0); from importlib.util import find_spec; \
    sys.exit(not any(map(find_spec, ('sim', 'vrep'))))";

const ASK_LIMIT: Duration = Duration::from_secs(30);

/// Where V-REP and CoppeliaSim keep the files.
const SOURCES: &str = "in CoppeliaSim's folder programming/legacyRemoteApi/remoteApiBindings (before 4.3: \
    programming/remoteApiBindings) they are in python/python and, by system, in lib/lib; in V-REP 3 the first two are \
    called vrep.py and vrepConst.py";

/// Makes the client available to a script in `folder`: copies it from `home`, the program's folder, or else checks that
/// Python has one on its path.
///
/// # Errors
/// If there is none; the help says what to copy from where.
pub(crate) async fn prepare(python: &Path, home: &Path, folder: &Path) -> Result<(), Failure> {
    if VREP_CLIENTS.iter().any(|name| home.join(name).is_file()) {
        for name in VREP_CLIENTS.iter().chain(&VREP_CLIENT_PARTS) {
            let (from, to) = (home.join(name), folder.join(name));
            if from.is_file() {
                fs::copy(&from, &to).map_err(|error| Failure::unwritten(&to, &error))?;
            }
        }
        return Ok(());
    }
    if has_one(python).await {
        return Ok(());
    }
    let library = if cfg!(windows) {
        "remoteApi.dll"
    } else if cfg!(target_os = "macos") {
        "remoteApi.dylib"
    } else {
        "remoteApi.so"
    };
    let missing = "V-REP's client for Python is neither beside the program nor on Python's path";
    Err(Failure::new(missing)
        .help(format!("copy sim.py, simConst.py and {library} to the program's folder: {SOURCES}")))
}

async fn has_one(python: &Path) -> bool {
    let mut command = Command::new(python);
    command.args(["-c", QUESTION]).kill_on_drop(true);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let status = timeout(ASK_LIMIT, command.status()).await;
    status.ok().and_then(Result::ok).is_some_and(|status| status.success())
}
