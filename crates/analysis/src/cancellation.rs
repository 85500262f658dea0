//! Work that nobody wants any more.
//!
//! Long work calls [`check_cancelled`] in its loops. Within [`cancellable`] that ends the work by unwinding, as soon as
//! a token of it is cancelled; anywhere else, as in the command, it does nothing.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks work to stop whose result nobody wants any more. Clones share the signal.
#[derive(Debug, Clone, Default)]
pub struct CancellationToken(Arc<AtomicBool>);

impl CancellationToken {
    /// Stops the work at its next opportunity.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work should stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns whether two tokens share their signal.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The work was cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cancelled;

thread_local! {
    /// Those of the work that goes on here.
    static TOKENS: RefCell<Vec<CancellationToken>> = const { RefCell::new(Vec::new()) };
}

/// Does work that ends early once one of the tokens is cancelled.
///
/// # Errors
/// If it did.
pub fn cancellable<R>(tokens: &[CancellationToken], work: impl FnOnce() -> R) -> Result<R, Cancelled> {
    let outer = TOKENS.replace(tokens.to_vec());
    let result = catch_unwind(AssertUnwindSafe(work));
    TOKENS.set(outer);
    result.map_err(|reason: Box<dyn Any + Send>| match reason.downcast::<Cancelled>() {
        Ok(cancelled) => *cancelled,
        Err(panic) => resume_unwind(panic),
    })
}

/// Ends the work that goes on if it was cancelled. Cheap enough for every entity, action or leg.
pub fn check_cancelled() {
    if TOKENS.with_borrow(|tokens| tokens.iter().any(CancellationToken::is_cancelled)) {
        // No panic: nothing is wrong, and nothing is printed.
        resume_unwind(Box::new(Cancelled));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Database;

    #[test]
    fn work_ends_at_its_next_check() {
        let token = CancellationToken::default();
        let mut rounds = 0;
        let mut count_to = |limit: usize| {
            cancellable(&[CancellationToken::default(), token.clone()], || {
                while rounds < limit {
                    check_cancelled();
                    rounds += 1;
                    if rounds == 4 {
                        token.cancel();
                    }
                }
                rounds
            })
        };
        assert_eq!(count_to(3), Ok(3));
        assert_eq!(count_to(9), Err(Cancelled));
        assert_eq!(rounds, 4);
        check_cancelled();
    }

    #[test]
    fn a_panic_stays_a_panic() {
        let result = catch_unwind(|| cancellable(&[], || resume_unwind(Box::new("other"))));
        assert_eq!(result.unwrap_err().downcast_ref(), Some(&"other"));
    }

    #[test]
    fn the_analysis_checks() {
        let mut database = Database::new();
        let file = database.open(
            "a.pyr",
            "wheel a with radius 4 robot r with port 1 has { a a } wheels movement m of r { turn left }
             environment e has { r } robots with { m } moves wheel b",
        );
        let environment = database.environments(file)[0].0;
        let token = CancellationToken::default();
        token.cancel();
        let tokens = [token];
        assert!(cancellable(&tokens, || database.diagnostics(file)).is_err());
        assert!(cancellable(&tokens, || database.environments(file)).is_err());
        assert!(cancellable(&tokens, || database.environment(environment)).is_err());
    }
}
