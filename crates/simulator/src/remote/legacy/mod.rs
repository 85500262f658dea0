//! V-REP's legacy remote API (protocol version 11), from a client's message to the reply.
//!
//! A client always sends first, and every few milliseconds, if only an empty message. The commands of a message and the
//! client's streams are executed immediately, and the reply holds their results. The real server executes them in its
//! own time and replies one message later; clients cannot observe the difference.

pub(super) mod client;
mod commands;
mod handler;
mod message;

pub use handler::LegacyResponse;
pub use message::Malformed;

#[cfg(test)]
mod tests;
