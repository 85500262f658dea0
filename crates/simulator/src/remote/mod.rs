//! The remote APIs, from request bytes to reply bytes: ZeroMQ's (protocol 2, as CoppeliaSim 4.6 and later speak it), and
//! in `legacy` that of V-REP. Clients of both share one world and may step it together.

mod arguments;
mod calls;
mod info;
mod legacy;
mod message;
mod objects;
mod session;

pub use legacy::{Malformed, Pass};
pub use session::{Answer, Session};

#[cfg(test)]
mod tests;
