//! Access to the view for requests that read the whole workspace, one file after the other.

use std::future::{Future, poll_fn};
use std::mem::replace;
use std::sync::MutexGuard;
use std::task::Poll;

use futures::channel::oneshot;

use crate::server::Server;
use crate::state::State;
use crate::work::SHORT;

/// Reads the view and lets other messages in between. What it saw of one file may have changed when it comes to the
/// next: an answer is about each file as it was in its turn.
#[derive(Debug)]
pub(crate) struct Reader {
    server: Server,
    /// The number of bytes read since other messages had their turn.
    read: usize,
}

impl Reader {
    pub(crate) fn new(server: Server) -> Self {
        Self { server, read: 0 }
    }

    /// The current state. Never keep it across an `.await`.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.server.state()
    }

    /// To be awaited after each file, with its length in bytes: lets others have their turn now and then.
    pub(crate) async fn has_read(&mut self, bytes: usize) {
        self.read += bytes;
        if self.read >= SHORT {
            self.read = 0;
            yield_now().await;
        }
    }

    /// Resolves when diagnostics may have changed since this call.
    pub(crate) fn diagnostics_change(&self) -> oneshot::Receiver<()> {
        let (sender, change) = oneshot::channel();
        let waiting = &mut self.server.state().waiting;
        waiting.retain(|other| !other.is_canceled());
        waiting.push(sender);
        change
    }
}

/// Lets others have their turn: the message loop the first time, then whatever else the executor runs.
pub(crate) fn yield_now() -> impl Future<Output = ()> {
    let mut is_resumed = false;
    poll_fn(move |context| {
        if replace(&mut is_resumed, true) {
            return Poll::Ready(());
        }
        context.waker().wake_by_ref();
        Poll::Pending
    })
}
