//! `pydslrep check`: the problems of programs.

mod watching;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use pydslrep_analysis::{Diagnostic, Severity};
use pydslrep_config::{Config, Edition};

use crate::failure::Failure;
use crate::fixing::{self, Fixed};
use crate::help::Help;
use crate::inputs::scenes::{self, SceneProblem};
use crate::inputs::{Inputs, count_files};
use crate::options::{self, edition_parser};
use crate::report::output::{self, count};
use crate::report::{github, json, render, sarif, summary};

const HELP: Help = Help {
    examples: &[
        ("pydslrep check", "all programs in this folder and below"),
        ("pydslrep check patrol.pyr rooms/", "one program, and all in a folder"),
        ("pydslrep check --format json - < x.pyr", ""),
        ("pydslrep check --fix", "apply all safe fixes, and show what is left"),
        ("pydslrep check --watch", "check again whenever something changes"),
        ("pydslrep check --deny warnings", "for use in CI"),
        ("pydslrep check --format github", "the same, as annotations of a pull request"),
        ("pydslrep check --format sarif > x.sarif", ""),
        ("pydslrep check --severity unused-declaration=off --severity wheel-count=warning", ""),
    ],
    notes: &[
        "The nearest pydslrep.toml above a program sets default severities:\n  [severity]\n  unused-declaration = \"off\"",
    ],
};

/// Check programs for errors, and show how to fix them
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// Programs, folders with programs, or `-` for standard input [default: this folder]
    #[arg(value_name = "PATH", default_value = ".", hide_default_value = true)]
    paths: Vec<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    format: Format,
    /// Apply all safe fixes, and show what is left; a program from standard input goes to standard output
    #[arg(long)]
    fix: bool,
    /// Check again whenever a program, an import, a scene or a pydslrep.toml changes, until Ctrl+C
    #[arg(long, conflicts_with_all = ["fix", "deny"])]
    watch: bool,
    /// Severity of a diagnostic: off, hint, information, warning or error; may be repeated
    #[arg(long, value_name = "CODE=LEVEL")]
    severity: Vec<String>,
    /// Which statements a program may have [default: that of pydslrep.toml, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser())]
    edition: Option<Edition>,
    /// Exit with code 1 for these as well
    #[arg(long, value_enum, value_name = "WHAT")]
    deny: Option<Deny>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    /// With source lines, for people
    #[default]
    Human,
    /// One array, for programs
    Json,
    /// Workflow commands, for GitHub Actions
    Github,
    /// SARIF 2.1.0, for code scanning tools
    Sarif,
}

/// The severities that are denied besides errors.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Deny {
    Warnings,
}

/// Runs the command.
///
/// # Errors
/// If the arguments do not fit together, or nothing can be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let severities = Config::of_severities(options::severities(&arguments.severity)?);
    let options = severities.merged_over(Config::of_edition(arguments.edition));
    let paths = &arguments.paths;
    if arguments.watch {
        if arguments.format != Format::Human {
            return Err(Failure::new("--watch is for people: it cannot be used with another --format")
                .help("leave out one of them"));
        }
        return watching::run(paths, &options);
    }
    let (mut inputs, mut failures) = Inputs::open(paths, &options);
    inputs.check_settings()?;
    let fixed = if arguments.fix {
        let mut fixed = fixing::fix(&mut inputs);
        fixed.write(&mut inputs, &mut failures)?;
        Some(fixed)
    } else {
        None
    };
    let mut diagnostics = inputs.all_diagnostics();
    inputs.retain_offered(&mut diagnostics);
    let (scene_problems, unread) = inputs.scene_problems();
    failures.extend(unread);
    let report = report(arguments.format, &inputs, &diagnostics, &scene_problems)?;
    if fixed.is_some() && inputs.files().iter().any(|file| inputs.place(*file).is_none()) {
        // The fixed program is on standard output.
        output::say(&report);
    } else {
        output::print(&report)?;
    }
    if let Some(fixed) = &fixed {
        output::say(&fix_summary(fixed, &diagnostics));
    }
    failures.iter().for_each(output::fail);
    Ok(ExitCode::from(if failures.is_empty() {
        exit_code(&diagnostics, &scene_problems, arguments.deny)
    } else {
        Failure::EXIT_CODE
    }))
}

fn report(
    format: Format,
    inputs: &Inputs,
    diagnostics: &[Diagnostic],
    scene_problems: &[SceneProblem],
) -> Result<String, Failure> {
    match format {
        Format::Human => Ok(human(inputs, diagnostics, scene_problems)),
        Format::Json => json::array(inputs, diagnostics, scene_problems),
        Format::Sarif => sarif::log(inputs, diagnostics, scene_problems),
        Format::Github => Ok(github::commands(inputs, diagnostics, scene_problems)),
    }
}

fn human(inputs: &Inputs, diagnostics: &[Diagnostic], scene_problems: &[SceneProblem]) -> String {
    let problems = render::diagnostics(inputs, diagnostics) + &scenes::render(scene_problems);
    summary(inputs, diagnostics, scene_problems)
        .map_or(problems.clone(), |summary| format!("{problems}{summary}\n"))
}

/// Returns the number of problems, in one line; `None` if nothing was read.
fn summary(inputs: &Inputs, diagnostics: &[Diagnostic], scene_problems: &[SceneProblem]) -> Option<String> {
    if diagnostics.is_empty() && scene_problems.is_empty() {
        let files = inputs.files();
        return (!files.is_empty()).then(|| format!("No problems in {}.", count_files(files)));
    }
    let summary = summary::summary(inputs, diagnostics, scene_problems);
    let is_fixable = |diagnostic: &&Diagnostic| diagnostic.fixes.iter().any(|fix| fix.safe);
    Some(match diagnostics.iter().filter(is_fixable).count() {
        0 => format!("{summary}."),
        some => format!("{summary}; {some} fixable with `--fix`."),
    })
}

/// Describes the fixes made.
fn fix_summary(fixed: &Fixed, left: &[Diagnostic]) -> String {
    match (fixed.count(), left) {
        (0, []) => String::new(),
        (0, _) => "Nothing was fixed: each of these problems needs a decision.\n".to_owned(),
        (some, _) => {
            format!("Fixed {} in {}.\n", count(some, "problem"), count(fixed.problems.len(), "file"))
        }
    }
}

/// 1 where problems are bad enough.
fn exit_code(diagnostics: &[Diagnostic], scene_problems: &[SceneProblem], deny: Option<Deny>) -> u8 {
    let in_scenes = scene_problems.iter().map(|_| scenes::SEVERITY);
    let worst = diagnostics.iter().map(|diagnostic| diagnostic.severity).chain(in_scenes).max();
    let denied = if deny.is_some() { Severity::Warning } else { Severity::Error };
    u8::from(worst >= Some(denied))
}
