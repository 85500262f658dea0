//! A client of the legacy remote API: its streams and its synchronous mode.

use std::time::Duration;

use super::message::{Command, Name};

/// The maximum number of streams per client; scripts use a few per robot.
const MAX_STREAMS: usize = 1024;

/// A client; in this protocol, each connection is one.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Client {
    pub(super) streams: Vec<Stream>,
    /// Each step waits for a trigger of this client.
    pub(in super::super) synchronous: bool,
    /// It has triggered the next step.
    pub(in super::super) triggered: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Stream {
    pub(super) name: Name,
    pub(super) period: u16,
    pub(super) payload: Vec<u8>,
    /// The time of its last execution.
    pub(super) last: Duration,
}

impl Client {
    /// After a step: the next one needs another trigger.
    pub(in super::super) fn await_trigger(&mut self) {
        self.triggered = false;
    }

    /// Leaves the synchronous mode, which every stop of the simulation does.
    pub(in super::super) fn leave_synchronous_mode(&mut self) {
        self.synchronous = false;
        self.triggered = false;
    }

    /// Removes the stream of this name; any new command of that name does.
    pub(super) fn remove_stream(&mut self, name: &Name) {
        self.streams.retain(|stream| stream.name != *name);
    }

    pub(super) fn add_stream(&mut self, command: &Command, now: Duration) -> bool {
        let fits = self.streams.len() < MAX_STREAMS;
        if fits {
            let (name, payload) = (command.name.clone(), command.payload.clone());
            self.streams.push(Stream { name, period: command.period, payload, last: now });
        }
        fits
    }
}
