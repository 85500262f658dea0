//! Child processes of a session: their output, their end, and the folders deleted with them.
//!
//! None outlives its session, however that ends; neither do the pictures they draw.

use std::fs;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use futures::channel::mpsc::{UnboundedReceiver, UnboundedSender, unbounded};
use pydslrep_output::TemporaryFolder;
use tower_lsp::ls_types::ProgressToken;

/// The child processes of a session.
#[derive(Debug, Default)]
pub(crate) struct Children {
    /// The program `pydslrep`.
    pub(crate) command: PathBuf,
    running: Vec<(Option<ProgressToken>, Running)>,
    /// The number of children started.
    count: u64,
    /// Where they draw; deleted with the session.
    pictures: Option<TemporaryFolder>,
}

impl Children {
    /// A new path for a picture.
    pub(crate) fn picture(&mut self, name: &str) -> io::Result<PathBuf> {
        let folder = match self.pictures.take() {
            Some(folder) => folder,
            None => TemporaryFolder::new("pictures-")?,
        };
        let path = folder.path().join(format!("{name}-{}.svg", self.count + 1));
        self.pictures = Some(folder);
        Ok(path)
    }

    /// Starts a child. The folder is deleted when it ends; its output comes out of the receiver.
    pub(crate) fn start(
        &mut self,
        command: &mut Command,
        folder: TemporaryFolder,
    ) -> io::Result<(Running, UnboundedReceiver<ChildEvent>)> {
        let started = Running::start(command, folder)?;
        self.count += 1;
        // A cancelled request does not remove its child.
        self.running.retain(|(_, other)| !other.has_ended());
        self.running.push((None, started.0.clone()));
        Ok(started)
    }

    /// Returns the number of children started.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// The name under which the client can stop a child.
    pub(crate) fn name(&mut self, running: &Running, token: &ProgressToken) {
        for (name, _) in self.running.iter_mut().filter(|(_, other)| other.is(running)) {
            *name = Some(token.clone());
        }
    }

    /// Forgets a child that has ended.
    pub(crate) fn remove(&mut self, running: &Running) {
        self.running.retain(|(_, other)| !other.is(running));
    }

    /// Interrupts a child.
    pub(crate) fn interrupt(&self, token: &ProgressToken) {
        for (_, running) in self.running.iter().filter(|(name, _)| name.as_ref() == Some(token)) {
            running.interrupt();
        }
    }

    /// The session has ended: interrupts all children and deletes their files.
    pub(crate) fn leave(&mut self) {
        for (_, running) in self.running.drain(..) {
            running.interrupt();
            // The thread that follows the child may not get to it.
            let _ = fs::remove_dir_all(&running.folder);
        }
        self.pictures = None;
    }
}

/// A child process that can be interrupted.
#[derive(Debug, Clone)]
pub(crate) struct Running {
    child: Arc<Mutex<Child>>,
    interrupted: Arc<AtomicBool>,
    folder: Arc<Path>,
}

/// An event of a child process.
#[derive(Debug)]
pub(crate) enum ChildEvent {
    /// It printed a line on standard output; the end of the line is part of it.
    Printed(String),
    /// It printed a line on standard error.
    Line(String),
    /// It ended, with this exit code if there is one. This is the last event.
    Ended(Option<i32>),
}

/// Interrupts a child when it is dropped, because the request that waits for it was cancelled. A child that has ended is
/// not affected.
#[derive(Debug)]
pub(crate) struct KillOnDrop(pub(crate) Running);

impl Drop for KillOnDrop {
    fn drop(&mut self) {
        self.0.interrupt();
    }
}

impl Running {
    fn start(
        command: &mut Command,
        folder: TemporaryFolder,
    ) -> io::Result<(Self, UnboundedReceiver<ChildEvent>)> {
        // Its input stays empty; the end of it means that the server has ended, for whatever reason.
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = piped.spawn()?;
        let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
        let child = Arc::new(Mutex::new(child));
        let running = Self { child, interrupted: Arc::default(), folder: folder.path().into() };
        let (sender, events) = unbounded();
        let followed = running.clone();
        let follow = move || {
            follow(&followed, stdout, stderr, &sender);
            drop(folder);
        };
        thread::Builder::new().name("run".to_owned()).spawn(follow)?;
        Ok((running, events))
    }

    fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.child, &other.child)
    }

    fn has_ended(&self) -> bool {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        !matches!(child.try_wait(), Ok(None))
    }

    /// Interrupts it, as Ctrl-C does. Only once, however many reasons there are: a second interrupt would reach it while it
    /// stops its robots.
    pub(crate) fn interrupt(&self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        if matches!(child.try_wait(), Ok(None)) && !self.interrupted.swap(true, Ordering::Relaxed) {
            interrupt(&mut child);
        }
    }
}

/// Passes on a child's output, and its end.
fn follow(
    child: &Running,
    stdout: Option<ChildStdout>,
    stderr: Option<impl Read>,
    sender: &UnboundedSender<ChildEvent>,
) {
    let printed = sender.clone();
    let printing = thread::spawn(move || {
        pass_on(stdout, &printed, |line| ChildEvent::Printed(line.to_owned()));
    });
    pass_on(stderr, sender, |line| ChildEvent::Line(line.trim_end().to_owned()));
    let _ = printing.join();
    await_end(child);
    let status = child.child.lock().unwrap_or_else(PoisonError::into_inner).wait();
    let _ = sender.unbounded_send(ChildEvent::Ended(status.ok().and_then(|status| status.code())));
}

/// Passes on the lines of a stream; those before a failure are still worth showing.
fn pass_on(
    stream: Option<impl Read>,
    sender: &UnboundedSender<ChildEvent>,
    event: impl Fn(&str) -> ChildEvent,
) {
    let mut lines = stream.map(BufReader::new);
    let mut line = Vec::new();
    while lines.as_mut().is_some_and(|lines| lines.read_until(b'\n', &mut line).is_ok_and(|read| read > 0)) {
        let _ = sender.unbounded_send(event(&String::from_utf8_lossy(&line)));
        line.clear();
    }
}

/// Waits without the lock, which is needed to interrupt the child. The process id is not reused before [`Child::wait`],
/// which needs the lock.
#[cfg(unix)]
fn await_end(child: &Running) {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};

    let pid = Pid::from_child(&child.child.lock().unwrap_or_else(PoisonError::into_inner));
    let wait = || waitid(WaitId::Pid(pid), WaitIdOptions::EXITED | WaitIdOptions::NOWAIT);
    while wait().is_err_and(|error| error == rustix::io::Errno::INTR) {}
}

/// Its pipes are closed: it is about to end, so the lock is not held for long.
#[cfg(not(unix))]
fn await_end(_: &Running) {}

#[cfg(unix)]
fn interrupt(child: &mut Child) {
    let pid = rustix::process::Pid::from_child(child);
    // It may have ended in the meantime.
    let _ = rustix::process::kill_process(pid, rustix::process::Signal::INT);
}

/// The end of its input interrupts it, too.
#[cfg(not(unix))]
fn interrupt(child: &mut Child) {
    child.stdin = None;
}
