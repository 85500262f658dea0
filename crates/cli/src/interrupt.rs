//! Wishes of the outside that this command should end: Ctrl-C, a closed terminal, a polite kill.

use std::io;
use std::thread;

use tokio::sync::oneshot;

/// Listens from its making on; before that, such a wish ends the process at once.
pub(crate) struct Interrupts {
    #[cfg(unix)]
    signals: [tokio::signal::unix::Signal; 3],
    /// Resolves at the end of standard input, where that is such a wish.
    end_of_input: Option<oneshot::Receiver<()>>,
}

/// The exit code after one.
pub(crate) const EXIT_CODE: u8 = 130;

#[cfg(unix)]
impl Interrupts {
    /// Begins to listen.
    ///
    /// # Errors
    /// When the system does not allow it.
    pub(crate) fn listen() -> io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};
        let kinds = [SignalKind::interrupt(), SignalKind::terminate(), SignalKind::hangup()];
        let [interrupt, terminate, hangup] = kinds.map(signal);
        Ok(Self { signals: [interrupt?, terminate?, hangup?], end_of_input: None })
    }

    /// Waits for the next one.
    pub(crate) async fn next(&mut self) {
        let [interrupt, terminate, hangup] = &mut self.signals;
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
            () = ended(&mut self.end_of_input) => {}
        }
    }
}

#[cfg(not(unix))]
impl Interrupts {
    /// Begins to listen.
    ///
    /// # Errors
    /// Never on this system.
    #[allow(clippy::unnecessary_wraps)] // as on others
    pub(crate) fn listen() -> io::Result<Self> {
        Ok(Self { end_of_input: None })
    }

    /// Waits for the next one.
    pub(crate) async fn next(&mut self) {
        let interrupt = async {
            if tokio::signal::ctrl_c().await.is_err() {
                std::future::pending::<()>().await;
            }
        };
        tokio::select! {
            () = interrupt => {}
            () = ended(&mut self.end_of_input) => {}
        }
    }
}

impl Interrupts {
    /// Takes the end of standard input for a wish to end, too: whoever holds its other end may be killed.
    pub(crate) fn with_end_of_input(mut self) -> Self {
        let (tell, ended) = oneshot::channel();
        // No task: the runtime would wait for its read when it shuts down.
        thread::spawn(move || {
            // Input that cannot be read has ended, too.
            let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
            let _ = tell.send(());
        });
        self.end_of_input = Some(ended);
        self
    }
}

/// Waits for it once; afterwards it is nothing new.
async fn ended(input: &mut Option<oneshot::Receiver<()>>) {
    match input {
        Some(end) => {
            let _ = end.await;
            *input = None;
        }
        None => std::future::pending().await,
    }
}
