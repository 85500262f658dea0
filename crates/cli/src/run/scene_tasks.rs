//! Tasks on the scene of a running simulator, which `pydslrep_runtime.scene` carries out, and on robots of ROS 2: a request
//! as JSON in, its answer as JSON out.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{ExitStatus, Output, Stdio};
use std::time::Duration;

use pydslrep_output::TemporaryFolder;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWriteExt};
use tokio::process::{Child, Command};
use tokio::time::timeout;

use crate::failure::Failure;
use crate::run::interrupt::{self, Interrupts, interrupt_process};
use crate::run::python::{self, Packages, Watcher};
use crate::run::reporter::Reporter;

/// Starts a module: the arguments are the folder of its package, and its name.
const BOOT: &str = "import runpy, sys; sys.path.insert(0, sys.argv.pop(1)); runpy.run_module(sys.argv.pop(1), None, '__main__')";

/// The module that carries out tasks on the scene of a simulator.
const SCENE_MODULE: &str = "pydslrep_runtime.scene";

/// At most this much of an answer is read, bytes: more than the largest scene takes.
const MAX_ANSWER: u64 = 64 << 20;

/// At most this much of what Python says besides is kept, bytes.
const MAX_STDERR: u64 = 1 << 20;

/// A task that is interrupted undoes what it has begun within this time.
const STOP_LIMIT: Duration = Duration::from_secs(5);

/// The first line of a Python traceback.
const TRACEBACK: &str = "Traceback (most recent call last)";

/// Characters of its last line.
const MAX_REASON: usize = 300;

/// The Python that carries out tasks; it gets the `CoppeliaSim` client library.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Interpreter<'a> {
    /// The user's choice.
    pub(crate) chosen: Option<&'a Path>,
    /// True if progress is hidden.
    pub(crate) quiet: bool,
}

/// An answer: a result, or why there is none.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Answer<T> {
    Refusal { error: String, help: Option<String>, reason: Option<String> },
    Result(T),
}

/// Carries out a task; `None` if the user interrupts it.
///
/// # Errors
/// If Python cannot be prepared, or the task is refused.
pub(crate) fn carry_out<T: DeserializeOwned>(
    interpreter: Interpreter<'_>,
    request: &impl Serialize,
) -> Result<Option<T>, Failure> {
    let reporter = Reporter::for_people();
    let watcher = Watcher { reporter: &reporter, quiet: interpreter.quiet };
    let python = python::prepare(interpreter.chosen, Packages::CLIENT, watcher);
    carry_out_in(python, &["-I"], SCENE_MODULE, request)
}

/// Has a module carry out a task in the user's own Python, with what its environment adds to that; `None` if the user
/// interrupts it.
///
/// # Errors
/// If there is no suitable Python, or the task is refused.
pub(crate) fn carry_out_in_own_python<T: DeserializeOwned>(
    chosen: Option<&Path>,
    module: &str,
    request: &impl Serialize,
) -> Result<Option<T>, Failure> {
    carry_out_in(python::interpreter(chosen), &[], module, request)
}

/// Has a module carry out a task in a Python with these options.
fn carry_out_in<T: DeserializeOwned>(
    python: impl Future<Output = Result<PathBuf, Failure>>,
    options: &[&str],
    module: &str,
    request: &impl Serialize,
) -> Result<Option<T>, Failure> {
    let request = serde_json::to_vec(request).map_err(|error| unstarted(&error))?;
    interrupt::run("start Python", async |mut interrupts| {
        let python = tokio::select! {
            python = python => python?,
            () = interrupts.next() => return Ok(None),
        };
        let mut command = Command::new(python);
        command.args(options);
        result(command, module, &request, &mut interrupts).await
    })
}

async fn result<T: DeserializeOwned>(
    mut command: Command,
    module: &str,
    request: &[u8],
    interrupts: &mut Interrupts,
) -> Result<Option<T>, Failure> {
    let folder = TemporaryFolder::new("run-").map_err(|error| unstarted(&error))?;
    let runtime = python::runtime(folder.path())?;
    command.args(["-X", "utf8", "-c", BOOT]).arg(&runtime).arg(module);
    let output = exchange(&mut command, request, interrupts).await.map_err(|error| unstarted(&error))?;
    let Some(output) = output else { return Ok(None) };
    match serde_json::from_slice(&output.stdout) {
        Ok(Answer::Result(result)) => Ok(Some(result)),
        Ok(Answer::Refusal { error, help, reason }) => {
            let failure = Failure::new(error).reason(reason);
            Err(if let Some(help) = help { failure.help(help) } else { failure })
        }
        Err(error) if output.status.success() => {
            Err(Failure::new(format!("the answer of Python cannot be read: {error}")))
        }
        Err(_) => Err(unanswered(&output.stderr, output.status)),
    }
}

/// Sends a request to a new process; `None` if the user interrupts it. It then undoes what it has begun, and ends.
async fn exchange(
    command: &mut Command,
    request: &[u8],
    interrupts: &mut Interrupts,
) -> io::Result<Option<Output>> {
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
    // Ctrl-C reaches it once: from this process.
    #[cfg(unix)]
    command.process_group(0);
    let mut child = command.spawn()?;
    let id = child.id();
    if let Some(mut stdin) = child.stdin.take() {
        // A child that has ended already says why.
        let _ = stdin.write_all(request).await;
    }
    let output = limited_output(&mut child);
    tokio::pin!(output);
    tokio::select! {
        output = &mut output => return output.map(Some),
        () = interrupts.next() => interrupt_process(id),
    }
    // Further interrupts change nothing: it has to undo what it has begun.
    let _ = timeout(STOP_LIMIT, output).await;
    Ok(None)
}

/// The output of a process, and how it ended; one that writes too much is killed.
async fn limited_output(child: &mut Child) -> io::Result<Output> {
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let (stdout, stderr) = tokio::join!(limited(stdout, MAX_ANSWER), limited(stderr, MAX_STDERR));
    let (stdout, stderr) = (stdout?, stderr?);
    if [(&stdout, MAX_ANSWER), (&stderr, MAX_STDERR)].iter().any(|(all, limit)| all.len() as u64 > *limit) {
        child.kill().await?;
        return Err(io::Error::other("its answer is too long"));
    }
    Ok(Output { status: child.wait().await?, stdout, stderr })
}

/// Reads a stream to its end, or to one byte more than a limit.
async fn limited(stream: Option<impl AsyncRead + Unpin>, limit: u64) -> io::Result<Vec<u8>> {
    let mut all = Vec::new();
    if let Some(stream) = stream {
        stream.take(limit + 1).read_to_end(&mut all).await?;
    }
    Ok(all)
}

fn unanswered(stderr: &[u8], status: ExitStatus) -> Failure {
    match String::from_utf8_lossy(stderr).trim() {
        "" => Failure::new(format!("Python ended with {status} and no answer")),
        // A traceback ends with what went wrong.
        all if all.contains(TRACEBACK) => Failure::new(
            all.lines().next_back().unwrap_or_default().chars().take(MAX_REASON).collect::<String>(),
        ),
        message => Failure::new(message.strip_prefix("error: ").unwrap_or(message)),
    }
}

fn unstarted(error: &dyn std::fmt::Display) -> Failure {
    Failure::new(format!("cannot start Python: {error}"))
}
