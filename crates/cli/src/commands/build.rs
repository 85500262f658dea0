//! `pydslrep build`: one Python script per environment.

use std::cell::LazyCell;
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use pydslrep_analysis::FileId;
use pydslrep_config::{Config, Edition, Target};
use pydslrep_output::{
    Changed, RuntimeFolder, check_inside, check_script, has_runtime, write_runtime, write_script,
};
use pydslrep_script::{file_name, generate};

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::Inputs;
use crate::inputs::{lines, program};
use crate::options::{edition_parser, target_parser};
use crate::report::output;

const HELP: Help = Help {
    examples: &[
        ("pydslrep build patrol.pyr", "writes a script per environment next to it"),
        ("pydslrep build rooms/ -o scripts", "all programs of a folder"),
        ("pydslrep build patrol.pyr --environment hall --stdout | less", ""),
        ("pydslrep build patrol.pyr --target vrep", "for V-REP's legacy remote API"),
        ("pydslrep build patrol.pyr --force", "also replaces scripts that you changed"),
    ],
    notes: &[
        "Scripts import the Python package pydslrep_runtime, whose folder is written next to them unless \
         it is installed in your Python. It is replaced when its version differs, and kept if you change \
         it.",
        "The nearest pydslrep.toml above a program sets the defaults:\n  output = \"scripts\"\n  target = \
         \"coppeliasim\"\n  write-runtime = false",
    ],
};

/// Write a Python script for each environment of programs
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// Programs, folders with programs, or `-` for standard input [default: this folder]
    #[arg(value_name = "PATH", default_value = ".", hide_default_value = true)]
    paths: Vec<PathBuf>,
    /// The folder to write to, created if missing [default: that of pydslrep.toml, else next to each program]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The simulator that the scripts are for [default: that of pydslrep.toml, else coppeliasim]
    #[arg(long, value_name = "TARGET", value_parser = target_parser())]
    target: Option<Target>,
    /// Which statements a program may have [default: that of pydslrep.toml, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser())]
    edition: Option<Edition>,
    /// Only the environment of this name
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// Print the script instead of writing a file
    #[arg(long, conflicts_with = "output")]
    stdout: bool,
    /// Replace scripts that were changed since they were generated
    #[arg(long, conflicts_with = "stdout")]
    force: bool,
    /// Do not write the folder `pydslrep_runtime`, which scripts import
    #[arg(long)]
    no_runtime: bool,
}

/// A script and its destination.
struct Script {
    path: PathBuf,
    environment: String,
    lines_in: usize,
    text: String,
    /// True if the package that it imports is written next to it.
    needs_runtime: bool,
}

/// Runs the command.
///
/// # Errors
/// If a script cannot be written, or the arguments do not fit the programs.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let options = Config::of_target(arguments.target).merged_over(Config::of_edition(arguments.edition));
    let (inputs, failures) = Inputs::open(&arguments.paths, &options);
    inputs.check_settings()?;
    let mut scripts = Vec::new();
    let (mut has_errors, mut found) = (false, false);
    for &file in inputs.files() {
        let ids = program::environments(&inputs, file, arguments.environment.as_deref());
        if ids.is_empty() && arguments.environment.is_some() {
            continue;
        }
        found |= !ids.is_empty();
        let prepared = program::prepare(&inputs, file, &ids);
        has_errors |= prepared.has_errors;
        if ids.is_empty() {
            output::say(&format!("{} has no environment: nothing to generate\n", inputs.shown(file)));
        }
        let settings = inputs.settings(file);
        let lines_in = LazyCell::new(|| lines::of_program(inputs.database(), file));
        for environment in &prepared.environments {
            let text = match generate(environment, settings.target, &inputs.file_name(file)) {
                Ok(text) => text,
                Err(error) => {
                    output::error(&error.to_string(), None);
                    has_errors = true;
                    continue;
                }
            };
            let path = folder(&inputs, file, arguments)?.join(file_name(environment));
            let needs_runtime = settings.write_runtime && !arguments.no_runtime;
            let environment = environment.name.clone();
            scripts.push(Script { path, environment, lines_in: *lines_in, text, needs_runtime });
        }
    }
    failures.iter().for_each(output::fail);
    if let (Some(name), false) = (&arguments.environment, found || inputs.files().is_empty()) {
        return Err(program::no_environment(&inputs, inputs.files(), name));
    }
    if arguments.stdout {
        print(&scripts)?;
    } else {
        write(&scripts, if arguments.force { Changed::Replace } else { Changed::Keep })?;
    }
    Ok(ExitCode::from(if failures.is_empty() { u8::from(has_errors) } else { Failure::EXIT_CODE }))
}

