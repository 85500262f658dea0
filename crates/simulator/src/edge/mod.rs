//! The network edge: the remote API on TCP ports, and the simulator as something to start and stop.
//!
//! Knows sockets, threads and the clock. Must never know what a call means: that is [`crate::Session`]'s.

mod connection;
mod exchange;
mod simulator;
mod zmtp;

pub use simulator::{Options, Simulator, StartError};
