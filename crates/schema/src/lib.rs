//! One engine for the TOML files of a project. Given a list of keys, it reads and checks a file, says what is at a cursor
//! in a half-typed one, and writes the manual page and the JSON schema.
//!
//! Knows text, TOML and JSON. Must never know which keys there are: each kind of file has its own [`Schema`].

mod cursor;
mod keys;
mod manual;
mod problem;
mod read;
mod suggestions;
mod toml;
mod values;

pub use cursor::{CursorContext, NamePart, Slot, cursor_context, name_parts};
pub use keys::{Item, Key, NAME, Names, Schema, Table, TableKind, key};
pub use problem::{Problem, ProblemKind};
pub use pydslrep_text::Span;
pub use read::{Contents, Section};
pub use suggestions::{did_you_mean, either, suggestions};
pub use values::{Range, Refusal, Values, Word};

pub use self::toml::Value;

/// A name as a TOML key: quoted if it has characters that bare keys cannot have.
pub fn as_key(name: &str) -> String {
    let is_bare = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    if is_bare { name.to_owned() } else { format!("\"{name}\"") }
}
