//! The texts of files and of standard input, or in words why there is none.

use std::io;
use std::path::Path;

use pydslrep_files::{Unread, decode, read};

use crate::failure::Failure;
use crate::paths::shown;

/// What standard input is called in what is printed.
pub(crate) const STDIN_SHOWN: &str = "<stdin>";

/// The text on standard input.
///
/// # Errors
/// When it cannot be read.
pub(crate) fn read_stdin() -> Result<String, Failure> {
    decode(io::stdin().lock()).map_err(|unread| failure(STDIN_SHOWN, &unread))
}

/// The text of a file.
///
/// # Errors
/// When it cannot be read.
pub(crate) fn read_file(path: &Path) -> Result<String, Failure> {
    read(path).map_err(|unread| failure(&shown(path), &unread))
}

fn failure(shown: &str, unread: &Unread) -> Failure {
    match unread {
        Unread::Missing => Failure::new(format!("{shown} does not exist")),
        Unread::TooLarge => Failure::new(format!("cannot read {shown}: {unread}")).help("is this a program?"),
        Unread::NotText { .. } => {
            Failure::new(format!("cannot read {shown}: {unread}")).help("save it in the encoding UTF-8")
        }
        Unread::Failed(_) => Failure::new(format!("cannot read {shown}: {unread}")),
    }
}
