//! What went wrong outside of the program.

use std::fmt::Display;

use pydslrep_config::UnknownWord;

/// Wrong use or an outside failure: a file, a port, a missing Python.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Something to tell.
    Told {
        /// What happened.
        message: String,
        /// What to do about it.
        help: Option<String>,
    },
    /// Something to show as it is: what is wrong in a file that is no program, with its lines.
    Shown(String),
    /// Nobody reads the output any more, so there is nobody to tell.
    Unheard,
}

impl Failure {
    /// The exit code of all of them.
    pub(crate) const EXIT_CODE: u8 = 2;

    /// A failure with what happened.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self::Told { message: message.into(), help: None }
    }

    /// The same with what to do about it.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        match self {
            Self::Told { message, .. } => Self::Told { message, help: Some(help.into()) },
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
