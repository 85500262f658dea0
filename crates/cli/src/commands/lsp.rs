//! `pydslrep lsp`: the language server.

use std::process::ExitCode;

use clap::Args;

use crate::failure::Failure;

const EXAMPLES: &str = "\
Examples:
  pydslrep lsp                  for editors that start their servers
  pydslrep lsp --socket 4711    for editors that wait on a port";

/// Serve an editor: the language server
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Talk on standard input and output [default]
    #[arg(long, conflicts_with = "socket")]
    stdio: bool,
    /// Connect to the editor, which listens on this port of this machine
    #[arg(long, value_name = "PORT", value_parser = clap::value_parser!(u16).range(1..))]
    socket: Option<u16>,
    /// Editors add it to every server, with the number the protocol hands over anyway
    #[arg(long = "clientProcessId", hide = true)]
    client: Option<u32>,
}

/// Runs the command.
///
/// # Errors
/// When the editor cannot be reached.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match arguments.socket {
        None => pydslrep_server::run_stdio()
            .map_err(|error| Failure::new(format!("cannot serve on standard input: {error}"))),
        Some(port) => pydslrep_server::run_socket(port).map_err(|error| {
            Failure::new(format!("cannot reach the editor on port {port}: {error}"))
                .help("with --socket the editor listens first, and the server connects to it")
        }),
    }
}
