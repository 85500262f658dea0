//! One listener per port and one task per connection, which speaks its client's protocol.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Mutex;
use tokio::sync::mpsc::UnboundedReceiver;
use tokio::time::{Instant, sleep, timeout, timeout_at};

use super::shared_session::SharedSession;
use super::{ProtocolError, packet, zmtp};

/// The time limit for everything up to the first message, and for accepting a reply: a client that exceeds it would block
/// its slot, or the other clients' steps, forever. Clients of the legacy remote API send a message every few milliseconds, and V-REP
/// drops them after ten seconds of silence, too.
const TIMEOUT: Duration = Duration::from_secs(10);

/// The delay after a failed accept (too many open files), which avoids a busy loop.
const ACCEPT_RETRY_DELAY: Duration = Duration::from_millis(50);

/// A client of the legacy remote API waits for each reply before it sends the next message. Connections that send more
/// than this at once are refused.
const MAX_PENDING_MESSAGES: usize = 16;

/// Serves all connections until dropped.
pub(super) async fn listen(listener: TcpListener, session: Arc<SharedSession>) {
    // A port serves one client of the legacy remote API at a time; the others wait until it disconnects.
    let turn = Arc::new(Mutex::new(()));
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                if let Some((connection, replies)) = session.admit() {
                    let (shared, turn) = (Arc::clone(&session), Arc::clone(&turn));
                    let task = tokio::spawn(async move {
                        let guard = ConnectionGuard { session: &shared, connection };
                        // After an error the connection is closed, so there is nobody to report it to.
                        let _ = serve(stream, &guard, replies, &turn).await;
                    });
                    session.set_task(connection, task.abort_handle());
                }
            }
            Err(_) => sleep(ACCEPT_RETRY_DELAY).await,
        }
    }
}

/// An admitted connection, removed when its task ends, even by a panic.
struct ConnectionGuard<'a> {
    session: &'a SharedSession,
    connection: u64,
}

impl Drop for ConnectionGuard<'_> {
    fn drop(&mut self) {
        self.session.dismiss(self.connection);
    }
}

async fn serve(
    stream: TcpStream,
    guard: &ConnectionGuard<'_>,
    replies: UnboundedReceiver<Vec<u8>>,
    turn: &Mutex<()>,
) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut line = Line { stream, buffer: vec![0; 16 * 1024] };
    // In both protocols the client sends first, and its first byte identifies the protocol.
    let deadline = Instant::now() + TIMEOUT;
    let first = timeout_at(deadline, line.read()).await??.to_vec();
    match first.first() {
        Some(&zmtp::MARK) => serve_zmtp(line, guard, replies, &first, deadline).await,
        _ => serve_legacy(line, guard, turn, &first, deadline).await,
    }
}

async fn serve_zmtp(
    mut line: Line,
    guard: &ConnectionGuard<'_>,
    mut replies: UnboundedReceiver<Vec<u8>>,
    first: &[u8],
    deadline: Instant,
) -> io::Result<()> {
    line.write(&zmtp::opening()).await?;
    let mut receiver = zmtp::Receiver::default();
    let mut messages = Vec::new();
    receiver.receive(first, &mut messages)?;
    while !receiver.is_open() {
        receiver.receive(timeout_at(deadline, line.read()).await??, &mut messages)?;
    }
    loop {
        for message in messages.drain(..) {
            guard.session.request(guard.connection, message);
        }
        while let Ok(reply) = replies.try_recv() {
            line.write(&reply).await?;
        }
        tokio::select! {
            bytes = line.read() => receiver.receive(bytes?, &mut messages)?,
            Some(reply) = replies.recv() => line.write(&reply).await?,
        }
    }
}

async fn serve_legacy(
    mut line: Line,
    guard: &ConnectionGuard<'_>,
    turn: &Mutex<()>,
    first: &[u8],
    deadline: Instant,
) -> io::Result<()> {
    let mut receiver = packet::Receiver::default();
    let mut messages = Vec::new();
    receiver.receive(first, &mut messages)?;
    while messages.is_empty() {
        receiver.receive(timeout_at(deadline, line.read()).await??, &mut messages)?;
    }
    let lock = turn.lock();
    tokio::pin!(lock);
    let _turn = loop {
        if messages.len() > MAX_PENDING_MESSAGES {
            return Err(ProtocolError("messages without waiting for replies").into());
        }
        tokio::select! {
            turn = &mut lock => break turn,
            // Also detects a disconnect.
            bytes = line.read() => receiver.receive(bytes?, &mut messages)?,
        }
    };
    loop {
        for message in messages.drain(..) {
            let answered = guard.session.legacy_message(guard.connection, &message);
            let (reply, is_last) =
                answered.map_err(|_| ProtocolError("not a message of the legacy remote API"))?;
            line.write(&packet::encode(&reply)).await?;
            if is_last {
                return Ok(());
            }
        }
        receiver.receive(timeout(TIMEOUT, line.read()).await??, &mut messages)?;
    }
}

struct Line {
    stream: TcpStream,
    buffer: Vec<u8>,
}

impl Line {
    /// Reads at least one byte. Cancel safe.
    async fn read(&mut self) -> io::Result<&[u8]> {
        match self.stream.read(&mut self.buffer).await? {
            0 => Err(io::ErrorKind::UnexpectedEof.into()),
            length => Ok(&self.buffer[..length]),
        }
    }

    async fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        timeout(TIMEOUT, self.stream.write_all(bytes)).await?
    }
}

impl From<ProtocolError> for io::Error {
    fn from(ProtocolError(text): ProtocolError) -> Self {
        Self::new(io::ErrorKind::InvalidData, text)
    }
}
