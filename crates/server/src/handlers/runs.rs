//! The commands `pydslrep.run` and `pydslrep.previewPath`: the program `pydslrep` as a child process, which drives or
//! plans what the editor shows, saved or not, and draws a picture of it.
//!
//! What is open is written into a folder of its own together with what it imports, as it is in the editor at that
//! moment. The person's files stay as they are.

use std::fs;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use futures::channel::mpsc::{UnboundedReceiver, UnboundedSender, unbounded};
use pydslrep_analysis::FileId;
use pydslrep_files::FILE_NAME;
use tempfile::TempDir;
use tower_lsp::jsonrpc::{Error, ErrorCode, Result};

use crate::handlers::scripts::{ScriptOf, environment, failure};
use crate::state::State;

/// Drives an environment.
pub(crate) const RUN: &str = "pydslrep.run";

/// Draws an environment's planned path.
pub(crate) const PREVIEW_PATH: &str = "pydslrep.previewPath";

/// What is to be started.
#[derive(Debug)]
pub(crate) struct Job {
    /// The program and what it imports; goes with the job.
    folder: TempDir,
    program: PathBuf,
    /// Where the picture goes; stays.
    picture: PathBuf,
    environment: String,
    subcommand: &'static str,
}

/// A child process that may be asked to end.
#[derive(Debug, Clone)]
pub(crate) struct Running(Arc<Mutex<Child>>);

/// What a child process has to say.
#[derive(Debug)]
pub(crate) enum News {
    /// A line on its way.
    Line(String),
    /// It ended: its exit code, if it has one, and all it printed on standard output.
    Ended(Option<i32>, String),
}

/// Writes down what is to be run.
///
/// # Errors
///
/// If the environment is not there or has errors, or the files cannot be written.
pub(crate) fn prepare(state: &State, which: &ScriptOf, command: &str) -> Result<Job> {
    let id = environment(state, which)?;
    state.database.environment(id).map_err(|blocked| failure(blocked.reason()))?;
    let (subcommand, what) = if command == RUN { ("run", "driven") } else { ("plan", "planned") };
    let unwritten = |error: io::Error| failure(format!("cannot write what is to be run: {error}"));
    let folder = tempfile::Builder::new().prefix("pydslrep-").tempdir().map_err(unwritten)?;
    let program = write_programs(state, which, folder.path())?;
    let picture = tempfile::Builder::new()
        .prefix(&format!("{}-{what}-", which.environment))
        .suffix(".svg")
        .tempfile()
        .and_then(|file| Ok(file.keep()?.1))
        .map_err(unwritten)?;
    Ok(Job { folder, program, picture, environment: which.environment.clone(), subcommand })
}

/// The open program and what it imports, in the places that they have to each other.
fn write_programs(state: &State, which: &ScriptOf, folder: &Path) -> Result<PathBuf> {
    let unopened = || failure(format!("`{}` is not open in the editor", which.uri.as_str()));
    let (document, file) = state.analysed(&which.uri).ok_or_else(unopened)?;
    let database = &state.database;
    let own = database.path(file);
    let mut needed = vec![file];
    let mut next = 0;
    while let Some(importer) = needed.get(next).copied() {
        let imported = database.imported_files(importer);
        let new: Vec<FileId> = imported.filter(|file| !needed.contains(file)).collect();
        needed.extend(new);
        next += 1;
    }
    let files: Vec<(&str, String)> = needed
        .into_iter()
        .filter_map(|file| Some((database.path(file), database.text(file)?.to_string())))
        .collect();
    let common = common_folder(&files.iter().map(|(path, _)| *path).collect::<Vec<_>>());
    let place = |path: &str| {
        if !path.starts_with('/') {
            // What was never saved has an address and no path, and imports nothing.
            return folder.join("program.pyr");
        }
        // Not even the letter of a drive may lead out of the folder.
        let relative = path.strip_prefix(common).unwrap_or(path).replace(':', "_");
        folder.join(relative.trim_start_matches('/'))
    };
    for (path, text) in &files {
        write(&place(path), text)?;
    }
    // Imports may go as far up as this file stands.
    let target = document.settings.target.word();
    write(&folder.join(FILE_NAME), &format!("target = \"{target}\"\n"))?;
    Ok(place(own))
}

fn write(path: &Path, text: &str) -> Result<()> {
    let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, text));
    written.map_err(|error| failure(format!("cannot write {}: {error}", path.display())))
}

/// What all paths begin with, up to a `/`.
fn common_folder<'a>(paths: &[&'a str]) -> &'a str {
    let Some(first) = paths.first() else { return "" };
    let shared = |path: &&str| first.bytes().zip(path.bytes()).take_while(|(a, b)| a == b).count();
    let length = paths.iter().map(shared).min().unwrap_or(0);
    first.get(..length).and_then(|common| common.rfind('/')).map_or("", |slash| &first[..=slash])
}

