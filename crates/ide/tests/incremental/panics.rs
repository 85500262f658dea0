//! Turns panics into failures, so that they shrink like all others.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};

thread_local! {
    static LAST: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Records panics silently while it exists: shrinking a failure causes hundreds of them.
pub(crate) struct Silence;

impl Silence {
    pub(crate) fn new() -> Self {
        set_hook(Box::new(|panic| LAST.set(panic.to_string())));
        Self
    }
}

impl Drop for Silence {
    fn drop(&mut self) {
        drop(take_hook());
    }
}

/// Turns a panic into an error.
pub(crate) fn without_panic<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(LAST.take()))
}
