//! Failures outside of the program.

use std::fmt::Display;

use pydslrep_config::UnknownWord;

/// Wrong use or an outside failure: a file, a port, a missing Python.
#[derive(Debug)]
pub(crate) enum Failure {
    /// To be reported as an error.
    Message {
        /// What happened.
        message: String,
        /// What to do about it.
        help: Option<String>,
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
        Self::Message { message: message.into(), help: None }
    }

    /// Adds what to do about it.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        match self {
            Self::Message { message, .. } => Self::Message { message, help: Some(help.into()) },
            other => other,
        }
    }

    /// A file that could not be written.
    pub(crate) fn unwritten(path: &std::path::Path, error: &dyn Display) -> Self {
        Self::new(format!("cannot write {}: {error}", path.display()))
    }
}

impl From<UnknownWord> for Failure {
    fn from(unknown: UnknownWord) -> Self {
        Self::new(unknown.message).help(unknown.help)
    }
}
