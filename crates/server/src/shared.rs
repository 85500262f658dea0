//! Values that several threads share.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// A value that one at a time reads and changes.
#[derive(Debug, Default)]
pub(crate) struct Shared<T>(Mutex<T>);

impl<T> Shared<T> {
    /// The value; a request that was cancelled may have left it as any request would.
    pub(crate) fn lock(&self) -> MutexGuard<'_, T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
