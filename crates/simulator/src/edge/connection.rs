//! One listener, and one task per connection.

use std::io;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::mpsc::UnboundedReceiver;
use tokio::time::{sleep, timeout};

use super::exchange::Exchange;
use super::zmtp::{self, Receiver, Violation};

/// Whoever connects must have introduced itself by then, and must take a reply within this time: a client that
/// does neither would hold its place, or the others' steps, for ever.
const PATIENCE: Duration = Duration::from_secs(10);

/// After a failed accept (too many open files) the next attempt waits, or it would burn a core.
const PAUSE_AFTER_ERROR: Duration = Duration::from_millis(50);

/// Serves everybody who connects, until dropped.
pub(super) async fn listen(listener: TcpListener, exchange: Arc<Exchange>) {
    loop {
        match listener.accept().await {
            Ok((stream, _)) => {
                if let Some((connection, replies)) = exchange.admit() {
                    let exchange = Arc::clone(&exchange);
                    tokio::spawn(async move {
                        let visit = Visit { exchange: &exchange, connection };
                        // However a connection ends, there is nobody left to tell.
                        let _ = serve(stream, &visit, replies).await;
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
    mut stream: TcpStream,
    visit: &Visit<'_>,
    mut replies: UnboundedReceiver<Vec<u8>>,
) -> io::Result<()> {
    stream.set_nodelay(true)?;
    write(&mut stream, &zmtp::opening()).await?;
    let mut receiver = Receiver::default();
    let mut buffer = vec![0; 16 * 1024];
    let mut messages = Vec::new();
    while !receiver.is_open() {
        let length = timeout(PATIENCE, stream.read(&mut buffer)).await??;
        receive(&mut receiver, &buffer[..length], &mut messages)?;
    }
    loop {
        for message in messages.drain(..) {
            visit.exchange.request(visit.connection, message);
        }
        while let Ok(reply) = replies.try_recv() {
            write(&mut stream, &reply).await?;
        }
        tokio::select! {
            length = stream.read(&mut buffer) => {
                receive(&mut receiver, &buffer[..length?], &mut messages)?;
            }
            Some(reply) = replies.recv() => write(&mut stream, &reply).await?,
        }
    }
}

fn receive(receiver: &mut Receiver, bytes: &[u8], messages: &mut Vec<zmtp::Message>) -> io::Result<()> {
    if bytes.is_empty() {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    receiver
        .receive(bytes, messages)
        .map_err(|Violation(text)| io::Error::new(io::ErrorKind::InvalidData, text))
}

async fn write(stream: &mut TcpStream, bytes: &[u8]) -> io::Result<()> {
    timeout(PATIENCE, stream.write_all(bytes)).await?
}
