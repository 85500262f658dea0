//! What the TOML files of a project have in common: values with the places they stand at, problems, and words for a
//! text that is no TOML.
//!
//! Knows texts and JSON values. Must never know which keys there are: that is for those who read a file to say.

mod outline;
mod problem;
mod value;

pub use outline::{Named, Place, Slot, names, place_at};
pub use problem::{Problem, ProblemKind};
pub use pydslrep_text::{Span, closest};
pub use value::{Entry, Node, Value, from_json, parse, span};

/// A name as it stands in a key: in quotes where it has other letters than keys may have without.
pub fn as_key(name: &str) -> String {
    let is_bare = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    if is_bare { name.to_owned() } else { format!("\"{name}\"") }
}

/// The help for a word that is nearly another one.
pub fn did_you_mean(near: &str) -> String {
    format!("did you mean `{near}`?")
}
