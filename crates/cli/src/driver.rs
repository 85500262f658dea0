//! A script that runs: started, listened to, and never outliving this command.

use std::io;
use std::path::PathBuf;
use std::process::{ExitStatus, Stdio};
use std::time::{Duration, Instant};

use pydslrep_simulator::Simulator;
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader, Lines};
use tokio::process::{Child, ChildStdout, Command};
use tokio::task::JoinHandle;
use tokio::time::{MissedTickBehavior, interval, timeout};

use crate::driven::Driven;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::progress::Progress;

/// How often the simulator is looked at.
const LOOK_PERIOD: Duration = Duration::from_millis(50);

/// A script stops its robots within this time when asked to end.
const STOP_LIMIT: Duration = Duration::from_secs(5);

/// Scripts have limits of their own for everything they wait for. One that lets no time pass for this long is broken.
const STANDSTILL_LIMIT: Duration = Duration::from_secs(60);

/// More than this of what a script complains about is not kept, bytes.
const MOST_COMPLAINTS: u64 = 1 << 20;

/// How a script ended.
pub(crate) enum Ending {
    /// It did what it should.
    Done,
    /// A robot could not do what it should; with the script's words.
    Failed(String),
    /// Something outside failed; with the script's words.
    Broken(String),
    /// Somebody wanted it to end.
    Interrupted,
}

/// What to start.
pub(crate) struct Script {
    pub(crate) python: PathBuf,
    /// Whether Python may only use what is installed for it, not what is beside the script or in the environment.
    pub(crate) isolated: bool,
    /// The script and its arguments.
    pub(crate) arguments: Vec<std::ffi::OsString>,
}

/// Runs a script to its end. `simulator` is the embedded one, if it drives that; what it records goes to `driven`.
///
/// # Errors
/// When it cannot be started or watched.
pub(crate) async fn drive(
    script: &Script,
    simulator: Option<&Simulator>,
    driven: &mut Driven,
    progress: &mut Progress,
    interrupts: &mut Interrupts,
) -> Result<Ending, Failure> {
    let mut running = Running::start(script)?;
    let mut looks = interval(LOOK_PERIOD);
    looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut watch = Watch::default();
    let ending = loop {
        tokio::select! {
            line = next_line(&mut running.lines), if running.speaks => match line {
                Some(line) => read(&line, simulator, driven, progress),
                None => running.speaks = false,
            },
            status = running.child.wait() => {
                let status = status.map_err(|error| Failure::new(format!("lost the script: {error}")))?;
                // What it said last may not be read yet; a process that it left behind could keep the pipe open.
                while let Ok(Some(line)) = timeout(STOP_LIMIT, next_line(&mut running.lines)).await {
                    read(&line, simulator, driven, progress);
                }
                break running.ending(status).await;
            }
            () = interrupts.next() => {
                running.stop(interrupts).await;
                break Ending::Interrupted;
            }
            _ = looks.tick() => if let Some(simulator) = simulator {
                driven.extend(&simulator.take_trace());
                progress.pass(simulator.time());
                if watch.stands_still(simulator.time()) {
                    running.stop(interrupts).await;
                    let seconds = STANDSTILL_LIMIT.as_secs();
                    break Ending::Broken(format!("error: the script let no time pass for {seconds} s, so it was ended"));
                }
            },
        }
    };
    if let Some(simulator) = simulator {
        driven.extend(&simulator.take_trace());
        driven.seen = simulator.sightings();
    }
    Ok(ending)
}

/// Reads what the script says. Only where there is no simulator to ask, it also tells the time.
fn read(line: &str, simulator: Option<&Simulator>, driven: &mut Driven, progress: &mut Progress) {
    if let (Some(seconds), None) = (progress.read(line), simulator) {
        progress.pass(seconds);
        driven.time = seconds;
    }
}

/// The next line that a script says; `None` at the end. Whatever is no text is passed over.
async fn next_line(lines: &mut Lines<BufReader<ChildStdout>>) -> Option<String> {
    loop {
        match lines.next_line().await {
            Ok(line) => return line,
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {}
            Err(_) => return None,
        }
    }
}

/// Tells when time stands still.
struct Watch {
    time: f64,
    since: Instant,
}

impl Default for Watch {
    fn default() -> Self {
        Self { time: 0.0, since: Instant::now() }
    }
}

impl Watch {
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
    /// Whether more lines may come.
    speaks: bool,
    complaints: JoinHandle<String>,
}

impl Running {
    fn start(script: &Script) -> Result<Self, Failure> {
        let failure =
            |reason: &str| Failure::new(format!("cannot start {}: {reason}", script.python.display()));
        let mut command = Command::new(&script.python);
        if script.isolated {
            // Nothing can take the place of a module.
            command.arg("-I");
        }
        command.args(["-X", "utf8"]).args(&script.arguments);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
        // Ctrl-C reaches the script once, from here.
        #[cfg(unix)]
        command.process_group(0);
        let mut child = command.spawn().map_err(|error| failure(&error.to_string()))?;
        let (Some(out), Some(complaints)) = (child.stdout.take(), child.stderr.take()) else {
            return Err(failure("it cannot be listened to"));
        };
        let complaints = tokio::spawn(async move {
            let mut bytes = Vec::new();
            let mut all = complaints.take(MOST_COMPLAINTS);
            // What was read before an error still says something.
            let _ = all.read_to_end(&mut bytes).await;
            let _ = tokio::io::copy(&mut all.into_inner(), &mut tokio::io::sink()).await;
            String::from_utf8_lossy(&bytes).trim_end().to_owned()
        });
        Ok(Self { child, lines: BufReader::new(out).lines(), speaks: true, complaints })
    }

    async fn ending(self, status: ExitStatus) -> Ending {
        // A process that the script left behind could keep the pipe open.
        let complaints = timeout(STOP_LIMIT, self.complaints).await;
        let complaints = complaints.ok().and_then(Result::ok).unwrap_or_default();
        match status.code() {
            Some(0) => Ending::Done,
            Some(1) if !complaints.contains("Traceback (most recent call last)") => {
                Ending::Failed(complaints)
            }
            Some(130) => Ending::Interrupted,
            _ if complaints.is_empty() => Ending::Broken(format!("error: the script ended by {status}")),
            _ => Ending::Broken(complaints),
        }
    }

    /// Asks the script to stop its robots and end, and ends it where it does not or a second wish comes.
    async fn stop(&mut self, interrupts: &mut Interrupts) {
        self.interrupt();
        tokio::select! {
            _ = timeout(STOP_LIMIT, self.child.wait()) => {}
            () = interrupts.next() => {}
        }
        // No error: it has ended already.
        let _ = self.child.kill().await;
    }

    #[cfg(unix)]
    fn interrupt(&self) {
        use rustix::process::{Pid, Signal, kill_process};
        let pid = self.child.id().and_then(|id| i32::try_from(id).ok()).and_then(Pid::from_raw);
        if let Some(pid) = pid {
            // No error: it has ended already.
            let _ = kill_process(pid, Signal::INT);
        }
    }

    #[cfg(not(unix))]
    fn interrupt(&self) {}
}
