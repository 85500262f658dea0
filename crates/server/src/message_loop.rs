//! The message loop of a process: frames from a stream to a [`Session`], its messages to another stream.
//!
//! Reading and handling share one thread, so that an answer does not wait for a thread switch. Writing has its own, so
//! that a client that writes a lot before it reads does not cause a deadlock; once too much waits for that thread,
//! [`backlog`] takes over.

mod backlog;

use std::io::{self, BufWriter, Read, Write};
use std::process::ExitCode;
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::Duration;

use tokio::runtime;

use crate::frame::{Frame, FrameReader};
use crate::launch::Launch;
use crate::load::Load;
use crate::log::log;
use crate::message::Outbox;
use crate::session::{Ending, Session};

/// So many bytes may wait to be written before no more requests are answered: more than any usual answer.
const MAX_UNWRITTEN: usize = 16 << 20;

/// The time for writing the last messages once the session has ended.
const LAST_WORDS: Duration = Duration::from_secs(1);

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Orderly => Self::SUCCESS,
            Ending::Abrupt => Self::FAILURE,
        }
    }
}

/// Serves one client until it leaves.
///
/// # Errors
///
/// Only if the runtime or the writing thread cannot be started.
pub(crate) fn serve(
    input: impl Read + Send + 'static,
    output: impl Write + Send + 'static,
    launch: Launch,
) -> io::Result<Ending> {
    serve_with(input, output, &Load::new(MAX_UNWRITTEN), |outbox, runtime| {
        let session = Session::new(outbox, move |unfinished| drop(runtime.spawn(unfinished)));
        session.launch(launch);
        session
    })
}

/// [`serve`] with the session that `start` makes, and what may wait to be written.
fn serve_with(
    input: impl Read + Send + 'static,
    output: impl Write + Send + 'static,
    load: &Load,
    start: impl FnOnce(Outbox, runtime::Handle) -> Session,
) -> io::Result<Ending> {
    let runtime = runtime::Builder::new_multi_thread().worker_threads(1).build()?;
    let (sender, messages) = mpsc::channel();
    let outbox = Outbox::with_load(sender, load.clone());
    let (finished, writer_finished) = mpsc::channel();
    let written = load.clone();
    thread::Builder::new().name("writer".to_owned()).spawn(move || {
        // When the client stops reading, the input ends too.
        let _ = write_all(&messages, output, &written);
        written.end();
        let _ = finished.send(());
    })?;
    let mut session = start(outbox.clone(), runtime.handle().clone());
    let ending = read_all(&mut session, FrameReader::new(input), load)?;
    session.leave();
    outbox.close();
    let _ = writer_finished.recv_timeout(LAST_WORDS);
    runtime.shutdown_background();
    Ok(ending)
}

/// Passes messages to the session one by one, and has it publish diagnostics whenever none is waiting.
fn read_all(
    session: &mut Session,
    mut frames: FrameReader<impl Read + Send + 'static>,
    load: &Load,
) -> io::Result<Ending> {
    loop {
        if load.is_full() {
            return backlog::read_all(session, frames, load);
        }
        if !frames.has_more() {
            session.flush_diagnostics();
        }
        match frames.next() {
            // Nobody reads any more: what is left of the input matters only as far as it ends the session.
            Ok(Some(frame)) if load.is_over() && !is_end(&frame) => {}
            Ok(Some(frame)) => {
                if let Some(ending) = handle(session, frame) {
                    return Ok(ending);
                }
            }
            end => return Ok(report_end(end)),
        }
    }
}

/// Handles one frame; returns how the session ended, if it did.
fn handle(session: &mut Session, frame: Frame) -> Option<Ending> {
    match frame {
        Frame::Body(body) => session.handle(&body),
        Frame::BadHeader => {
            session.refuse("a header without a usable Content-Length");
            None
        }
    }
}

/// Returns whether a message may be `shutdown` or `exit`; those are short.
fn is_end(frame: &Frame) -> bool {
    matches!(frame, Frame::Body(body) if body.len() < 200
        && (contains(body, b"\"shutdown\"") || contains(body, b"\"exit\"")))
}

fn contains(body: &[u8], part: &[u8]) -> bool {
    body.windows(part.len()).any(|window| window == part)
}

/// The input has ended, or cannot be read.
fn report_end(end: io::Result<Option<Frame>>) -> Ending {
    if let Err(error) = end {
        log(format_args!("cannot read from the client: {error}"));
    }
    Ending::Abrupt
}

/// Writes messages until the last; those that are ready together are flushed together.
fn write_all(messages: &Receiver<Option<Vec<u8>>>, output: impl Write, load: &Load) -> io::Result<()> {
    let mut output = BufWriter::with_capacity(1 << 16, output);
    while let Ok(Some(first)) = messages.recv() {
        let mut next = Some(first);
        while let Some(body) = next {
            write!(output, "Content-Length: {}\r\n\r\n", body.len())?;
            output.write_all(&body)?;
            load.remove(body.len());
            next = match messages.try_recv() {
                Ok(Some(body)) => Some(body),
                Ok(None) => return output.flush(),
                Err(_) => None,
            };
        }
        output.flush()?;
    }
    output.flush()
}

#[cfg(test)]
mod tests;
