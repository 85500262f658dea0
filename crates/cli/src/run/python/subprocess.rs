//! Short commands of Python, with a time limit.

use std::ffi::OsStr;
use std::io;
use std::process::{Output, Stdio};
use std::time::Duration;

use tokio::process::Command;
use tokio::time::timeout;

/// Runs a command; the error is its own message.
pub(super) async fn succeed(command: &mut Command, limit: Duration) -> Result<(), String> {
    let output = output(command, limit).await.map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stderr, output.stdout].concat();
    let text = String::from_utf8_lossy(&text);
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    // pip marks the reason; other tools print it last.
    let reason = lines.clone().find(|line| line.starts_with("ERROR:")).or_else(|| lines.next_back());
    let reason = reason.unwrap_or("it exited without output");
    Err(reason.trim_start_matches("ERROR: ").to_owned())
}

/// Runs a command with a time limit; a command that exceeds it is killed.
pub(super) async fn output(command: &mut Command, limit: Duration) -> io::Result<Output> {
    for name in ["PYTHONHOME", "PYTHONPATH", "__PYVENV_LAUNCHER__"].map(OsStr::new) {
        command.env_remove(name);
    }
    command.stdin(Stdio::null()).kill_on_drop(true);
    match timeout(limit, command.output()).await {
        Ok(output) => output,
        Err(_) => {
            Err(io::Error::new(io::ErrorKind::TimedOut, format!("it took longer than {} s", limit.as_secs())))
        }
    }
}
