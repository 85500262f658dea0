//! The simulator on real ports: clients of both remote APIs, and connections that are none.

#![cfg(feature = "remote")]
// Clippy exempts only functions marked as tests, not their helpers.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod client;
mod legacy;
mod zeromq;
