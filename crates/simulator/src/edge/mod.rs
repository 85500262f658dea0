//! The network edge: the remote APIs on TCP ports, and the simulator as something to start and stop.
//!
//! Knows sockets, threads and the clock. Must never know what a call means: that is [`crate::Session`]'s.

mod connection;
mod exchange;
mod packet;
mod simulator;
mod zmtp;

/// Why a connection is given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Violation(&'static str);

pub use simulator::{Options, Simulator, StartError};
