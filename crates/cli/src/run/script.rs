//! Runs a script as a child process: reads its output, stops it, and never leaves it running.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{ExitStatus, Stdio};
use std::time::{Duration, Instant};

use pydslrep_simulator::Simulator;
use pydslrep_trace::{FailureClass, RunEvent, RunFailure};
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader, Lines};
use tokio::process::{Child, ChildStdin, ChildStdout, Command};
use tokio::task::JoinHandle;
use tokio::time::{MissedTickBehavior, interval, timeout};

use crate::failure::Failure;
use crate::run::driven::Driven;
use crate::run::interrupt::{self, Interrupts, interrupt_process};
use crate::run::progress::Progress;
use crate::run::reporter::Reporter;

/// Starts a script: adds folders to those that Python imports from, also where it is isolated.
pub(crate) const BOOT: &str = include_str!("../../python/boot.py");

/// The environment variable with a run's token (`python/pydslrep_runtime/remote_api.py`).
pub(crate) const TOKEN: &str = "PYDSLREP_RUN";

/// The interval at which the simulator is polled.
const POLL_PERIOD: Duration = Duration::from_millis(50);

/// A script that is asked to end stops its robots within this time.
const STOP_LIMIT: Duration = Duration::from_secs(5);

/// Scripts limit every wait themselves. One in which simulation time stands still for this long is broken.
const STANDSTILL_LIMIT: Duration = Duration::from_secs(60);

/// Keeps Ctrl-C from a process (`CREATE_NEW_PROCESS_GROUP`).
#[cfg(windows)]
const NEW_PROCESS_GROUP: u32 = 0x200;

/// At most this much of a script's standard error is kept, bytes.
const MAX_STDERR: u64 = 1 << 20;

/// The receiver of a script's events.
pub(crate) struct Listener<'a> {
    simulator: Option<&'a Simulator>,
    driven: &'a mut Driven,
    progress: &'a mut Progress,
    reporter: &'a Reporter,
    /// Why the script is about to end.
    failure: Option<RunFailure>,
}

impl<'a> Listener<'a> {
    /// Makes a listener; the embedded simulator's records go to `driven`, if the script uses it.
    pub(crate) fn new(
        simulator: Option<&'a Simulator>,
        driven: &'a mut Driven,
        progress: &'a mut Progress,
        reporter: &'a Reporter,
    ) -> Self {
        Self { simulator, driven, progress, reporter, failure: None }
    }

    /// Reads a line of the script; lines that are not events are ignored.
    fn read(&mut self, line: &str) {
        let Some(event) = RunEvent::parse(line) else { return };
        match &event {
            RunEvent::ActionBegun(moment) => self.progress.begin_action(moment),
            RunEvent::ActionEnded(moment) => {
                self.progress.end_action(moment);
                if self.simulator.is_none() {
                    self.progress.pass(moment.t);
                    self.driven.time = moment.t;
                }
            }
            RunEvent::Note { text } => self.progress.note(text),
            RunEvent::Warning { text, help } => self.progress.warn(text, help.as_deref()),
            RunEvent::Failed(failure) => {
                // It is reported at the end, with the script's other output.
                self.failure = Some(failure.clone());
                return;
            }
            // Its files are temporary ones, and the result is of this program.
            RunEvent::File { .. } | RunEvent::Figures { .. } => return,
            RunEvent::Started { .. } | RunEvent::Contact(_) | RunEvent::Progress { .. } => {}
        }
        self.reporter.write(&event);
    }
}

/// Returns the failure of a script that has ended, from its exit status, the failure that it reported, and other text
/// on standard error; `None` if it succeeded.
fn ending(status: ExitStatus, failure: Option<RunFailure>, stderr: String) -> Option<RunFailure> {
    if status.success() {
        return None;
    }
    if status.code() == Some(i32::from(interrupt::EXIT_CODE)) {
        return Some(interrupted());
    }
    let failure = failure
        .unwrap_or_else(|| RunFailure::new(FailureClass::Crash, format!("the script ended with {status}")));
    Some(RunFailure { output: Some(stderr).filter(|text| !text.is_empty()), ..failure })
}

/// The user has ended the run.
pub(crate) fn interrupted() -> RunFailure {
    RunFailure::new(FailureClass::Interrupted, "interrupted")
}

/// A script to start.
pub(crate) struct Script {
    pub(crate) python: PathBuf,
    /// True if Python ignores modules beside the script and in the environment.
    pub(crate) isolated: bool,
    /// The folder of the package that it imports.
    pub(crate) runtime: PathBuf,
    /// A folder with modules that it imports if nothing else has them.
    pub(crate) modules: Option<PathBuf>,
    /// The token that identifies the script to the simulator of the run.
    pub(crate) token: Option<String>,
    /// The script and its arguments.
    pub(crate) arguments: Vec<OsString>,
}

