//! Scene files, `<environment>.scene.toml`: a text in, a scene and located problems out.

mod keys;
mod manual;
mod read;

pub use keys::{Key, Sort, TABLES, Table, Values};
pub use manual::{json_schema, manual};
pub use pydslrep_text::file_names::SCENE_SUFFIX as ENDING;
pub use read::{problems, read};
