//! Output: diagnostics for people and programs, tables, failures.

pub(crate) mod github;
pub(crate) mod json;
pub(crate) mod output;
pub(crate) mod place;
pub(crate) mod render;
pub(crate) mod sarif;
pub(crate) mod summary;
