//! The command `pydslrep`.
//!
//! Knows every other crate, files, the terminal and processes. Must never have logic of the language, of motion or of
//! scripts: the crates below have it.
//!
//! * [`arguments`]: the command line. [`commands`] has one file per command, with its own arguments; [`options`] what
//!   several of them share.
//! * [`help`]: the examples and notes in the help of commands.
//! * [`inputs`]: the programs a command works on, and the workspace around them.
//! * [`report`]: the output: diagnostics in every format, tables, failures.
//! * [`run`]: a run, from a Python interpreter to its result.
//! * [`fixing`]: `check --fix`.

mod arguments;
mod commands;
mod failure;
mod fixing;
mod help;
mod inputs;
mod options;
mod report;
mod run;

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
    arguments.apply_color();
    let outcome = match arguments.command {
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Build(arguments) => commands::build::run(&arguments),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Sim(arguments) => commands::sim::run(&arguments),
        Command::Scene(arguments) => commands::scene::run(&arguments),
        Command::Plan(arguments) => commands::plan::run(&arguments),
        Command::Replay(arguments) => commands::replay::run(&arguments),
        Command::Preview(arguments) => commands::preview::run(&arguments),
        Command::Doctor(arguments) => commands::doctor::run(&arguments),
        Command::Fmt(arguments) => commands::fmt::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Stats(arguments) => commands::stats::run(&arguments),
        Command::New(arguments) => commands::new::run(&arguments),
        Command::Lsp(arguments) => commands::lsp::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments, Arguments::command()),
        Command::Share(arguments) => commands::share::run(&arguments, Arguments::command()),
        Command::Own(arguments) => commands::own::run(&arguments),
    };
    outcome.unwrap_or_else(|failure| {
        output::fail(&failure);
        ExitCode::from(Failure::EXIT_CODE)
    })
}
