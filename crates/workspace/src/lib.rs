//! The workspace: which files there are and what is in them.
//!
//! It owns the text of every program, scene and `pydslrep.toml` that matters, whether a caller has it open or it was
//! read from a file, and keeps the database up to date: it follows imports, finds the scenes of environments, and
//! applies settings. The command and the language server both use it, so they see the same workspace.
//!
//! Knows the database, settings, and paths as text. Must never know a disk (files are read through [`FileSystem`]),
//! LSP, or how anything is printed.
//!
//! A document is known by its **key**: the absolute path of its file with `/` between its parts, and before the letter of
//! a drive, or whatever a caller calls a buffer that has no file.

mod chosen;
mod document;
mod file_system;
mod imports;
mod keys;
mod kind;
mod memory;
mod scenes;
mod settings;
mod workspace;

pub use chosen::{NoEnvironment, SceneError};
pub use document::{Document, TextChange};
pub use file_system::{FileSystem, Listing, MAX_BYTES, ReadError, without_byte_order_mark};
pub use keys::{key_of, path_of};
pub use kind::DocumentKind;
pub use memory::MemoryFiles;
pub use workspace::{Changes, Workspace};
