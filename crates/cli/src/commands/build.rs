//! `pydslrep build`: one Python script per environment.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use pydslrep_analysis::FileId;
use pydslrep_config::{Config, Target};
use pydslrep_script::{file_name, generate, may_replace};

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::{lines, program};
use crate::options::target_parser;
use crate::report::output;

const EXAMPLES: &str = "\
Examples:
  pydslrep build patrol.pyr                     writes a script per environment next to it
  pydslrep build rooms/ -o scripts              all programs of a folder
  pydslrep build patrol.pyr --environment hall --stdout | less
  pydslrep build patrol.pyr --target vrep       for V-REP's legacy remote API

The nearest pydslrep.toml above a program sets the default folder and target:
  output = \"scripts\"
  target = \"coppeliasim\"";

/// Write a Python script for each environment of programs
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// Programs, folders with programs, or `-` for standard input [default: this folder]
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The folder to write to, created if missing [default: that of pydslrep.toml, else next to each program]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The simulator that the scripts are for [default: that of pydslrep.toml, else coppeliasim]
    #[arg(long, value_name = "TARGET", value_parser = target_parser())]
    target: Option<Target>,
    /// Only the environment of this name
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// Print the script instead of writing a file
    #[arg(long, conflicts_with = "output")]
    stdout: bool,
}

/// A script and its destination.
struct Script {
    path: PathBuf,
    environment: String,
    lines_in: usize,
    text: String,
}

/// Runs the command.
///
/// # Errors
/// If a script cannot be written, or the arguments do not fit the programs.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let here = [PathBuf::from(".")];
    let paths = if arguments.paths.is_empty() { &here } else { arguments.paths.as_slice() };
    let (inputs, failures) = Inputs::open(paths, &Config::of_target(arguments.target));
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
        for environment in &prepared.environments {
            let text = match generate(environment, inputs.settings(file).target) {
                Ok(text) => text,
                Err(error) => {
                    output::error(&error.to_string(), None);
                    has_errors = true;
                    continue;
                }
            };
            let path = folder(&inputs, file, arguments)?.join(file_name(environment));
            let lines_in = lines::of_program(inputs.database(), file);
            scripts.push(Script { path, environment: environment.name.clone(), lines_in, text });
        }
    }
    failures.iter().for_each(output::fail);
    if let (Some(name), false) = (&arguments.environment, found || inputs.files().is_empty()) {
        return Err(program::no_environment(&inputs, inputs.files(), name));
    }
    if arguments.stdout {
        print(&scripts)?;
    } else {
        write(&scripts)?;
    }
    Ok(ExitCode::from(if failures.is_empty() { u8::from(has_errors) } else { Failure::EXIT_CODE }))
}

fn folder(inputs: &Inputs, file: FileId, arguments: &Arguments) -> Result<PathBuf, Failure> {
    match arguments.output.clone().or_else(|| inputs.script_folder(file)) {
        Some(folder) => Ok(folder),
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
fn write(scripts: &[Script]) -> Result<(), Failure> {
    for (index, script) in scripts.iter().enumerate() {
        if scripts[..index].iter().any(|other| other.path == script.path) {
            return Err(Failure::new(format!("{} would be written twice", script.path.display())).help(
                "two programs have an environment of the same name: build them into different folders",
            ));
        }
        if is_foreign(&script.path) {
            return Err(Failure::new(format!(
                "{} exists and is not a generated script",
                script.path.display()
            ))
            .help("move it away, or choose another folder with -o DIR"));
        }
    }
    for script in scripts {
        if let Some(folder) = script.path.parent() {
            fs::create_dir_all(folder).map_err(|error| Failure::unwritten(folder, &error))?;
        }
        fs::write(&script.path, &script.text).map_err(|error| Failure::unwritten(&script.path, &error))?;
    }
    if scripts.is_empty() { Ok(()) } else { output::print(&report(scripts)) }
}

/// Whether the path holds anything that this command did not write.
fn is_foreign(path: &Path) -> bool {
    match fs::read(path) {
        Ok(bytes) => !may_replace(&bytes),
        Err(_) => path.exists(),
    }
}

fn report(scripts: &[Script]) -> String {
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
    format!("{}\n", table.trim_fmt())
}
