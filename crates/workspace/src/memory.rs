//! Files in memory: for tests, and for places without a disk.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::{DocumentKind, FileSystem, Listing, ReadError};

type Files = BTreeMap<PathBuf, Result<String, ReadError>>;

/// A file system in memory. Nothing in it is ignored.
#[derive(Debug, Default)]
pub struct MemoryFiles(Mutex<Files>);

impl MemoryFiles {
    /// Creates or replaces a file.
    pub fn write(&self, path: impl Into<PathBuf>, text: &str) {
        self.files().insert(path.into(), Ok(text.to_owned()));
    }

    /// Makes a file exist that cannot be read.
    pub fn write_unreadable(&self, path: impl Into<PathBuf>, reason: ReadError) {
        self.files().insert(path.into(), Err(reason));
    }

    /// Deletes a file.
    pub fn remove(&self, path: impl AsRef<Path>) {
        self.files().remove(path.as_ref());
    }

    fn files(&self) -> MutexGuard<'_, Files> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl FileSystem for MemoryFiles {
    fn read(&self, path: &Path) -> Result<String, ReadError> {
        self.files().get(path).cloned().unwrap_or(Err(ReadError::Missing))
    }

    fn is_file(&self, path: &Path) -> bool {
        self.files().contains_key(path)
    }

    fn list(&self, folder: &Path, max_entries: usize) -> Listing {
        let mut listing = Listing::default();
        let files = self.files();
        let inside = files.keys().filter(|path| path.starts_with(folder));
        for (count, path) in inside.enumerate() {
            if count >= max_entries {
                listing.is_truncated = true;
                break;
            }
            match DocumentKind::of_file(path) {
                Some(DocumentKind::Program) => listing.programs.push(path.clone()),
                Some(DocumentKind::Scene) => listing.scenes.push(path.clone()),
                Some(DocumentKind::Settings) | None => {}
            }
        }
        listing
    }

    fn lists(&self, folder: &Path, file: &Path) -> bool {
        let kind = DocumentKind::of_file(file);
        let is_listed = matches!(kind, Some(DocumentKind::Program | DocumentKind::Scene));
        is_listed && file.starts_with(folder) && self.is_file(file)
    }
}
