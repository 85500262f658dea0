//! The incremental database.

pub mod environment;
