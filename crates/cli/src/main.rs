//! The command `pydslrep`.
//!
//! Knows every other crate, files, the terminal and processes; it opens, prints, draws and starts things. Must never
//! have logic of the language, of motion or of scripts: that is asked of the crates below.
//!
//! * [`arguments`]: the command line; each command's own arguments stand with it in [`commands`].
//! * [`inputs`]: programs, what they import and their scenes, from files into the database.
//! * [`texts`], [`paths`]: what stands in files, and what files are called.
//! * [`render`], [`summary`], [`json`], [`github`], [`sarif`]: problems for people and for programs.
//! * [`severities`]: the option that sets severities.
//! * [`fixing`], [`rewrite`]: what is done about them.
//! * [`lines`]: how much people and the generator write.
//! * [`watch`]: when to look again.
//! * [`commands`]: one file per command.
//! * [`python`], [`client`], [`driver`], [`progress`], [`driven`], [`outcome`]: a run, from an interpreter to its result.

mod arguments;
mod commands;
mod failure;
mod fixing;
mod inputs;
mod report;
mod run;
mod severities;
mod target;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use crate::arguments::{Arguments, Command};
use crate::failure::Failure;
use crate::report::output;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => match arguments::suggestion(&error) {
            Some(failure) => {
                output::fail(&failure);
                return ExitCode::from(Failure::EXIT_CODE);
            }
            None => error.exit(),
        },
    };
    arguments.color.write_global();
    let outcome = match arguments.command {
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Build(arguments) => commands::build::run(&arguments),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Sim(arguments) => commands::sim::run(&arguments),
        Command::Plan(arguments) => commands::plan::run(&arguments),
        Command::Fmt(arguments) => commands::fmt::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Stats(arguments) => commands::stats::run(&arguments),
        Command::New(arguments) => commands::new::run(&arguments),
        Command::Lsp(arguments) => commands::lsp::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments, Arguments::command()),
    };
    outcome.unwrap_or_else(|failure| {
        output::fail(&failure);
        ExitCode::from(Failure::EXIT_CODE)
    })
}
