//! The output of the command.
//!
//! [`output`] writes to the terminal; [`render`] draws diagnostics for people, [`json`], [`github`] and [`sarif`] write
//! them for programs.

pub(crate) mod github;
pub(crate) mod json;
pub(crate) mod numbers;
pub(crate) mod output;
pub(crate) mod place;
pub(crate) mod render;
pub(crate) mod sarif;
pub(crate) mod summary;
