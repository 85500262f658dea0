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

/// Returns the number of messages in a client's bytes for each protocol, if they arrive in parts of a size; `None` if
/// they violate the protocol. Public for the tests that look for such bytes.
#[doc(hidden)]
pub fn count_messages(bytes: &[u8], part: usize) -> [Option<usize>; 2] {
    let (mut zmtp, mut legacy) = (zmtp::Receiver::default(), packet::Receiver::default());
    let (mut messages, mut packets) = (Vec::new(), Vec::new());
    let mut parts = bytes.chunks(part);
    let is_zmtp = parts.clone().all(|part| zmtp.receive(part, &mut messages).is_ok());
    let is_legacy = parts.all(|part| legacy.receive(part, &mut packets).is_ok());
    [is_zmtp.then_some(messages.len()), is_legacy.then_some(packets.len())]
}