impl Job {
    /// Where the picture is once it is drawn.
    pub(crate) fn picture(&self) -> &Path {
        &self.picture
    }

    /// Starts it; what it says comes out of the receiver.
    ///
    /// # Errors
    ///
    /// If there is no program `pydslrep`.
    pub(crate) fn start(self) -> Result<(Running, UnboundedReceiver<News>)> {
        let program = executable();
        let mut child = Command::new(&program)
            .arg(self.subcommand)
            .arg(&self.program)
            .args(["--environment", &self.environment, "--picture"])
            .arg(&self.picture)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| {
                let name = program.display();
                failure(format!(
                    "cannot start {name}: {error}; put `pydslrep` beside `pydslrep-lsp` or on the PATH"
                ))
            })?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let running = Running(Arc::new(Mutex::new(child)));
        let (sender, news) = unbounded();
        let (child, folder) = (running.clone(), self.folder);
        let follow = move || {
            follow(&child, stdout, stderr, &sender);
            drop(folder);
        };
        let started = thread::Builder::new().name("run".to_owned()).spawn(follow);
        started.map_err(|error| failure(format!("cannot follow a run: {error}")))?;
        Ok((running, news))
    }
}

/// Passes on what a child says, and its end.
fn follow(
    child: &Running,
    stdout: Option<ChildStdout>,
    stderr: Option<impl Read>,
    sender: &UnboundedSender<News>,
) {
    let printed = thread::spawn(move || {
        let mut printed = Vec::new();
        // What was printed up to a failure is still worth showing.
        let _ = stdout.map(|mut stdout| stdout.read_to_end(&mut printed));
        String::from_utf8_lossy(&printed).into_owned()
    });
    let mut lines = stderr.map(BufReader::new);
    let mut line = Vec::new();
    while lines.as_mut().is_some_and(|lines| lines.read_until(b'\n', &mut line).is_ok_and(|read| read > 0)) {
        let _ = sender.unbounded_send(News::Line(String::from_utf8_lossy(&line).trim_end().to_owned()));
        line.clear();
    }
    let printed = printed.join().unwrap_or_default();
    await_end(child);
    let status = child.0.lock().unwrap_or_else(PoisonError::into_inner).wait();
    let _ = sender.unbounded_send(News::Ended(status.ok().and_then(|status| status.code()), printed));
}

/// Interrupts a child when it is let go of, which does nothing to one that has ended: whoever waited may be cancelled.
#[derive(Debug)]
pub(crate) struct Leash(pub(crate) Running);

impl Drop for Leash {
    fn drop(&mut self) {
        self.0.interrupt();
    }
}

impl Running {
    /// Asks it to end, as Ctrl-C does.
    pub(crate) fn interrupt(&self) {
        let mut child = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if matches!(child.try_wait(), Ok(None)) {
            interrupt(&mut child);
        }
    }
}

/// Waits without the lock, which whoever wants to interrupt the child needs; its number stays its own until the one who
/// has the lock takes note of its end.
#[cfg(unix)]
fn await_end(child: &Running) {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};

    let pid = Pid::from_child(&child.0.lock().unwrap_or_else(PoisonError::into_inner));
    let wait = || waitid(WaitId::Pid(pid), WaitIdOptions::EXITED | WaitIdOptions::NOWAIT);
    while wait().is_err_and(|error| error == rustix::io::Errno::INTR) {}
}

/// Its pipes are closed: it is about to end, and nobody waits long for the lock.
#[cfg(not(unix))]
fn await_end(_: &Running) {}

#[cfg(unix)]
fn interrupt(child: &mut Child) {
    let pid = rustix::process::Pid::from_child(child);
    // It may have ended by itself meanwhile.
    let _ = rustix::process::kill_process(pid, rustix::process::Signal::INT);
}

#[cfg(not(unix))]
fn interrupt(child: &mut Child) {
    let _ = child.kill();
}

/// The program `pydslrep`: beside this one, else wherever the system finds it.
fn executable() -> PathBuf {
    let name = format!("pydslrep{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name(&name));
    beside.filter(|path| path.is_file()).unwrap_or_else(|| name.into())
}

/// The error for a run that did not come to its end.
pub(crate) fn ended_badly(code: Option<i32>, said: &[String]) -> Error {
    match code {
        Some(130) => {
            Error { code: ErrorCode::RequestCancelled, message: "the run was cancelled".into(), data: None }
        }
        _ if said.is_empty() => failure("pydslrep ended without a word".to_owned()),
        _ => failure(said.join("\n")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_keep_their_places_to_each_other() {
        assert_eq!(common_folder(&["/a/b/c.pyr", "/a/bc/d.pyr"]), "/a/");
        assert_eq!(common_folder(&["/a/b/c.pyr"]), "/a/b/");
        assert_eq!(common_folder(&["untitled:1"]), "");
    }
}
