//! `pydslrep lsp`: the language server.

use std::process::ExitCode;

use clap::Args;

use crate::failure::Failure;
use crate::help::Help;

const HELP: Help = Help {
    examples: &[
        ("pydslrep lsp", "for editors that start their servers"),
        ("pydslrep lsp --socket 4711", "for editors that wait on a port"),
        ("pydslrep lsp --edition article", "for programs that only have what the article of 2020 has"),
    ],
    notes: &[],
};

/// Serve an editor: the language server
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    #[command(flatten)]
    server: pydslrep_server::Arguments,
}

/// Runs the command.
///
/// # Errors
/// When the editor cannot be reached.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    // Runs are started by this program, whatever it is called.
    let own = std::env::current_exe().unwrap_or_else(|_| "pydslrep".into());
    arguments.server.serve(own).map_err(|unreachable| {
        let failure = Failure::new(unreachable.to_string());
        match unreachable.help() {
            Some(help) => failure.help(help),
            None => failure,
        }
    })
}
