//! The embedded simulator: robots that move in a world, and the remote APIs that scripts drive them with.
//!
//! Knows `kinematics` and `scene`. Must never know the language; outside [`edge`], also no sockets, threads, clocks or
//! files: [`World`] and [`Session`] are state machines that receive bytes and times, so the same requests always give
//! the same trace, bit for bit.
//!
//! * [`World`]: robots with wheel joints, stepped in simulation time.
//! * [`Session`]: the calls of both remote APIs on a world, for several clients that may step it in lockstep.
//! * [`Server`]: how the servers of `CoppeliaSim` treat clients, for tests of scripts that are meant for them.
//! * [`edge`] (feature `remote`): serves sessions on TCP ports; [`Simulator`] embeds it.

#[cfg(feature = "remote")]
pub mod edge;
mod remote;
mod server;
mod sightings;
mod world;

#[cfg(feature = "remote")]
pub use edge::{Options, Simulator, StartError};
pub use remote::{Answer, LegacyResponse, Malformed, Session};
pub use server::Server;
pub use sightings::Sightings;
pub use world::{Strike, World, WorldError};
