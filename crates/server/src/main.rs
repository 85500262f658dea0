//! The program `pydslrep-lsp`.

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use pydslrep_server::Arguments;

const EXIT_CODES: &str = "\
Messages for people go to standard error. Exit codes: 0 after `shutdown` and `exit`, 1 if the
client left otherwise, 2 for wrong arguments or a port where nothing listens.";

/// The language server of PyDSLRep, started by editors
#[derive(Debug, Parser)]
#[command(name = "pydslrep-lsp", version, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Program {
    #[command(flatten)]
    arguments: Arguments,
}

fn main() -> ExitCode {
    Program::parse().arguments.serve(command()).unwrap_or_else(|unreachable| {
        let _ = writeln!(io::stderr(), "pydslrep-lsp: {unreachable}");
        ExitCode::from(2)
    })
}

/// The command `pydslrep`: next to this program, otherwise wherever the system finds it.
fn command() -> PathBuf {
    let name = format!("pydslrep{}", std::env::consts::EXE_SUFFIX);
    let sibling = std::env::current_exe().ok().map(|own| own.with_file_name(&name));
    sibling.filter(|path| path.is_file()).unwrap_or_else(|| name.into())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Program::command().debug_assert();
    }

    #[test]
    fn editors_start_it_in_several_ways() {
        for line in [
            "--stdio",
            "--stdio --clientProcessId=12",
            "--socket 4711",
            "--socket=4711",
            "--stdio --edition article",
        ] {
            let words = std::iter::once("pydslrep-lsp").chain(line.split(' '));
            assert!(Program::try_parse_from(words).is_ok(), "{line}");
        }
        for line in
            ["", "--stdoi", "--socket", "--socket=0", "--socket=70000", "--stdio --socket=1", "--edition old"]
        {
            let words = std::iter::once("pydslrep-lsp").chain(line.split_whitespace());
            assert!(Program::try_parse_from(words).is_err(), "{line}");
        }
    }
}
