//! `pydslrep share`: manual pages and completions, for packages.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::{Shell, generate};

use crate::failure::Failure;

/// Where each shell looks for completions below a prefix's `share`. PowerShell looks nowhere: users load the file.
const COMPLETIONS: [(Shell, &str); 5] = [
    (Shell::Bash, "bash-completion/completions/pydslrep"),
    (Shell::Elvish, "elvish/lib/pydslrep.elv"),
    (Shell::Fish, "fish/vendor_completions.d/pydslrep.fish"),
    (Shell::PowerShell, "pydslrep/pydslrep.ps1"),
    (Shell::Zsh, "zsh/site-functions/_pydslrep"),
];

/// Write the manual pages and the completions of all shells into a folder, as a prefix has them in `share`
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder, created if it is missing
    folder: PathBuf,
}

/// Runs the command; `command` is the whole of the command line.
///
/// # Errors
/// If the files cannot be written.
pub(crate) fn run(arguments: &Arguments, command: Command) -> Result<ExitCode, Failure> {
    let folder = &arguments.folder;
    write(folder, command).map_err(|error| Failure::unwritten(folder, &error))?;
    Ok(ExitCode::SUCCESS)
}

fn write(folder: &Path, mut command: Command) -> io::Result<()> {
    for (shell, path) in COMPLETIONS {
        let path = folder.join(path);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        // Not into the file itself: a disk that is full would be a panic.
        let mut script = Vec::new();
        generate(shell, &mut command, "pydslrep", &mut script);
        fs::write(path, script)?;
    }
    let pages = folder.join("man/man1");
    fs::create_dir_all(&pages)?;
    clap_mangen::generate_to(command, pages)
}
