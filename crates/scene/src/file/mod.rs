//! Scene files, `<environment>.scene.toml`: a text in, a scene and located problems out.

mod keys;
mod manual;
mod read;

pub use keys::{Key, Sort, TABLES, Table, Values};
pub use manual::{json_schema, manual};
pub use read::{problems, read};

/// What the name of a scene file ends in, behind that of its environment.
pub const ENDING: &str = ".scene.toml";
