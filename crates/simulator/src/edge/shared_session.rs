//! Where connections and the session meet: requests get tickets, answers find their way back.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::zmtp::{self, Message};
use crate::{Answer, Malformed, Session};

/// More connections than this at once are not served.
const MOST_CONNECTIONS: usize = 256;

/// The session and the way back to every connection. Shared by all tasks of a simulator and its owner.
pub(super) struct Exchange {
    inner: Mutex<Inner>,
    begin: Instant,
}

struct Inner {
    session: Session,
    connections: HashMap<u64, UnboundedSender<Vec<u8>>>,
    open: HashMap<u64, Origin>,
    last_connection: u64,
    last_ticket: u64,
}

struct Origin {
    connection: u64,
    envelope: Vec<Vec<u8>>,
}

impl Exchange {
    pub(super) fn new(session: Session) -> Self {
        let inner = Inner {
            session,
            connections: HashMap::new(),
            open: HashMap::new(),
            last_connection: 0,
            last_ticket: 0,
        };
        Self { inner: Mutex::new(inner), begin: Instant::now() }
    }

    /// Admits a connection: its number and the replies to send to it; `None` when there are too many.
    pub(super) fn admit(&self) -> Option<(u64, UnboundedReceiver<Vec<u8>>)> {
        let mut inner = self.lock();
        if inner.connections.len() >= MOST_CONNECTIONS {
            return None;
        }
        inner.last_connection += 1;
        let (connection, (sender, receiver)) = (inner.last_connection, unbounded_channel());
        inner.connections.insert(connection, sender);
        Some((connection, receiver))
    }

    /// Handles a message; its reply comes out of the connection's receiver, now or later.
    pub(super) fn request(&self, connection: u64, message: Message) {
        let now = self.begin.elapsed();
        let mut inner = self.lock();
        inner.last_ticket += 1;
        let ticket = inner.last_ticket;
        inner.open.insert(ticket, Origin { connection, envelope: message.envelope });
        let answers = inner.session.request(connection, ticket, now, &message.body);
        inner.deliver(answers);
    }

    /// Handles a message of the legacy remote API: its reply, and whether the client is done.
    pub(super) fn legacy_message(&self, connection: u64, bytes: &[u8]) -> Result<(Vec<u8>, bool), Malformed> {
        let now = self.begin.elapsed();
        let mut inner = self.lock();
        let pass = inner.session.legacy_message(connection, now, bytes)?;
        inner.deliver(pass.answers);
        Ok((pass.reply, pass.is_last))
    }

    /// Forgets a connection and the clients behind it.
    pub(super) fn dismiss(&self, connection: u64) {
        let mut inner = self.lock();
        inner.connections.remove(&connection);
        inner.open.retain(|_, origin| origin.connection != connection);
        let answers = inner.session.disconnect(connection);
        inner.deliver(answers);
    }

    /// Lets `steps` steps pass if nobody steps the clock, or allows as many where steps are paced; whether the time of
    /// the machine matters at all.
    pub(super) fn pass_time(&self, steps: u32) -> bool {
        let mut inner = self.lock();
        let answers = inner.session.allow(steps);
        inner.deliver(answers);
        for _ in 0..steps {
            let answers = inner.session.tick();
            inner.deliver(answers);
        }
        inner.session.is_timed()
    }

    pub(super) fn keep_house(&self) {
        let now: Duration = self.begin.elapsed();
        let mut inner = self.lock();
        let answers = inner.session.keep_house(now);
        inner.deliver(answers);
    }

    /// Works on the session.
    pub(super) fn with_session<T>(&self, work: impl FnOnce(&mut Session) -> T) -> T {
        work(&mut self.lock().session)
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A panic elsewhere leaves at worst one request unanswered; the others go on.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn deliver(&mut self, answers: Vec<Answer>) {
        for Answer { ticket, bytes } in answers {
            let Some(origin) = self.open.remove(&ticket) else { continue };
            if let Some(connection) = self.connections.get(&origin.connection) {
                // A closed receiver is a connection about to be dismissed.
                let _ = connection.send(zmtp::encode(&origin.envelope, &bytes));
            }
        }
    }
}
