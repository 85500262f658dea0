//! Messages of a client that writes faster than it reads.
//!
//! While too much waits to be written, requests are not answered but kept, which takes little: else each would become an
//! answer many times its size. They are still read, by a thread of their own, because a client may write all of its
//! requests before it reads any answer; and so that what must not wait is noticed: the end, and cancellations.

use std::collections::VecDeque;
use std::io::{self, Read};
use std::sync::{Arc, Condvar, PoisonError};
use std::thread;

use super::{contains, handle, is_end, report_end};
use crate::frame::{Frame, FrameReader};
use crate::load::Load;
use crate::pending::PendingRequests;
use crate::session::{Ending, Session};
use crate::shared::Shared;

/// The most bytes of messages that are kept; then the client has to wait until it has read something.
const MAX_BYTES: usize = 64 << 20;

/// A frame read from the client; `None` is the end.
type Input = io::Result<Option<Frame>>;

/// Messages that were read and not handled yet.
#[derive(Default)]
struct Backlog {
    state: Shared<State>,
    has_changed: Condvar,
}

#[derive(Default)]
struct State {
    inputs: VecDeque<Input>,
    bytes: usize,
}

/// Goes on reading and handling messages, on two threads.
pub(super) fn read_all(
    session: &mut Session,
    frames: FrameReader<impl Read + Send + 'static>,
    load: &Load,
) -> io::Result<Ending> {
    let backlog = Arc::new(Backlog::default());
    let (shared, pending, its_load) = (Arc::clone(&backlog), session.pending(), load.clone());
    thread::Builder::new()
        .name("reader".to_owned())
        .spawn(move || shared.fill(frames, &pending, &its_load))?;
    loop {
        let input = backlog.next(session);
        // When the session ends while nobody reads, only its end is handled.
        let is_wanted = load.wait_for_room() || matches!(&input, Ok(Some(frame)) if is_end(frame));
        match input {
            Ok(Some(_)) if !is_wanted => {}
            Ok(Some(frame)) => {
                if let Some(ending) = handle(session, frame) {
                    return Ok(ending);
                }
            }
            end => return Ok(report_end(end)),
        }
    }
}

impl Backlog {
    /// Reads to the end of the input.
    fn fill(&self, mut frames: FrameReader<impl Read>, pending: &PendingRequests, load: &Load) {
        loop {
            let input = frames.next();
            let is_last = !matches!(input, Ok(Some(_)));
            let mut size = 0;
            if let Ok(Some(frame)) = &input
                && let Frame::Body(body) = frame
            {
                cancel(body, pending);
                size = body.len();
                if is_end(frame) && contains(body, b"\"exit\"") {
                    load.end();
                }
            }
            if is_last {
                load.end();
            }
            self.add(input, size);
            if is_last {
                return;
            }
        }
    }

    /// Adds a message as soon as there is room for it.
    fn add(&self, input: Input, bytes: usize) {
        let mut state = self.state.lock();
        while state.bytes > MAX_BYTES {
            state = self.has_changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.bytes += bytes;
        state.inputs.push_back(input);
        drop(state);
        self.has_changed.notify_all();
    }

    /// The next message; when there is none yet, the session publishes diagnostics first.
    fn next(&self, session: &Session) -> Input {
        let mut state = self.state.lock();
        if state.inputs.is_empty() {
            drop(state);
            session.flush_diagnostics();
            state = self.state.lock();
        }
        loop {
            if let Some(input) = state.inputs.pop_front() {
                if let Ok(Some(Frame::Body(body))) = &input {
                    state.bytes -= body.len();
                }
                drop(state);
                self.has_changed.notify_all();
                return input;
            }
            state = self.has_changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Cancels the request that a message is about, if it is a cancellation.
fn cancel(body: &[u8], pending: &PendingRequests) {
    if !contains(body, b"$/cancelRequest") {
        return;
    }
    let message: serde_json::Value = serde_json::from_slice(body).unwrap_or_default();
    if message["method"] == "$/cancelRequest"
        && let Ok(id) = serde_json::from_value(message["params"]["id"].clone())
    {
        pending.cancel(&id);
    }
}
