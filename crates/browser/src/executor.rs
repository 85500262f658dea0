//! Runs futures on one thread, a part of each at a time.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, Wake, Waker};

use futures::future::BoxFuture;
use futures::stream::{FuturesUnordered, StreamExt};

/// Futures that have begun and not ended.
#[derive(Debug, Default)]
pub(crate) struct Executor {
    running: FuturesUnordered<BoxFuture<'static, ()>>,
    arrivals: Arrivals,
    wakefulness: Arc<Wakefulness>,
}

/// Where new futures wait for their first turn; clones share it.
#[derive(Clone, Default)]
pub(crate) struct Arrivals(Rc<RefCell<Vec<BoxFuture<'static, ()>>>>);

impl std::fmt::Debug for Arrivals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Arrivals").field(&self.0.borrow().len()).finish()
    }
}

impl Arrivals {
    pub(crate) fn add(&self, future: BoxFuture<'static, ()>) {
        self.0.borrow_mut().push(future);
    }
}

/// True if a future can continue.
#[derive(Debug, Default)]
struct Wakefulness(AtomicBool);

impl Wake for Wakefulness {
    fn wake(self: Arc<Self>) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Executor {
    /// Where to put what is to be run.
    pub(crate) fn arrivals(&self) -> Arrivals {
        self.arrivals.clone()
    }

    /// Polls futures that can continue, and returns whether any may be able to continue afterwards.
    pub(crate) fn turn(&mut self) -> bool {
        self.running.extend(self.arrivals.0.take());
        self.wakefulness.0.store(false, Ordering::Relaxed);
        let waker = Waker::from(Arc::clone(&self.wakefulness));
        let mut context = Context::from_waker(&waker);
        // It pauses by itself when a future that wakes itself comes up again.
        while let Poll::Ready(Some(())) = self.running.poll_next_unpin(&mut context) {}
        self.wakefulness.0.load(Ordering::Relaxed) || !self.arrivals.0.borrow().is_empty()
    }
}

#[cfg(test)]
mod tests {
    use std::future::poll_fn;
    use std::sync::mpsc;

    use futures::FutureExt;
    use futures::channel::oneshot;

    use super::*;

    #[test]
    fn a_long_future_runs_part_by_part() {
        let mut executor = Executor::default();
        let (sender, progress) = mpsc::channel();
        let mut part = 0;
        executor.arrivals().add(
            poll_fn(move |context| {
                part += 1;
                sender.send(part).unwrap();
                if part == 5 {
                    return Poll::Ready(());
                }
                context.waker().wake_by_ref();
                Poll::Pending
            })
            .boxed(),
        );
        let mut turns = 1;
        while executor.turn() {
            turns += 1;
        }
        assert!(turns > 1, "others had their turn in between");
        assert_eq!(progress.try_iter().last(), Some(5));
    }

    #[test]
    fn who_waits_for_something_is_woken_by_it() {
        let mut executor = Executor::default();
        let (sender, receiver) = oneshot::channel::<()>();
        let (done, ended) = mpsc::channel();
        executor.arrivals().add(receiver.map(move |_| done.send(()).unwrap()).boxed());
        while executor.turn() {}
        assert!(ended.try_recv().is_err());
        sender.send(()).unwrap();
        while executor.turn() {}
        assert!(ended.try_recv().is_ok());
    }
}
