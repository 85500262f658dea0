//! `pydslrep check`: what is wrong with programs.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use pydslrep_analysis::{Diagnostic, FileId, Severity};

use crate::failure::Failure;
use crate::output;
use crate::severities::Severities;
use crate::sources::{Sources, count_files};
use crate::{github, json, render};

const EXAMPLES: &str = "\
Examples:
  pydslrep check                         all programs in this folder and below
  pydslrep check patrol.pyr rooms/       one program, and all in a folder
  pydslrep check --format json - < x.pyr
  pydslrep check --deny warnings         for use in CI
  pydslrep check --format github         the same, with marks beside the lines of a pull request
  pydslrep check --severity unused-declaration=off --severity wheel-count=warning";

/// Show what is wrong with programs, and how to mend it
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Programs, folders with programs, or `-` for standard input [default: this folder]
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// How to show problems
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    format: Format,
    /// How bad problems of a code are: off, hint, information, warning or error; for each code once
    #[arg(long, value_name = "CODE=LEVEL")]
    severity: Vec<String>,
    /// End with exit code 1 for these as well
    #[arg(long, value_enum, value_name = "WHAT")]
    deny: Option<Deny>,
}

#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum Format {
    /// With source lines, for people
    #[default]
    Human,
    /// One array, for programs
    Json,
    /// Workflow commands, for GitHub Actions
    Github,
}

/// What is denied beside errors.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Deny {
    Warnings,
}

/// Runs the command.
///
/// # Errors
/// When the arguments do not fit, or nothing can be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let severities = Severities::read(&arguments.severity)?;
    let here = [PathBuf::from(".")];
    let paths = if arguments.paths.is_empty() { &here } else { arguments.paths.as_slice() };
    let (sources, files, failures) = Sources::open(paths);
    let diagnostics = files.iter().flat_map(|file| sources.diagnostics(*file)).collect();
    let diagnostics = severities.applied(diagnostics);
    output::print(&match arguments.format {
        Format::Human => human(&sources, &files, &diagnostics),
        Format::Json => {
            let array = json::array(&sources, &diagnostics);
            array.map_err(|error| Failure::new(format!("cannot write JSON: {error}")))? + "\n"
        }
        Format::Github => github::commands(&sources, &diagnostics),
    })?;
    failures.iter().for_each(output::fail);
    Ok(ExitCode::from(if failures.is_empty() {
        exit_code(&diagnostics, arguments.deny)
    } else {
        Failure::EXIT_CODE
    }))
}

fn human(sources: &Sources, files: &[FileId], diagnostics: &[Diagnostic]) -> String {
    if diagnostics.is_empty() {
        // With nothing read there is nothing to be pleased about.
        return if files.is_empty() {
            String::new()
        } else {
            format!("No problems in {}.\n", count_files(files))
        };
    }
    format!("{}{}.\n", render::diagnostics(sources, diagnostics), render::summary(diagnostics))
}

/// 1 where problems are bad enough.
fn exit_code(diagnostics: &[Diagnostic], deny: Option<Deny>) -> u8 {
    let worst = diagnostics.iter().map(|diagnostic| diagnostic.severity).max();
    let denied = if deny.is_some() { Severity::Warning } else { Severity::Error };
    u8::from(worst >= Some(denied))
}