/// Runs a script to its end and reports its events; returns why it failed, if it did.
///
/// # Errors
/// If it cannot be started or its end is lost.
pub(crate) async fn drive(
    script: &Script,
    mut listener: Listener<'_>,
    interrupts: &mut Interrupts,
) -> Result<Option<RunFailure>, Failure> {
    let simulator = listener.simulator;
    let mut running = Running::start(script)?;
    let mut polls = interval(POLL_PERIOD);
    polls.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut stopwatch = Stopwatch::default();
    let ending = loop {
        tokio::select! {
            line = next_line(&mut running.lines), if running.has_output => match line {
                Some(line) => listener.read(&line),
                None => running.has_output = false,
            },
            status = running.child.wait() => {
                let status = status.map_err(|error| Failure::new(format!("lost the script: {error}")))?;
                // Its last lines may not be read yet; a process that it left behind could keep the pipe open.
                while let Ok(Some(line)) = timeout(STOP_LIMIT, next_line(&mut running.lines)).await {
                    listener.read(&line);
                }
                break ending(status, listener.failure.take(), running.stderr_text().await);
            }
            () = interrupts.next() => {
                running.stop().await;
                break Some(interrupted());
            }
            _ = polls.tick() => if let Some(simulator) = simulator {
                listener.driven.extend(&simulator.take_trace());
                listener.progress.pass(simulator.time());
                if stopwatch.stands_still(simulator.time()) {
                    running.stop().await;
                    let seconds = STANDSTILL_LIMIT.as_secs();
                    let message = format!("simulation time stood still for {seconds} s, so the script was stopped");
                    break Some(RunFailure::new(FailureClass::Simulator, message));
                }
            },
        }
    };
    if let Some(simulator) = simulator {
        listener.driven.extend(&simulator.take_trace());
        listener.driven.sightings = simulator.sightings();
    }
    Ok(ending)
}

/// The next line of a script; `None` at the end. Lines that are not UTF-8 are skipped.
async fn next_line(lines: &mut Lines<BufReader<ChildStdout>>) -> Option<String> {
    loop {
        match lines.next_line().await {
            Ok(line) => return line,
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {}
            Err(_) => return None,
        }
    }
}

/// Notices when simulation time stands still.
struct Stopwatch {
    time: f64,
    since: Instant,
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self { time: 0.0, since: Instant::now() }
    }
}

impl Stopwatch {
    fn stands_still(&mut self, time: f64) -> bool {
        if time.to_bits() != self.time.to_bits() {
            *self = Self { time, since: Instant::now() };
        }
        self.since.elapsed() > STANDSTILL_LIMIT
    }
}

struct Running {
    child: Child,
    lines: Lines<BufReader<ChildStdout>>,
    /// True while standard output is open.
    has_output: bool,
    /// Its standard error; its messages are events.
    stderr: JoinHandle<String>,
    /// The script's input, which stays empty; where there are no signals, its end interrupts the script.
    #[cfg_attr(unix, expect(dead_code, reason = "it is there to be closed with this process"))]
    parent_pipe: Option<ChildStdin>,
}

impl Running {
    fn start(script: &Script) -> Result<Self, Failure> {
        let failure =
            |reason: &str| Failure::new(format!("cannot start {}: {reason}", script.python.display()));
        let mut command = Command::new(&script.python);
        if script.isolated {
            // No file beside the script can replace a module.
            command.arg("-I");
        }
        command.args(["-X", "utf8", "-c", BOOT]).arg(&script.runtime);
        command.arg(script.modules.as_deref().unwrap_or(Path::new(""))).args(&script.arguments);
        if let Some(token) = &script.token {
            command.env(TOKEN, token);
        }
        // The end of its input shows it that this process is gone.
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
        // Ctrl-C reaches the script once: from this process.
        #[cfg(unix)]
        command.process_group(0);
        #[cfg(windows)]
        command.creation_flags(NEW_PROCESS_GROUP);
        let mut child = command.spawn().map_err(|error| failure(&error.to_string()))?;
        let (Some(stdout), Some(stderr), Some(parent_pipe)) =
            (child.stdout.take(), child.stderr.take(), child.stdin.take())
        else {
            return Err(failure("its output cannot be read"));
        };
        let stderr = tokio::spawn(async move {
            let mut text = Vec::new();
            let mut all = stderr.take(MAX_STDERR);
            // Text read before an error is still worth showing.
            let _ = all.read_to_end(&mut text).await;
            let _ = tokio::io::copy(&mut all.into_inner(), &mut tokio::io::sink()).await;
            String::from_utf8_lossy(&text).trim_end().to_owned()
        });
        let lines = BufReader::new(stdout).lines();
        Ok(Self { child, lines, has_output: true, stderr, parent_pipe: Some(parent_pipe) })
    }

    /// Returns its output on standard error, once it has ended.
    async fn stderr_text(self) -> String {
        // A process that the script left behind could keep the pipe open.
        let stderr = timeout(STOP_LIMIT, self.stderr).await;
        stderr.ok().and_then(Result::ok).unwrap_or_default()
    }

    /// Asks the script to stop its robots and end; kills it if it does not. Further interrupts change nothing: a script that
    /// is killed leaves wheels turning.
    async fn stop(&mut self) {
        interrupt_process(self.child.id());
        #[cfg(not(unix))]
        drop(self.parent_pipe.take());
        let _ = timeout(STOP_LIMIT, self.child.wait()).await;
        // An error means that it has ended already.
        let _ = self.child.kill().await;
    }
}
