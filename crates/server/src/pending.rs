//! Requests that are not answered yet, and how a client cancels them.

use std::future::Future;
use std::sync::Arc;

use futures::future::{AbortHandle, AbortRegistration, Abortable};
use pydslrep_analysis::CancellationToken;
use rustc_hash::FxHashMap;
use tower_lsp::jsonrpc::{Error, Id, Result};

use crate::shared::Shared;

/// The requests of a session that are not answered yet, by their ids; clones share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingRequests(Arc<Shared<FxHashMap<Id, Cancellation>>>);

/// The two ways to stop a request.
#[derive(Debug)]
struct Cancellation {
    /// Stops work on a snapshot, which checks it now and then.
    token: CancellationToken,
    /// Stops a request that waits for something.
    abort: AbortHandle,
}

impl PendingRequests {
    /// Registers a request.
    ///
    /// # Errors
    ///
    /// If another one with the same id is not answered yet.
    pub(crate) fn register(&self, id: &Id) -> Result<PendingRequest> {
        let mut requests = self.0.lock();
        if requests.contains_key(id) {
            return Err(Error::invalid_params("a request with this id is not answered yet"));
        }
        let token = CancellationToken::default();
        let (abort, registration) = AbortHandle::new_pair();
        requests.insert(id.clone(), Cancellation { token: token.clone(), abort });
        let entry = Entry { requests: self.clone(), id: id.clone() };
        Ok(PendingRequest { token, registration, entry })
    }

    /// Cancels a request, unless it is answered already.
    pub(crate) fn cancel(&self, id: &Id) {
        if let Some(Cancellation { token, abort }) = self.0.lock().get(id) {
            token.cancel();
            abort.abort();
        }
    }
}

/// A request that is not answered yet.
pub(crate) struct PendingRequest {
    /// For work that checks it.
    pub(crate) token: CancellationToken,
    registration: AbortRegistration,
    entry: Entry,
}

impl PendingRequest {
    /// The answer, or an error if the request is cancelled before.
    pub(crate) async fn run<T>(self, answer: impl Future<Output = Result<T>>) -> Result<T> {
        let Self { token, registration, entry } = self;
        let answer = Abortable::new(answer, registration).await;
        drop(entry);
        match answer {
            Ok(answer) if !token.is_cancelled() => answer,
            // Work that checked the token has stopped halfway.
            Ok(_) | Err(_) => Err(Error::request_cancelled()),
        }
    }
}

/// Forgets a request when it is answered, or ends in a panic.
struct Entry {
    requests: PendingRequests,
    id: Id,
}

impl Drop for Entry {
    fn drop(&mut self) {
        self.requests.0.lock().remove(&self.id);
    }
}

#[cfg(test)]
mod tests {
    use futures::FutureExt;

    use super::*;

    #[test]
    fn work_that_is_cancelled_while_it_computes_ends_as_cancelled() {
        let (pending, id) = (PendingRequests::default(), Id::Number(1));
        let request = pending.register(&id).unwrap();
        let token = request.token.clone();
        let answer = request.run(async {
            // As another thread does it; the result of the work is then incomplete.
            pending.cancel(&id);
            Ok(token.is_cancelled())
        });
        assert_eq!(answer.now_or_never(), Some(Err(Error::request_cancelled())));
        let again = pending.register(&id).expect("the id is free again");
        assert_eq!(again.run(async { Ok(7) }).now_or_never(), Some(Ok(7)));
    }

    #[test]
    fn an_id_has_one_request_at_a_time() {
        let (pending, id) = (PendingRequests::default(), Id::Number(1));
        let first = pending.register(&id).unwrap();
        assert!(pending.register(&id).is_err());
        drop(first);
        assert!(pending.register(&id).is_ok());
    }
}
