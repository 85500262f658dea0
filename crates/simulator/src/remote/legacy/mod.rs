//! V-REP's legacy remote API (protocol version 11), from a client's message to the reply.
//!
//! A client always speaks first and says something every few milliseconds, if only an empty message. Each message is a
//! pass: its commands and the streams that the client asked for before are executed at once, and the reply has what came
//! of them. The real server executes on its own time and replies a message later; clients cannot tell.

pub(super) mod client;
mod commands;
mod message;
mod pass;

pub use message::Malformed;
pub use pass::Pass;

#[cfg(test)]
mod tests;
