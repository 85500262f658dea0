//! Saying something outside the protocol.

use std::fmt;
use std::io::{self, Write};

/// Writes a line to standard error, the only place where a language server may say something of its own.
pub(crate) fn log(message: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr(), "pydslrep-lsp: {message}");
}
