//! The ZeroMQ remote API (protocol 2, as CoppeliaSim 4.6 and later speak it), from request bytes to reply bytes.

mod arguments;
mod calls;
mod info;
mod objects;
mod session;

pub use session::{Answer, Session};

#[cfg(test)]
mod tests;
