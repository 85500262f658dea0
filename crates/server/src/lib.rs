//! The language server.
//!
//! Knows the Language Server Protocol and JSON, and is the only crate that does: it turns positions into offsets, asks
//! `pydslrep-ide` and `pydslrep-script`, and turns their plain answers into messages. Must never have features of its
//! own, nor know the simulator.
//!
//! * `Server` (`server.rs`) lists everything a client can ask for; each entry calls one plain function in
//!   `handlers`, a function of the state and the request's parameters.
//! * [`Session`] runs them. Its one guarantee: every handler runs, in arrival order, up to its first `.await`, before
//!   the next message is looked at. The state is a plain mutex that is never held across an `.await`.
//! * `message_loop` feeds a session from a stream; `process` finds the stream.
//! * `positions` is the only place where lines and columns meet byte offsets.
//!
//! With the feature `process` off there is no runtime, no stdio and no socket: a browser feeds a session itself.

mod capabilities;
#[cfg(feature = "process")]
mod children;
mod chosen;
mod client;
mod direct;
mod documents;
#[cfg(feature = "process")]
mod driven;
#[cfg(feature = "process")]
mod frame;
mod handlers;
mod log;
mod message;
#[cfg(feature = "process")]
mod message_loop;
#[cfg(target_os = "linux")]
#[cfg(feature = "process")]
mod parent;
mod positions;
#[cfg(feature = "process")]
mod process;
mod running;
mod server;
mod session;
mod state;
mod typing;
mod work;
mod workspace;

pub use message::Outbox;
#[cfg(feature = "process")]
pub use process::{run_socket, run_stdio};
pub use session::{Ending, Session};
