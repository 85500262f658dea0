//! Work on a whole file, for the message loop or another thread.

use pydslrep_analysis::{CancellationToken, Snapshot};

/// Texts shorter than this many bytes are read before they could be handed to another thread.
pub(crate) const SHORT: usize = 64 << 10;

/// The work of a request about one file.
pub(crate) enum Work<R> {
    /// To be done on a program.
    OnFile(FileWork<R>),
    /// Done already: other files are short.
    Done(R),
}

/// Work on one program.
pub(crate) struct FileWork<R> {
    /// The file.
    pub(crate) snapshot: Snapshot,
    /// Cancelled when the file changes.
    pub(crate) outdated: CancellationToken,
    /// The work itself.
    pub(crate) run: Box<dyn FnOnce(Snapshot) -> R + Send>,
}