fn folder(inputs: &Inputs, file: FileId, arguments: &Arguments) -> Result<PathBuf, Failure> {
    if let Some(folder) = &arguments.output {
        return Ok(folder.clone());
    }
    match inputs.script_folder(file) {
        Some(folder) => {
            check_inside(&folder, inputs.settings(file).output_depth())?;
            Ok(folder)
        }
        None if arguments.stdout => Ok(PathBuf::new()),
        None => Err(Failure::new("no folder for the script of a program from standard input")
            .help("choose one with -o DIR, or use --stdout")),
    }
}

fn print(scripts: &[Script]) -> Result<(), Failure> {
    match scripts {
        [] => Ok(()),
        [script] => output::print(&script.text),
        several => {
            let names: Vec<String> =
                several.iter().map(|script| format!("`{}`", script.environment)).collect();
            Err(Failure::new(format!("--stdout prints one script, but there are {}", names.len()))
                .help(format!("choose one with --environment NAME: {}", names.join(", "))))
        }
    }
}

/// Writes all scripts; or none, if one of them cannot be written where it belongs.
fn write(scripts: &[Script], changed: Changed) -> Result<(), Failure> {
    let mut paths = HashSet::new();
    for script in scripts {
        if !paths.insert(&script.path) {
            return Err(Failure::new(format!("{} would be written twice", script.path.display())).help(
                "two programs have an environment of the same name: build them into different folders",
            ));
        }
        check_script(&script.path, changed)?;
    }
    for script in scripts {
        write_script(&script.path, &script.text, changed)?;
    }
    let runtimes = write_runtimes(scripts)?;
    if scripts.is_empty() {
        return Ok(());
    }
    output::print(&report(scripts, &runtimes))?;
    for runtime in &runtimes {
        if let RuntimeFolder::Kept(kept) = runtime {
            output::warning(&kept.to_string(), Some(&kept.help()));
        }
    }
    Ok(())
}

/// Writes the package that scripts import, once for each folder.
fn write_runtimes(scripts: &[Script]) -> Result<Vec<RuntimeFolder>, Failure> {
    let needing = scripts.iter().filter(|script| script.needs_runtime);
    let folders: BTreeSet<&Path> = needing.filter_map(|script| script.path.parent()).collect();
    let is_installed = LazyCell::new(has_runtime);
    folders.into_iter().map(|folder| Ok(write_runtime(folder, || *is_installed)?)).collect()
}

fn report(scripts: &[Script], runtimes: &[RuntimeFolder]) -> String {
    let mut table = output::table(["environment", "script", "lines of program", "lines of Python"]);
    for script in scripts {
        table.add_row([
            script.environment.clone(),
            script.path.display().to_string(),
            script.lines_in.to_string(),
            lines::of_python(&script.text).to_string(),
        ]);
    }
    output::align_right(&mut table, &[2, 3]);
    let is_news =
        |runtime: &&RuntimeFolder| !matches!(runtime, RuntimeFolder::Current(_) | RuntimeFolder::Kept(_));
    let news: BTreeSet<String> = runtimes.iter().filter(is_news).map(RuntimeFolder::to_string).collect();
    let news: String = news.iter().map(|line| output::wrapped(line) + "\n").collect();
    let gap = if news.is_empty() { "" } else { "\n" };
    format!("{}\n{gap}{news}", table.trim_fmt())
}
