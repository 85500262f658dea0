//! The workspace's files on a disk.
//!
//! Knows paths and bytes, and the workspace's [`FileSystem`], which [`Disk`] is one of. Must never know what is in a
//! file.

mod list;
mod read;
mod regular;

use std::path::Path;

use pydslrep_workspace::{FileSystem, Listing, ReadError};

pub use read::{decode, read};
pub use regular::{open, read_bytes, read_start};

/// The files of this machine.
#[derive(Debug, Clone, Copy, Default)]
pub struct Disk;

impl FileSystem for Disk {
    fn read(&self, path: &Path) -> Result<String, ReadError> {
        read(path)
    }

    fn is_file(&self, path: &Path) -> bool {
        path.is_file()
    }

    fn list(&self, folder: &Path, max_entries: usize) -> Listing {
        list::list(folder, max_entries)
    }

    fn lists(&self, folder: &Path, file: &Path) -> bool {
        list::lists(folder, file)
    }
}
