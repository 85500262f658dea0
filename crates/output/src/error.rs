//! Why something was not written, and what to do about it.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::Kind;

/// Why something was not written.
#[derive(Debug)]
pub enum WriteError {
    /// The path holds something that this program did not make.
    Foreign(PathBuf, Kind),
    /// The path holds a script that somebody changed.
    Changed(PathBuf),
    /// The same command reads the file.
    Input(PathBuf),
    /// Two outputs of the same command go to the file.
    Twice(PathBuf),
    /// The path is a link that leads out of its folder.
    Link {
        /// The link.
        path: PathBuf,
        /// Where it leads.
        target: PathBuf,
    },
    /// The disk says no.
    Unwritten {
        /// The file or folder to write.
        path: PathBuf,
        /// The disk's reason.
        error: io::Error,
    },
}

impl WriteError {
    pub(crate) fn unwritten(path: &Path, error: io::Error) -> Self {
        Self::Unwritten { path: path.to_owned(), error }
    }

    /// Returns advice; `None` if the disk's reason says enough.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Foreign(_, Kind::Script) => {
                Some("move it away, or write the script to another folder".to_owned())
            }
            Self::Foreign(..) | Self::Input(_) => Some("choose another file".to_owned()),
            Self::Changed(_) => {
                Some("keep your changes in a copy, and let the script be replaced".to_owned())
            }
            Self::Twice(_) => Some("choose a file for each".to_owned()),
            Self::Link { target, .. } => {
                Some(format!("remove the link, or name {} itself", target.display()))
            }
            Self::Unwritten { .. } => None,
        }
    }
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(path, kind) => write!(f, "{} exists and is not {}", path.display(), kind.noun()),
            Self::Changed(path) => write!(f, "{} was changed since it was generated", path.display()),
            Self::Input(path) => write!(f, "{} is read by the same command", path.display()),
            Self::Twice(path) => write!(f, "{} would be written twice", path.display()),
            Self::Link { path, target } => {
                write!(f, "{} is a link to {}, outside of its folder", path.display(), target.display())
            }
            Self::Unwritten { path, error } => write!(f, "cannot write {}: {error}", path.display()),
        }
    }
}

impl std::error::Error for WriteError {}
