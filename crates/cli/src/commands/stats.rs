//! `pydslrep stats`: how much shorter a program is than its scripts.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use pydslrep_config::Config;
use pydslrep_script::{Target, generate, runtime};
use serde::Serialize;

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::Inputs;
use crate::inputs::{lines, program};
use crate::report::output;

const HELP: Help = Help {
    examples: &[("pydslrep stats patrol.pyr", ""), ("pydslrep stats patrol.pyr --json", "")],
    notes: &[],
};

/// Count the lines of a program and those of its scripts
///
/// Lines that are blank or hold nothing but comments do not count; what the program imports does. The package that scripts
/// import is counted apart.
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input
    program: PathBuf,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// Lines of a program against lines of Python.
#[derive(Debug, Serialize)]
struct Lines {
    program: usize,
    python: usize,
    /// Percent of the lines of Python that the program saves.
    saved: f64,
}

impl Lines {
    #[expect(clippy::cast_precision_loss, reason = "numbers of lines are far below 2^52")]
    fn new(program: usize, python: usize) -> Self {
        let saved = if python == 0 { 0.0 } else { 100.0 * (1.0 - program as f64 / python as f64) };
        Self { program, python, saved }
    }

    fn cells(&self) -> [String; 3] {
        [self.program.to_string(), self.python.to_string(), format!("{:.1} %", self.saved)]
    }
}

#[derive(Debug, Serialize)]
struct Script {
    environment: String,
    #[serde(flatten)]
    lines: Lines,
}

#[derive(Debug, Serialize)]
struct Stats {
    environments: Vec<Script>,
    /// The program once against all of its scripts.
    total: Lines,
    /// Lines of the package that every script imports.
    runtime: usize,
}

/// Runs the command.
///
/// # Errors
/// When the program cannot be read or has no environment, or nothing can be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (inputs, file) = Inputs::open_one(&arguments.program, &Config::default())?;
    let ids = program::environments(&inputs, file, None);
    if ids.is_empty() {
        // The error of this has advice.
        program::environment(&inputs, file, None)?;
    }
    let prepared = program::prepare(&inputs, file, &ids);
    let mut has_errors = prepared.has_errors;
    let in_program = lines::of_program(inputs.database(), file);
    let mut environments = Vec::new();
    for environment in &prepared.environments {
        match generate(environment, Target::CoppeliaSim, &inputs.file_name(file)) {
            Ok(script) => environments.push(Script {
                environment: environment.name.clone(),
                lines: Lines::new(in_program, lines::of_python(&script)),
            }),
            Err(error) => {
                output::error(&error.to_string(), None);
                has_errors = true;
            }
        }
    }
    let in_python = environments.iter().map(|script| script.lines.python).sum();
    let runtime = lines_of_runtime();
    let stats = Stats { environments, total: Lines::new(in_program, in_python), runtime };
    if arguments.json {
        output::print(&output::json(&stats)?)?;
    } else if !stats.environments.is_empty() {
        output::print(&table(&stats))?;
    }
    Ok(ExitCode::from(u8::from(has_errors)))
}

fn lines_of_runtime() -> usize {
    let files = runtime::files().into_iter();
    files.map(|file| lines::of_python(&String::from_utf8_lossy(&file.content))).sum()
}

fn table(stats: &Stats) -> String {
    let mut table = output::table(["environment", "lines of program", "lines of Python", "saved"]);
    let mut add = |name: &str, lines: &Lines| {
        let [program, python, saved] = lines.cells();
        table.add_row([name.to_owned(), program, python, saved]);
    };
    for script in &stats.environments {
        add(&script.environment, &script.lines);
    }
    if stats.environments.len() > 1 {
        add("total", &stats.total);
    }
    output::align_right(&mut table, &[1, 2, 3]);
    let runtime =
        format!("{}, which scripts import, has {} more lines of Python", runtime::NAME, stats.runtime);
    format!("{}\n\n{}\n", table.trim_fmt(), output::wrapped(&runtime))
}
