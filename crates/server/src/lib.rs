//! The language server.
//!
//! Knows the Language Server Protocol and JSON, and is the only crate that does: it turns positions into offsets, asks
//! `pydslrep-ide` and `pydslrep-script`, and turns their plain answers into messages. Must never have features of its
//! own, nor know the simulator.
//!
//! * `handlers` has the table of all methods, and each handler: a plain function of the state and the parameters.
//! * `dispatch` reads the table, as a layer around the framework's service.
//! * [`Session`] calls that service. Its one guarantee: every handler runs, in arrival order, up to its first `.await`,
//!   before the next message is handled. The state is a plain mutex that is never held across an `.await`.
//! * `message_loop` feeds a session from a stream; `process` finds the stream.
//! * `web` serves the page of the path preview, `page` has its notifications, `handlers::preview` connects them.
//! * `positions` is the only place where lines and columns meet byte offsets.
//!
//! With the feature `process` off there is no runtime, no stdio and no socket: a browser feeds a session itself.

#[cfg(feature = "process")]
mod arguments;
#[cfg(feature = "process")]
mod children;
mod chosen;
mod client;
mod dispatch;
mod documents;
#[cfg(feature = "process")]
mod driven;
mod edits;
#[cfg(feature = "process")]
mod file_preview;
#[cfg(feature = "process")]
mod frame;
mod handlers;
#[cfg(feature = "process")]
mod launch;
mod life_cycle;
mod load;
mod log;
mod message;
#[cfg(feature = "process")]
mod message_loop;
mod noun;
mod page;
#[cfg(target_os = "linux")]
#[cfg(feature = "process")]
mod parent;
mod pending;
mod positions;
#[cfg(feature = "process")]
mod process;
mod reader;
mod readers;
mod runtimes;
mod server;
mod session;
mod shared;
mod state;
mod typing;
mod view;
#[cfg(feature = "process")]
mod web;
mod work;

#[cfg(feature = "process")]
pub use arguments::{Arguments, Unreachable, edition_parser};
#[cfg(feature = "process")]
pub use file_preview::FilePreview;
pub use message::Outbox;
pub use session::{Ending, Session};
