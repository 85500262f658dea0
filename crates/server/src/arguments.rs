//! The arguments that start the server: those of `pydslrep-lsp` and of `pydslrep lsp`.

use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pydslrep_config::{Config, Edition};

use crate::launch::Launch;
use crate::process::{run_socket, run_stdio};

/// Serve an editor: the language server
// The command's own arguments have the same name.
#[derive(Debug, Args)]
#[group(skip)]
pub struct Arguments {
    /// Talk on standard input and output [default]
    #[arg(long, conflicts_with = "socket")]
    stdio: bool,
    /// Connect to the editor, which listens on this port of this machine
    #[arg(long, value_name = "PORT", value_parser = clap::value_parser!(u16).range(1..))]
    socket: Option<u16>,
    /// Which statements programs may have [default: that of the settings, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser())]
    edition: Option<Edition>,
    /// Editors add it to every server, with the number that the protocol sends anyway
    #[arg(long = "clientProcessId", hide = true)]
    client: Option<u32>,
}

/// Parses an edition by its name in settings.
pub fn edition_parser() -> impl TypedValueParser<Value = Edition> {
    let word = |edition: Edition| PossibleValue::new(edition.word()).help(edition.summary());
    PossibleValuesParser::new(Edition::ALL.map(word))
        .try_map(|word| Edition::from_word(&word).ok_or("no edition"))
}

/// Why an editor cannot be served.
#[derive(Debug)]
pub struct Unreachable {
    port: Option<u16>,
    error: io::Error,
}

impl Arguments {
    /// Serves one client until it leaves. The exit code is the protocol's: success only after `shutdown` and `exit`.
    /// `command` is the program `pydslrep`, which runs environments.
    ///
    /// # Errors
    ///
    /// If the client cannot be reached.
    pub fn serve(&self, command: PathBuf) -> Result<ExitCode, Unreachable> {
        let launch = Launch { command, options: Config::of_edition(self.edition) };
        let served = match self.socket {
            None => run_stdio(launch),
            Some(port) => run_socket(port, launch),
        };
        served.map_err(|error| Unreachable { port: self.socket, error })
    }
}

impl fmt::Display for Unreachable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.port {
            None => write!(f, "cannot serve on standard input: {}", self.error),
            Some(port) => write!(f, "cannot reach the editor on port {port}: {}", self.error),
        }
    }
}

impl Unreachable {
    /// Returns the advice for the user.
    pub fn help(&self) -> Option<&'static str> {
        self.port.map(|_| "with --socket the editor listens first, and the server connects to it")
    }
}
