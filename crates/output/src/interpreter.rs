//! Asks the user's Python whether it has the package that scripts import.

use std::env;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use pydslrep_script::runtime::NAME;

const QUESTION: &str = include_str!("../python/has_runtime.py");

/// A Python that takes longer counts as one without the package: writing a folder too many does no harm.
const LIMIT: Duration = Duration::from_secs(3);

/// More than any answer, bytes.
const MAX_ANSWER: u64 = 1 << 16;

/// Returns whether the Python that runs the user's scripts has the package installed: that of the active virtual
/// environment, else the first one on the `PATH`. Takes some 50 ms, and never longer than [`LIMIT`] for each of three.
///
/// Never a Python from a project's own folder: a user who opens a folder has not decided to run programs in it.
pub fn has_runtime() -> bool {
    let mut found = interpreters().into_iter().filter_map(|python| ask(Command::new(python)));
    // The first one that answers.
    found.next().unwrap_or(false)
}

fn interpreters() -> Vec<PathBuf> {
    let place = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    let active = env::var_os("VIRTUAL_ENV").map(PathBuf::from).filter(|home| home.is_absolute());
    let active = active.map(|home| home.join(place));
    active.into_iter().chain(["python3", "python"].map(PathBuf::from)).collect()
}

/// The answer of one Python; `None` if there is none.
fn ask(mut python: Command) -> Option<bool> {
    // Isolated: what lies in the current folder is not run.
    python.args(["-I", "-c", QUESTION, NAME]);
    python.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = python.spawn().ok()?;
    let answer = answer(&mut child);
    // It has ended, or is too slow.
    let _ = child.kill();
    let _ = child.wait();
    match answer?.lines().next_back() {
        Some("True") => Some(true),
        Some("False") => Some(false),
        _ => None,
    }
}

fn answer(child: &mut Child) -> Option<String> {
    let mut stdout = child.stdout.take()?.take(MAX_ANSWER);
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // Text read before an error is not an answer, and neither is an empty one.
        let _ = stdout.read_to_end(&mut bytes);
        let _ = sender.send(String::from_utf8_lossy(&bytes).into_owned());
    });
    receiver.recv_timeout(LIMIT).ok()
}
