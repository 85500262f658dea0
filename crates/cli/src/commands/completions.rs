//! `pydslrep completions`: shell completion.

use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::Shell;

use crate::failure::Failure;
use crate::help::Help;
use crate::report::output;

const HELP: Help = Help {
    examples: &[
        ("pydslrep completions bash > ~/.local/share/bash-completion/completions/pydslrep", ""),
        ("pydslrep completions zsh > ~/.zfunc/_pydslrep", ""),
        ("pydslrep completions fish > ~/.config/fish/completions/pydslrep.fish", ""),
    ],
    notes: &[],
};

/// Print the completion of this command for a shell
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command; `command` is the whole of the command line.
///
/// # Errors
/// If it cannot be printed.
pub(crate) fn run(arguments: &Arguments, mut command: Command) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "pydslrep", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(ExitCode::SUCCESS)
}
