//! Access to files, on a disk or in memory.

use std::fmt;
use std::path::{Path, PathBuf};

/// Larger files are not read.
pub const MAX_BYTES: u64 = 16 << 20;

/// Where files come from.
pub trait FileSystem: fmt::Debug + Send + Sync {
    /// The text of a file, including a byte order mark.
    ///
    /// # Errors
    /// When the file does not exist, cannot be read, or is not text.
    fn read(&self, path: &Path) -> Result<String, ReadError>;

    /// Returns whether there is a file, readable or not.
    fn is_file(&self, path: &Path) -> bool;

    /// All programs and scenes in a folder and below it, except what is hidden or ignored. Visits at most
    /// `max_entries` files and folders.
    fn list(&self, folder: &Path, max_entries: usize) -> Listing;

    /// Returns whether [`FileSystem::list`] would find a file in a folder.
    fn lists(&self, folder: &Path, file: &Path) -> bool;
}

/// The files of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Listing {
    /// The programs, sorted by path.
    pub programs: Vec<PathBuf>,
    /// The scenes, sorted by path.
    pub scenes: Vec<PathBuf>,
    /// Why some folders could not be read.
    pub errors: Vec<String>,
    /// True if the limit cut the listing short.
    pub is_truncated: bool,
}

/// Why a file has no text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReadError {
    /// There is no such file.
    Missing,
    /// It is a folder.
    Folder,
    /// It is a pipe or a device.
    NotRegular,
    /// The user may not read it.
    PermissionDenied,
    /// It has more than [`MAX_BYTES`].
    TooLarge,
    /// It is not UTF-8.
    NotText {
        /// The first line that is not, from 1.
        line: usize,
    },
    /// Another error, in the system's words.
    Other(String),
}

/// The reason alone, to follow the name of the file and a colon.
impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("file not found"),
            Self::Folder => f.write_str("is a folder"),
            Self::NotRegular => f.write_str("not a regular file"),
            Self::PermissionDenied => f.write_str("permission denied"),
            Self::TooLarge => write!(f, "larger than {} MiB", MAX_BYTES >> 20),
            Self::NotText { line } => write!(f, "not valid UTF-8 in line {line}"),
            Self::Other(reason) => f.write_str(reason),
        }
    }
}

impl std::error::Error for ReadError {}

/// A text without its byte order mark, which editors hide: columns would be off by one.
pub fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}
