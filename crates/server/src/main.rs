//! The program `pydslrep-lsp`.

use std::io::{self, Write};
use std::process::ExitCode;

use pydslrep_server::{run_socket, run_stdio};

const HELP: &str = "\
The language server of PyDSLRep, started by editors.

Usage: pydslrep-lsp --stdio
       pydslrep-lsp --socket PORT

Options:
      --stdio          talk to the client on standard input and output
      --socket <PORT>  connect to the client, which listens on this port of this machine
  -V, --version        print the version
  -h, --help           print this help

Messages for people go to standard error. The exit code is 0 after `shutdown` and `exit`, 1 if the client left
otherwise, 2 for wrong arguments or a port where nothing listens.
";

#[derive(Debug, PartialEq, Eq)]
enum Invocation {
    Stdio,
    Socket(u16),
    Version,
    Help,
}

fn main() -> ExitCode {
    let outcome = match parse(std::env::args().skip(1)) {
        Ok(Invocation::Stdio) => {
            run_stdio().map_err(|error| format!("cannot serve on standard input: {error}"))
        }
        Ok(Invocation::Socket(port)) => {
            run_socket(port).map_err(|error| format!("cannot serve the client on port {port}: {error}"))
        }
        Ok(Invocation::Version) => print(&format!("pydslrep-lsp {}\n", env!("CARGO_PKG_VERSION"))),
        Ok(Invocation::Help) => print(HELP),
        Err(message) => Err(format!("{message}\n\nFor what it understands, try `pydslrep-lsp --help`.")),
    };
    outcome.unwrap_or_else(|message| {
        let _ = writeln!(io::stderr(), "pydslrep-lsp: {message}");
        ExitCode::from(2)
    })
}

fn print(text: &str) -> Result<ExitCode, String> {
    io::stdout().write_all(text.as_bytes()).map_err(|error| error.to_string())?;
    Ok(ExitCode::SUCCESS)
}

fn parse(arguments: impl Iterator<Item = String>) -> Result<Invocation, String> {
    let mut arguments = arguments;
    let mut chosen = None;
    while let Some(argument) = arguments.next() {
        let invocation = match argument.as_str() {
            "--version" | "-V" => return Ok(Invocation::Version),
            "--help" | "-h" => return Ok(Invocation::Help),
            "--stdio" => Invocation::Stdio,
            "--socket" => port(&arguments.next().ok_or("--socket needs a port")?)?,
            other => match other.strip_prefix("--socket=") {
                Some(value) => port(value)?,
                // Editors add it to every server, with the number the protocol hands over anyway.
                None if other.starts_with("--clientProcessId=") => continue,
                None => return Err(format!("unknown argument `{other}`")),
            },
        };
        if chosen.replace(invocation).is_some() {
            return Err("only one of --stdio and --socket can be used".to_owned());
        }
    }
    chosen.ok_or_else(|| "how to reach the client? --stdio or --socket PORT is needed".to_owned())
}

fn port(value: &str) -> Result<Invocation, String> {
    match value.parse() {
        Ok(port) if port > 0 => Ok(Invocation::Socket(port)),
        _ => Err(format!("`{value}` is not a port: ports go from 1 to 65535")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_line(line: &str) -> Result<Invocation, String> {
        parse(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn every_way_to_start_it_is_understood() {
        assert_eq!(parse_line("--stdio"), Ok(Invocation::Stdio));
        assert_eq!(parse_line("--stdio --clientProcessId=12"), Ok(Invocation::Stdio));
        assert_eq!(parse_line("--socket 4711"), Ok(Invocation::Socket(4711)));
        assert_eq!(parse_line("--socket=4711"), Ok(Invocation::Socket(4711)));
        assert_eq!(parse_line("--version"), Ok(Invocation::Version));
        assert_eq!(parse_line("-h"), Ok(Invocation::Help));
    }

    #[test]
    fn wrong_arguments_are_named() {
        for (line, named) in [
            ("", "--stdio or --socket"),
            ("--stdoi", "`--stdoi`"),
            ("--socket", "needs a port"),
            ("--socket 0", "`0`"),
            ("--socket=70000", "`70000`"),
            ("--stdio --socket 1", "only one"),
        ] {
            let message = parse_line(line).unwrap_err();
            assert!(message.contains(named), "{line}: {message}");
        }
    }
}
