//! Work on a whole file, to be done now or beside the message loop.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pydslrep_analysis::Snapshot;

/// Work on one file.
pub(crate) struct Work<R> {
    /// The file.
    pub(crate) snapshot: Snapshot,
    /// Set when the file is no longer what it was.
    pub(crate) outdated: Arc<AtomicBool>,
    /// What to do with it.
    pub(crate) run: Box<dyn FnOnce(Snapshot) -> R + Send>,
}
