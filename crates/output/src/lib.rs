//! Writes generated files: scripts, next to them `pydslrep_runtime`, the Python package that they import, and the results
//! of runs.
//!
//! Knows files, the user's Python, and the files of the package. Must never know programs or an editor's protocol, or
//! print anything.
//!
//! Two rules apply to everything here. Nothing is replaced but what this program made and nobody changed ([`Kind`] tells
//! how it is recognised). And a file or a package is written under a temporary name first, so that no crash leaves a part
//! of it under its own.

mod error;
mod growing;
mod interpreter;
mod kind;
mod package;
mod place;
mod runtime;
mod script;
mod temporary;
mod whole;

use std::fs::File;
use std::path::Path;

pub use error::WriteError;
pub use growing::GrowingFile;
pub use interpreter::has_runtime;
pub use kind::Kind;
pub use place::{check_inside, check_outputs};
pub use runtime::{Kept, RuntimeFolder, provide_runtime, write_runtime};
pub use script::{Changed, check_script, write_script};
pub use temporary::TemporaryFolder;
pub use whole::{write_file, write_new_folder};

/// Writes a file that is not a script.
///
/// # Errors
/// If the path holds anything but an older one of its kind, or cannot be written.
pub fn write_output(path: &Path, kind: Kind, content: &[u8]) -> Result<(), WriteError> {
    let place = place::free_place(path, kind)?;
    write_file(&place, content).map_err(|error| WriteError::unwritten(path, error))
}

/// Opens a file to write to while something runs, under its own name from the start: readers follow it.
///
/// # Errors
/// If the path holds anything but an older one of its kind, or cannot be written.
pub fn open_output(path: &Path, kind: Kind) -> Result<File, WriteError> {
    let place = place::free_place(path, kind)?;
    File::create(&place).map_err(|error| WriteError::unwritten(path, error))
}
