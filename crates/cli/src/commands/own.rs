//! `pydslrep self`: about this program itself.

use std::env;
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::{Args, Subcommand};

use crate::failure::Failure;
use crate::help::Help;
use crate::report::output;
use crate::run::python;

const HELP: Help = Help {
    examples: &[
        ("pydslrep self check", "for a bug report"),
        ("pydslrep self check --host lab-pc", "whether the CoppeliaSim on another machine can be reached"),
    ],
    notes: &["Exit codes: 0 scripts can run here, 1 they cannot."],
};

/// The port of CoppeliaSim's `ZeroMQ` remote API.
const PORT: u16 = 23000;

/// An address without an answer is given up.
const CONNECT_LIMIT: Duration = Duration::from_secs(3);

/// This program itself: whether everything it needs is there
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    Check(Check),
}

/// Print versions, paths, the Python of scripts, and whether CoppeliaSim can be reached
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
struct Check {
    /// Where CoppeliaSim runs
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    host: String,
    /// Port of its ZeroMQ remote API
    #[arg(long, value_name = "PORT", default_value_t = PORT, value_parser = clap::value_parser!(u16).range(1..))]
    port: u16,
    /// The Python to run scripts with [default: that of this program's environment, else python3]
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If it cannot be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Task::Check(check) = &arguments.task;
    let own = env::current_exe().map_or_else(|error| error.to_string(), |path| path.display().to_string());
    let mut lines = vec![
        ("pydslrep", format!("{} ({own})", env!("CARGO_PKG_VERSION"))),
        ("system", format!("{} on {}", env::consts::OS, env::consts::ARCH)),
        ("cache", python::cache().map_or_else(|failure| words(&failure), |path| path.display().to_string())),
    ];
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| Failure::new(format!("cannot start Python: {error}")))?;
    let described = runtime.block_on(python::describe(check.python.as_deref()));
    match &described {
        Ok(found) => lines.extend([
            ("python", found.interpreter.clone()),
            ("client", found.client.clone()),
            ("odometry", found.odometry.clone()),
        ]),
        Err(failure) => lines.push(("python", words(failure))),
    }
    lines.push(("coppeliasim", simulator(&check.host, check.port)));
    let lines: Vec<String> = lines.iter().map(|(name, value)| format!("{name:<13}{value}\n")).collect();
    output::print(&lines.concat())?;
    Ok(if described.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A failure in one line.
fn words(failure: &Failure) -> String {
    match failure {
        Failure::Message { message, help: Some(help), .. } => format!("{message}: {help}"),
        Failure::Message { message, .. } | Failure::Rendered(message) => message.clone(),
        Failure::NoReader => String::new(),
    }
}

/// Describes whether something listens at an address.
fn simulator(host: &str, port: u16) -> String {
    match connect(host, port) {
        Ok(_) => format!("something listens on {host}:{port}: `pydslrep doctor PROGRAM` checks its scene"),
        Err(error) if error.kind() == io::ErrorKind::ConnectionRefused => {
            format!("nothing listens on {host}:{port}, which the embedded simulator does not need")
        }
        Err(error) => format!("{host}:{port} cannot be reached: {error}"),
    }
}

fn connect(host: &str, port: u16) -> io::Result<TcpStream> {
    let mut outcome = Err(io::ErrorKind::NotFound.into());
    for address in (host, port).to_socket_addrs()? {
        outcome = TcpStream::connect_timeout(&address, CONNECT_LIMIT);
        if outcome.is_ok() {
            break;
        }
    }
    outcome
}
