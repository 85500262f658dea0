//! `pydslrep scene`: the scene of a program in a running `CoppeliaSim`, and back out of it.

mod address;
mod json;
mod pull;
mod pulled;
mod push;
mod remove;

use std::process::ExitCode;

use clap::{Args, Subcommand};

use crate::failure::Failure;
use crate::help::Help;

const HELP: Help = Help {
    examples: &[
        ("pydslrep scene push patrol.pyr", "build the program's robots and obstacles in CoppeliaSim"),
        ("pydslrep scene push patrol.pyr --replace", "build them again after a change"),
        ("pydslrep run patrol.pyr --host 127.0.0.1 --port 23000", "drive them there"),
        ("pydslrep scene remove", "take them away; what you made yourself stays"),
        ("pydslrep scene pull hall", "create hall/hall.pyr and its scene from what is there"),
    ],
    notes: &[],
};

/// Build a program's scene in a running CoppeliaSim, or read a scene from there
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    Push(push::Arguments),
    Pull(pull::Arguments),
    Remove(remove::Arguments),
}

/// Runs the command.
///
/// # Errors
/// If anything outside of the program fails.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match &arguments.task {
        Task::Push(arguments) => push::run(arguments),
        Task::Pull(arguments) => pull::run(arguments),
        Task::Remove(arguments) => remove::run(arguments),
    }
}
