//! Interrupts: everything from outside that ends a command. Scripts have the same list (`interrupts.py` of their package).

use std::io;
use std::thread;

use tokio::sync::oneshot;

use crate::failure::Failure;

/// Receives interrupts. Before it exists, an interrupt ends the process at once.
pub(crate) struct Interrupts {
    #[cfg(unix)]
    signals: [tokio::signal::unix::Signal; 4],
    #[cfg(windows)]
    ctrl_c: tokio::signal::windows::CtrlC,
    #[cfg(windows)]
    ctrl_break: tokio::signal::windows::CtrlBreak,
    /// The window of the terminal is closed; the system ends this process some seconds later.
    #[cfg(windows)]
    ctrl_close: tokio::signal::windows::CtrlClose,
    #[cfg(windows)]
    ctrl_logoff: tokio::signal::windows::CtrlLogoff,
    #[cfg(windows)]
    ctrl_shutdown: tokio::signal::windows::CtrlShutdown,
    /// Resolves at the end of standard input, if that counts as an interrupt.
    end_of_input: Option<oneshot::Receiver<()>>,
}

/// The exit code after an interrupt.
pub(crate) const EXIT_CODE: u8 = 130;

/// Runs something that interrupts may end, in a runtime of its own. `what` it does is in the message if it cannot begin.
///
/// # Errors
/// If the system does not allow it; and those of the work.
pub(crate) fn run<T>(
    what: &str,
    work: impl AsyncFnOnce(Interrupts) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let unstarted = |error: io::Error| Failure::new(format!("cannot {what}: {error}"));
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(unstarted)?;
    runtime.block_on(async { work(Interrupts::listen().map_err(unstarted)?).await })
}

#[cfg(unix)]
impl Interrupts {
    /// Starts to listen.
    ///
    /// # Errors
    /// If the system does not allow it.
    fn listen() -> io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};
        let kinds =
            [SignalKind::interrupt(), SignalKind::terminate(), SignalKind::hangup(), SignalKind::quit()];
        let [interrupt, terminate, hangup, quit] = kinds.map(signal);
        Ok(Self { signals: [interrupt?, terminate?, hangup?, quit?], end_of_input: None })
    }

    /// Waits for the next interrupt.
    pub(crate) async fn next(&mut self) {
        let [interrupt, terminate, hangup, quit] = &mut self.signals;
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
            _ = quit.recv() => {}
            () = ended(&mut self.end_of_input) => {}
        }
    }
}

#[cfg(windows)]
impl Interrupts {
    /// Starts to listen.
    ///
    /// # Errors
    /// If the system does not allow it.
    fn listen() -> io::Result<Self> {
        use tokio::signal::windows;
        Ok(Self {
            ctrl_c: windows::ctrl_c()?,
            ctrl_break: windows::ctrl_break()?,
            ctrl_close: windows::ctrl_close()?,
            ctrl_logoff: windows::ctrl_logoff()?,
            ctrl_shutdown: windows::ctrl_shutdown()?,
            end_of_input: None,
        })
    }

    /// Waits for the next interrupt.
    pub(crate) async fn next(&mut self) {
        tokio::select! {
            _ = self.ctrl_c.recv() => {}
            _ = self.ctrl_break.recv() => {}
            _ = self.ctrl_close.recv() => {}
            _ = self.ctrl_logoff.recv() => {}
            _ = self.ctrl_shutdown.recv() => {}
            () = ended(&mut self.end_of_input) => {}
        }
    }
}

impl Interrupts {
    /// Treats the end of standard input as an interrupt, too: the process at its other end may be killed.
    pub(crate) fn with_end_of_input(mut self) -> Self {
        let (tell, ended) = oneshot::channel();
        // A thread: the runtime would wait for a task's read when it shuts down.
        thread::spawn(move || {
            // Input that cannot be read has ended as well.
            let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
            let _ = tell.send(());
        });
        self.end_of_input = Some(ended);
        self
    }
}

/// Waits for the end once; after that, forever.
async fn ended(input: &mut Option<oneshot::Receiver<()>>) {
    match input {
        Some(end) => {
            let _ = end.await;
            *input = None;
        }
        None => std::future::pending().await,
    }
}

/// Interrupts another process by its id, where the system can do so.
pub(crate) fn interrupt_process(id: Option<u32>) {
    #[cfg(unix)]
    {
        use rustix::process::{Pid, Signal, kill_process};
        if let Some(id) = id.and_then(|id| i32::try_from(id).ok()).and_then(Pid::from_raw) {
            // An error means that it has ended already.
            let _ = kill_process(id, Signal::INT);
        }
    }
    #[cfg(not(unix))]
    let _ = id;
}
