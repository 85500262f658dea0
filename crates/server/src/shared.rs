//! The workspace between the message loop, which changes it, and requests that read it on another thread.
//!
//! A change never waits for a reader to finish: it cancels all of them, and they stop at their next check. Should one
//! take too long to stop, it keeps the workspace as it was, and the change is made in a copy.

use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use pydslrep_analysis::CancellationToken;
use pydslrep_workspace::Workspace;

/// The time that a change waits for readers to stop before it copies the workspace, which takes some milliseconds
/// itself.
const READER_TIMEOUT: Duration = Duration::from_millis(20);

/// A workspace that readers can borrow.
#[derive(Debug)]
pub(crate) struct SharedWorkspace {
    workspace: Arc<Workspace>,
    readers: Arc<Readers>,
    /// The number of changes.
    changes: u64,
    /// For a reader's own copy: ends the loan.
    loan: Option<Loan>,
}

/// Those who read on other threads.
#[derive(Debug, Default)]
struct Readers {
    tokens: Mutex<Vec<CancellationToken>>,
    one_has_stopped: Condvar,
}

/// A reader's turn; it ends when this is dropped.
#[derive(Debug)]
struct Loan {
    readers: Arc<Readers>,
    token: CancellationToken,
}

impl SharedWorkspace {
    pub(crate) fn new(workspace: Workspace) -> Self {
        Self { workspace: Arc::new(workspace), readers: Arc::default(), changes: 0, loan: None }
    }

    /// A number that is another one after each change.
    pub(crate) fn version(&self) -> u64 {
        self.changes
    }

    /// The workspace for a reader, and the token that is cancelled when the workspace changes.
    pub(crate) fn borrow(&self) -> (Self, CancellationToken) {
        let token = CancellationToken::default();
        self.readers.lock().push(token.clone());
        let loan = Loan { readers: Arc::clone(&self.readers), token: token.clone() };
        let borrowed = Self {
            workspace: Arc::clone(&self.workspace),
            readers: Arc::default(),
            changes: self.changes,
            loan: Some(loan),
        };
        (borrowed, token)
    }

    /// Ends a reader's loan.
    pub(crate) fn release(&mut self) {
        if let Some(loan) = self.loan.take() {
            // The workspace first, so that the thread that waits for the end of the loan is its only owner.
            self.workspace = Arc::new(Workspace::new(self.workspace.files()));
            drop(loan);
        }
    }

    /// Returns the workspace for changes that affect no answer, such as the record of what was asked so far.
    pub(crate) fn untracked_mut(&mut self) -> &mut Workspace {
        if Arc::get_mut(&mut self.workspace).is_none() {
            self.readers.stop();
        }
        Arc::make_mut(&mut self.workspace)
    }
}

impl Deref for SharedWorkspace {
    type Target = Workspace;

    fn deref(&self) -> &Workspace {
        &self.workspace
    }
}

impl DerefMut for SharedWorkspace {
    fn deref_mut(&mut self) -> &mut Workspace {
        self.changes += 1;
        self.untracked_mut()
    }
}

impl Drop for SharedWorkspace {
    fn drop(&mut self) {
        self.release();
    }
}

impl Readers {
    fn lock(&self) -> MutexGuard<'_, Vec<CancellationToken>> {
        self.tokens.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has all readers stop, and waits for them a little.
    fn stop(&self) {
        let tokens = self.lock();
        tokens.iter().for_each(CancellationToken::cancel);
        let waited = self.one_has_stopped.wait_timeout_while(tokens, READER_TIMEOUT, |left| !left.is_empty());
        drop(waited);
    }
}

impl Drop for Loan {
    fn drop(&mut self) {
        self.readers.lock().retain(|token| !token.is_same(&self.token));
        self.readers.one_has_stopped.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use pydslrep_files::Disk;
    use ropey::Rope;

    use super::*;

    #[test]
    fn a_change_stops_readers_and_does_not_wait_for_those_that_go_on() {
        let mut shared = SharedWorkspace::new(Workspace::new(Arc::new(Disk)));
        let (borrowed, token) = shared.borrow();
        let before = shared.version();
        let reader = thread::spawn(move || {
            while !token.is_cancelled() {
                thread::yield_now();
            }
            drop(borrowed);
        });
        shared.open("/a.pyr", Rope::from_str("wheel a"));
        reader.join().unwrap();
        assert_ne!(shared.version(), before);
        let (stubborn, _) = shared.borrow();
        shared.open("/b.pyr", Rope::from_str("wheel b"));
        assert!(stubborn.document("/b.pyr").is_none() && shared.document("/b.pyr").is_some());
    }
}
