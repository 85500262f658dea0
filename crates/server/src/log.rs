//! Messages outside the protocol.

use std::fmt;
use std::io::{self, Write};

/// Writes a line to standard error: standard output belongs to the protocol.
pub(crate) fn log(message: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr(), "pydslrep-lsp: {message}");
}
