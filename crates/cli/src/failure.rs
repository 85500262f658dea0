//! Failures outside of the program.

use std::fmt::Display;

use pydslrep_config::UnknownWord;
use pydslrep_output::{Kind, WriteError};

/// Wrong use or an outside failure: a file, a port, a missing Python.
#[derive(Debug)]
pub(crate) enum Failure {
    /// To be reported as an error.
    Message {
        /// The error.
        message: String,
        /// Advice for the user.
        help: Option<String>,
        /// An identifier for programs that can act on the error.
        reason: Option<String>,
    },
    /// Rendered already: problems in a file that is not a program, with its lines.
    Rendered(String),
    /// Standard output is closed, so nothing is reported.
    NoReader,
}

impl Failure {
    /// The exit code of every failure.
    pub(crate) const EXIT_CODE: u8 = 2;

    /// A failure with its message.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self::Message { message: message.into(), help: None, reason: None }
    }

    /// Adds advice.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        match self {
            Self::Message { message, reason, .. } => {
                Self::Message { message, help: Some(help.into()), reason }
            }
            other => other,
        }
    }

    /// Adds an identifier for programs.
    pub(crate) fn reason(self, known_as: Option<String>) -> Self {
        match self {
            Self::Message { message, help, .. } => Self::Message { message, help, reason: known_as },
            other => other,
        }
    }

    /// A file that could not be written.
    pub(crate) fn unwritten(path: &std::path::Path, error: &dyn Display) -> Self {
        Self::new(format!("cannot write {}: {error}", path.display()))
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        let failure = Self::new(error.to_string());
        match (&error, error.help()) {
            // One of the two that are for an editor's users, too.
            (WriteError::Changed(_), _) => {
                failure.help("keep your changes in a copy; `--force` replaces the script")
            }
            (WriteError::Foreign(_, Kind::Script), _) => {
                failure.help("move it away, or choose another folder with -o DIR")
            }
            (_, Some(help)) => failure.help(help),
            (_, None) => failure,
        }
    }
}

impl From<UnknownWord> for Failure {
    fn from(unknown: UnknownWord) -> Self {
        Self::new(unknown.message).help(unknown.help)
    }
}
