//! The network edge: serves the remote APIs on TCP ports, and starts and stops the simulator.
//!
//! Knows sockets, threads and the clock. Must never know the meaning of calls: [`crate::Session`] handles them.

mod connection;
mod packet;
mod shared_session;
mod simulator;
mod zmtp;

/// A protocol violation, which closes the connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ProtocolError(&'static str);

pub use simulator::{Options, Simulator, StartError};
