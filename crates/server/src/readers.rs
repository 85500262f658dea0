//! Requests that read a [`View`] on another thread, beside the message loop, which changes the workspace.
//!
//! A change never waits for a reader to finish: it cancels all of them, and they stop at their next check. Should one
//! take too long to stop, it keeps the workspace as it was, and the change is made in a copy.

use std::sync::{Arc, Condvar};
use std::time::Duration;

use pydslrep_analysis::{CancellationToken, cancellable};

use crate::shared::Shared;
use crate::view::View;

/// The time that a change waits for readers to stop before it copies the workspace, which takes some milliseconds
/// itself.
const READER_TIMEOUT: Duration = Duration::from_millis(20);

/// The readers on other threads.
#[derive(Debug, Default)]
pub(crate) struct Readers {
    tokens: Shared<Vec<CancellationToken>>,
    one_has_stopped: Condvar,
}

/// A view for a request that reads it on another thread.
#[derive(Debug)]
pub(crate) struct Loan {
    // Dropped before the turn ends, so that the thread that waits for the end is the only owner of the workspace.
    view: View,
    turn: Turn,
}

/// A reader's turn; it ends when this is dropped.
#[derive(Debug)]
struct Turn {
    readers: Arc<Readers>,
    token: CancellationToken,
}

impl Readers {
    /// Lends a view; its reader is cancelled when the workspace changes.
    pub(crate) fn lend(self: &Arc<Self>, view: View) -> Loan {
        let token = CancellationToken::default();
        self.tokens.lock().push(token.clone());
        Loan { view, turn: Turn { readers: Arc::clone(self), token } }
    }

    /// Has all readers stop, and waits for them a little.
    pub(crate) fn stop(&self) {
        let tokens = self.tokens.lock();
        tokens.iter().for_each(CancellationToken::cancel);
        let waited = self.one_has_stopped.wait_timeout_while(tokens, READER_TIMEOUT, |left| !left.is_empty());
        drop(waited);
    }
}

impl Loan {
    /// Reads the view; `None` if the workspace changes meanwhile, or `token` is cancelled.
    pub(crate) fn read<A>(self, token: CancellationToken, read: impl FnOnce(&View) -> A) -> Option<A> {
        cancellable(&[self.turn.token.clone(), token], || read(&self.view)).ok()
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        self.readers.tokens.lock().retain(|token| !token.is_same(&self.token));
        self.readers.one_has_stopped.notify_all();
    }
}
