//! A client of the legacy remote API: what it is sent again and again (its streams), and whether time waits for it.

use std::time::Duration;

use super::message::{Command, Name};

/// A client may have so many streams; scripts have some per robot.
const MOST_STREAMS: usize = 1024;

/// A client, which is a connection in this protocol.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Client {
    pub(super) streams: Vec<Stream>,
    /// No step is taken before this client has triggered it.
    pub(super) synchronous: bool,
    /// It has triggered the next one.
    pub(super) triggered: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Stream {
    pub(super) name: Name,
    pub(super) period: u16,
    pub(super) payload: Vec<u8>,
    /// When it was executed last.
    pub(super) last: Duration,
}

impl Client {
    /// Whether steps wait for this client.
    pub(in super::super) fn holds_time(&self) -> bool {
        self.synchronous
    }

    /// Whether it wants the next step.
    pub(in super::super) fn asks(&self) -> bool {
        self.triggered
    }

    /// The step was taken; the next one needs another trigger.
    pub(in super::super) fn await_trigger(&mut self) {
        self.triggered = false;
    }

    /// The simulation was stopped, by whomever: that ends the synchronous mode.
    pub(in super::super) fn release(&mut self) {
        self.synchronous = false;
        self.triggered = false;
    }

    /// Takes a stream of this name out, as anything new about it does.
    pub(super) fn forget(&mut self, name: &Name) {
        self.streams.retain(|stream| stream.name != *name);
    }

    pub(super) fn keep(&mut self, command: &Command, now: Duration) -> bool {
        let fits = self.streams.len() < MOST_STREAMS;
        if fits {
            let (name, payload) = (command.name.clone(), command.payload.clone());
            self.streams.push(Stream { name, period: command.period, payload, last: now });
        }
        fits
    }
}
