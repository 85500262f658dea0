//! Requests about whole files that are not answered yet, and how they are taken back.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::FxHashMap;
use tower_lsp::jsonrpc::Id;

/// Requests that are being worked on, by their ids; the flag takes one back.
#[derive(Debug, Clone, Default)]
pub(crate) struct Running(Arc<Mutex<FxHashMap<Id, Arc<AtomicBool>>>>);

impl Running {
    /// One more; the flag is its own.
    pub(crate) fn add(&self, id: Id) -> Arc<AtomicBool> {
        let flag = Arc::new(AtomicBool::new(false));
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(id, Arc::clone(&flag));
        flag
    }

    /// It is answered.
    pub(crate) fn remove(&self, id: &Id) -> Option<Arc<AtomicBool>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).remove(id)
    }

    /// Takes a request back; false if it is not among these.
    pub(crate) fn cancel(&self, id: &Id) -> bool {
        let flag = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(id).cloned();
        flag.is_some_and(|flag| {
            flag.store(true, Ordering::Relaxed);
            true
        })
    }
}
