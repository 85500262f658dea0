//! The embedded simulator: robots moving in a world, and the remote API by which scripts drive them.
//!
//! Knows `kinematics` and `scene`. Must never know the language, and below [`edge`] neither sockets nor threads
//! nor clocks nor files: [`World`] and [`Session`] are plain state machines that get bytes and times handed in,
//! so the same requests always give the same trace, bit for bit.
//!
//! * [`World`]: robots with wheel joints, stepped in simulation time.
//! * [`Session`]: the calls of both remote APIs on a world, for several clients that may step it in lockstep.
//! * [`edge`] (feature `remote`): the same on TCP ports, and [`Simulator`] to embed it all.

#[cfg(feature = "remote")]
pub mod edge;
mod remote;
mod sightings;
mod world;

#[cfg(feature = "remote")]
pub use edge::{Options, Simulator, StartError};
pub use remote::{Answer, Malformed, Pass, Session};
pub use sightings::Sightings;
pub use world::{World, WorldError};
