//! The remote APIs, from request bytes to reply bytes: the ZeroMQ one (protocol 2, of CoppeliaSim 4.6 and later), and in
//! `legacy` that of V-REP. Clients of both share one world and may step it together.

mod arguments;
mod building;
mod calls;
mod info;
mod legacy;
mod message;
mod objects;
mod parts;
mod recognition;
mod session;
mod sight;

pub use legacy::{LegacyResponse, Malformed};
pub use session::{Answer, Session};

#[cfg(test)]
mod tests;
