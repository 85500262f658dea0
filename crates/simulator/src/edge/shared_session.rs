//! The session shared by all connections: assigns tickets to requests and routes answers back.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::task::AbortHandle;

use super::zmtp::{self, Message};
use crate::{Answer, Malformed, Session};

/// The maximum number of simultaneous connections; beyond it the oldest without a client gives way to a new one.
const MAX_CONNECTIONS: usize = 256;

/// The session and the reply channels of its connections. Shared by all tasks of a simulator and its owner.
pub(super) struct SharedSession {
    inner: Mutex<Inner>,
    begin: Instant,
}

struct Inner {
    session: Session,
    connections: BTreeMap<u64, Connection>,
    open: HashMap<u64, Origin>,
    last_connection: u64,
    last_ticket: u64,
}

struct Connection {
    replies: UnboundedSender<Vec<u8>>,
    /// Ends its task, once there is one.
    task: Option<AbortHandle>,
}

struct Origin {
    connection: u64,
    envelope: Vec<Vec<u8>>,
}

impl SharedSession {
    pub(super) fn new(session: Session) -> Self {
        let inner = Inner {
            session,
            connections: BTreeMap::new(),
            open: HashMap::new(),
            last_connection: 0,
            last_ticket: 0,
        };
        Self { inner: Mutex::new(inner), begin: Instant::now() }
    }

    /// Admits a connection and returns its number and the channel of its replies; `None` if there are too many that are
    /// in use.
    pub(super) fn admit(&self) -> Option<(u64, UnboundedReceiver<Vec<u8>>)> {
        let mut inner = self.lock();
        if inner.connections.len() >= MAX_CONNECTIONS {
            inner.close_oldest_idle()?;
        }
        inner.last_connection += 1;
        let (connection, (replies, receiver)) = (inner.last_connection, unbounded_channel());
        inner.connections.insert(connection, Connection { replies, task: None });
        Some((connection, receiver))
    }

    /// Notes the task that serves a connection, to end it if the connection must give way.
    pub(super) fn set_task(&self, connection: u64, task: AbortHandle) {
        if let Some(connection) = self.lock().connections.get_mut(&connection) {
            connection.task = Some(task);
        }
    }

    /// Handles a message; its reply arrives on the connection's channel, now or later.
    pub(super) fn request(&self, connection: u64, message: Message) {
        let now = self.begin.elapsed();
        let mut inner = self.lock();
        inner.last_ticket += 1;
        let ticket = inner.last_ticket;
        inner.open.insert(ticket, Origin { connection, envelope: message.envelope });
        let answers = inner.session.request(connection, ticket, now, &message.body);
        inner.deliver(answers);
    }

    /// Handles a message of the legacy remote API and returns its reply, and whether the client is done.
    pub(super) fn legacy_message(&self, connection: u64, bytes: &[u8]) -> Result<(Vec<u8>, bool), Malformed> {
        let now = self.begin.elapsed();
        let mut inner = self.lock();
        let response = inner.session.legacy_message(connection, now, bytes)?;
        inner.deliver(response.answers);
        Ok((response.reply, response.is_last))
    }

    /// Removes a connection and its clients.
    pub(super) fn dismiss(&self, connection: u64) {
        let mut inner = self.lock();
        inner.connections.remove(&connection);
        inner.open.retain(|_, origin| origin.connection != connection);
        let answers = inner.session.disconnect(connection);
        inner.deliver(answers);
    }

    /// Takes `steps` steps if no client steps the clock, or allows as many if steps are paced. Returns whether the session
    /// depends on real time.
    pub(super) fn advance(&self, steps: u32) -> bool {
        let mut inner = self.lock();
        let answers = inner.session.allow(steps);
        inner.deliver(answers);
        for _ in 0..steps {
            let answers = inner.session.tick();
            inner.deliver(answers);
        }
        inner.session.is_timed()
    }

    pub(super) fn expire_clients(&self) {
        let now: Duration = self.begin.elapsed();
        let mut inner = self.lock();
        let answers = inner.session.expire_clients(now);
        inner.deliver(answers);
    }

    /// Runs a function on the session.
    pub(super) fn with<T>(&self, work: impl FnOnce(&mut Session) -> T) -> T {
        work(&mut self.lock().session)
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // After a panic elsewhere at most one request stays unanswered.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    /// Makes room for another connection; `None` if every one has a client.
    fn close_oldest_idle(&mut self) -> Option<()> {
        let busy = self.session.busy_connections();
        let oldest = *self.connections.keys().find(|connection| !busy.contains(connection))?;
        if let Some(task) = self.connections.remove(&oldest)?.task {
            task.abort();
        }
        Some(())
    }

    fn deliver(&mut self, answers: Vec<Answer>) {
        for Answer { ticket, bytes } in answers {
            let Some(origin) = self.open.remove(&ticket) else { continue };
            if let Some(connection) = self.connections.get(&origin.connection) {
                // A closed channel belongs to a connection that is about to be removed.
                let _ = connection.replies.send(zmtp::encode(&origin.envelope, &bytes));
            }
        }
    }
}
