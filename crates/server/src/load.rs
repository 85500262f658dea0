//! The number of bytes of messages that wait to be written: a client that does not read costs a bounded amount of
//! memory.

use std::future::{Future, poll_fn};
#[cfg(feature = "process")]
use std::sync::Condvar;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};

/// The bytes that wait to be written; clones share it. The default has no limit, for clients that take messages at
/// once.
#[derive(Debug, Clone, Default)]
pub(crate) struct Load(Option<Arc<Shared>>);

#[derive(Debug)]
struct Shared {
    /// The bytes from which on requests wait; answers in progress are added nevertheless.
    limit: usize,
    state: Mutex<State>,
    #[cfg(feature = "process")]
    has_room: Condvar,
}

#[derive(Debug, Default)]
struct State {
    waiting_bytes: usize,
    /// The largest number of them so far.
    peak_bytes: usize,
    /// Requests that continue when there is room.
    wakers: Vec<Waker>,
    /// Nobody reads any more, or the session is about to end: nothing waits for room.
    is_over: bool,
}

impl Load {
    fn lock(&self) -> Option<(&Shared, MutexGuard<'_, State>)> {
        let shared = self.0.as_deref()?;
        Some((shared, shared.state.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    /// A message waits.
    pub(crate) fn add(&self, bytes: usize) {
        if let Some((_, mut state)) = self.lock() {
            state.waiting_bytes += bytes;
            state.peak_bytes = state.peak_bytes.max(state.waiting_bytes);
        }
    }

    /// Resolves once there is room for another answer.
    pub(crate) fn room(&self) -> impl Future<Output = ()> + use<> {
        let load = self.clone();
        poll_fn(move |context| match load.lock() {
            Some((shared, mut state)) if shared.is_full(&state) => {
                state.wakers.push(context.waker().clone());
                Poll::Pending
            }
            _ => Poll::Ready(()),
        })
    }
}

#[cfg(feature = "process")]
impl Load {
    /// A load of about so many bytes.
    pub(crate) fn new(limit: usize) -> Self {
        let shared = Shared { limit, state: Mutex::default(), has_room: Condvar::new() };
        Self(Some(Arc::new(shared)))
    }

    /// Returns whether there is no room for another answer.
    pub(crate) fn is_full(&self) -> bool {
        self.lock().is_some_and(|(shared, state)| shared.is_full(&state))
    }

    /// Returns whether nobody reads any more.
    pub(crate) fn is_over(&self) -> bool {
        self.lock().is_some_and(|(_, state)| state.is_over)
    }

    /// Waits until there is room; false if the session ends instead.
    pub(crate) fn wait_for_room(&self) -> bool {
        let Some((shared, mut state)) = self.lock() else { return true };
        while shared.is_full(&state) {
            state = shared.has_room.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        !state.is_over || state.waiting_bytes < shared.limit
    }

    /// A message was written.
    pub(crate) fn remove(&self, bytes: usize) {
        self.change(|state| state.waiting_bytes = state.waiting_bytes.saturating_sub(bytes));
    }

    /// From now on nothing waits for room.
    pub(crate) fn end(&self) {
        self.change(|state| state.is_over = true);
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let Some((shared, mut state)) = self.lock() else { return };
        change(&mut state);
        if shared.is_full(&state) {
            return;
        }
        let wakers = std::mem::take(&mut state.wakers);
        drop(state);
        shared.has_room.notify_all();
        wakers.into_iter().for_each(Waker::wake);
    }

    /// Returns the largest number of bytes that have waited.
    #[cfg(test)]
    pub(crate) fn peak_bytes(&self) -> usize {
        self.lock().map_or(0, |(_, state)| state.peak_bytes)
    }
}

impl Shared {
    fn is_full(&self, state: &State) -> bool {
        state.waiting_bytes >= self.limit && !state.is_over
    }
}
