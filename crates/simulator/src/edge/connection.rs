//! One listener, and one task per connection, which speaks the protocol that its client begins with.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Mutex;
use tokio::sync::mpsc::UnboundedReceiver;
use tokio::time::{sleep, timeout};

use super::exchange::Exchange;
use super::{Violation, packet, zmtp};

/// Whoever connects must have introduced itself by then, and must take a reply within this time: a client that
/// does neither would hold its place, or the others' steps, for ever. A client of the legacy remote API says something
/// every few milliseconds, and V-REP too drops it after ten seconds of silence.
const PATIENCE: Duration = Duration::from_secs(10);

/// After a failed accept (too many open files) the next attempt waits, or it would burn a core.
const PAUSE_AFTER_ERROR: Duration = Duration::from_millis(50);

/// A client of the legacy remote API waits for each reply before it says more. What says more than this at once is none.
const MOST_MESSAGES_AT_ONCE: usize = 16;

/// Serves everybody who connects, until dropped.
pub(super) async fn listen(listener: TcpListener, exchange: Arc<Exchange>) {
    // A port serves one client of the legacy remote API; others that connect wait until it is gone.
    let turn = Arc::new(Mutex::new(()));
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                if let Some((connection, replies)) = exchange.admit() {
                    let (exchange, turn) = (Arc::clone(&exchange), Arc::clone(&turn));
                    tokio::spawn(async move {
                        let visit = Visit { exchange: &exchange, connection };
                        // However a connection ends, there is nobody left to tell.
                        let _ = serve(stream, &visit, replies, &turn).await;
                    });
                }
            }
            Err(_) => sleep(PAUSE_AFTER_ERROR).await,
        }
    }
}

/// An admitted connection; dismissed however its task ends, also by a panic.
struct Visit<'a> {
    exchange: &'a Exchange,
    connection: u64,
}

impl Drop for Visit<'_> {
    fn drop(&mut self) {
        self.exchange.dismiss(self.connection);
    }
}

async fn serve(
    stream: TcpStream,
    visit: &Visit<'_>,
    replies: UnboundedReceiver<Vec<u8>>,
    turn: &Mutex<()>,
) -> io::Result<()> {
    stream.set_nodelay(true)?;
    let mut line = Line { stream, buffer: vec![0; 16 * 1024] };
    // In both protocols the client speaks first, and its first byte tells them apart.
    let first = timeout(PATIENCE, line.read()).await??.to_vec();
    match first.first() {
        Some(&zmtp::MARK) => serve_zmtp(line, visit, replies, &first).await,
        _ => serve_legacy(line, visit, turn, &first).await,
    }
}

async fn serve_zmtp(
    mut line: Line,
    visit: &Visit<'_>,
    mut replies: UnboundedReceiver<Vec<u8>>,
    first: &[u8],
) -> io::Result<()> {
    line.write(&zmtp::opening()).await?;
    let mut receiver = zmtp::Receiver::default();
    let mut messages = Vec::new();
    receiver.receive(first, &mut messages)?;
    while !receiver.is_open() {
        receiver.receive(timeout(PATIENCE, line.read()).await??, &mut messages)?;
    }
    loop {
        for message in messages.drain(..) {
            visit.exchange.request(visit.connection, message);
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

async fn serve_legacy(mut line: Line, visit: &Visit<'_>, turn: &Mutex<()>, first: &[u8]) -> io::Result<()> {
    let mut receiver = packet::Receiver::default();
    let mut messages = Vec::new();
    receiver.receive(first, &mut messages)?;
    let lock = turn.lock();
    tokio::pin!(lock);
    let _turn = loop {
        if messages.len() > MOST_MESSAGES_AT_ONCE {
            return Err(Violation("messages without waiting for replies").into());
        }
        tokio::select! {
            turn = &mut lock => break turn,
            // Also to see that it is gone.
            bytes = line.read() => receiver.receive(bytes?, &mut messages)?,
        }
    };
    loop {
        for message in messages.drain(..) {
            let answered = visit.exchange.legacy_message(visit.connection, &message);
            let (reply, is_last) = answered.map_err(|_| Violation("no message of the legacy remote API"))?;
            line.write(&packet::encode(&reply)).await?;
            if is_last {
                return Ok(());
            }
        }
        receiver.receive(timeout(PATIENCE, line.read()).await??, &mut messages)?;
    }
}

struct Line {
    stream: TcpStream,
    buffer: Vec<u8>,
}

impl Line {
    /// Some bytes, at least one. Nothing is lost when this is dropped before it is done.
    async fn read(&mut self) -> io::Result<&[u8]> {
        match self.stream.read(&mut self.buffer).await? {
            0 => Err(io::ErrorKind::UnexpectedEof.into()),
            length => Ok(&self.buffer[..length]),
        }
    }

    async fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        timeout(PATIENCE, self.stream.write_all(bytes)).await?
    }
}

impl From<Violation> for io::Error {
    fn from(Violation(text): Violation) -> Self {
        Self::new(io::ErrorKind::InvalidData, text)
    }
}
