//! What the TOML files of a project have in common: values with the places they stand at, problems, and words for a
//! text that is no TOML.
//!
//! Knows texts and JSON values. Must never know which keys there are: that is for those who read a file to say.

mod problem;
mod value;

pub use problem::{Problem, ProblemKind};
pub use pydslrep_syntax::{Span, closest};
pub use value::{Entry, Node, Value, from_json, parse, span};

/// The help for a word that is nearly another one.
pub fn did_you_mean(near: &str) -> String {
    format!("did you mean `{near}`?")
}
