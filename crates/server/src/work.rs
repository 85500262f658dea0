//! Work on a whole file, for the message loop or another thread.

use pydslrep_analysis::{CancellationToken, Snapshot};

/// Texts shorter than this many bytes are read before they could be handed to another thread.
pub(crate) const SHORT: usize = 64 << 10;

/// Work on one file.
pub(crate) struct Work<R> {
    /// The file.
    pub(crate) snapshot: Snapshot,
    /// Cancelled when the file changes.
    pub(crate) outdated: CancellationToken,
    /// What to do with it.
    pub(crate) run: Box<dyn FnOnce(Snapshot) -> R + Send>,
}
