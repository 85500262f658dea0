//! `pydslrep fmt`: programs in their canonical layout.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use clap::builder::styling::{AnsiColor, Style};
use pydslrep_syntax::{apply_edits, format_edits, parse};
use similar::TextDiff;

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::read::{Found, Source, read_programs};
use crate::inputs::rewrite::replace;
use crate::report::output::{self, count};

const HELP: Help = Help {
    examples: &[
        ("pydslrep fmt", "all programs in this folder and those in it"),
        ("pydslrep fmt --diff patrol.pyr", "what would change"),
        ("pydslrep fmt --check", "for use in CI: exit code 1 if anything would"),
        ("pydslrep fmt - < patrol.pyr", "from standard input to standard output"),
    ],
    notes: &[],
};

/// Format programs: indentation, blank lines, spaces, commas
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// Programs, folders with programs, or `-` for standard input [default: this folder]
    #[arg(value_name = "PATH", default_value = ".", hide_default_value = true)]
    paths: Vec<PathBuf>,
    /// Write nothing; say which programs would change, and end with exit code 1 if any would
    #[arg(long)]
    check: bool,
    /// Write nothing; show what would change, and end with exit code 1 if anything would
    #[arg(long)]
    diff: bool,
}

/// A program and its canonical layout.
struct Formatted {
    source: Source,
    text: String,
    /// True if errors kept a part of it from being formatted.
    has_errors: bool,
}

impl Formatted {
    fn of(source: Source) -> Self {
        let pieces = parse(&source.text);
        let edits = format_edits(&source.text, pieces.iter().map(|(span, parse)| (*span, parse)));
        let text = apply_edits(&source.text, &edits);
        let has_errors = pieces.iter().any(|(_, parse)| !parse.errors.is_empty());
        Self { source, text, has_errors }
    }

    fn changes(&self) -> bool {
        self.source.text != self.text
    }
}

/// Runs the command.
///
/// # Errors
/// When nothing can be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Found { programs, mut failures, .. } = read_programs(&arguments.paths);
    let programs: Vec<Formatted> = programs.into_iter().map(Formatted::of).collect();
    let only_looks = arguments.check || arguments.diff;
    if arguments.diff {
        output::print(&programs.iter().map(diff).collect::<String>())?;
    }
    if arguments.check {
        output::print(&listed(&programs))?;
    }
    if !only_looks {
        write(&programs, &mut failures)?;
    }
    programs.iter().filter(|program| program.has_errors).for_each(say_what_stayed);
    failures.iter().for_each(output::fail);
    let is_wrong = |program: &Formatted| program.has_errors || only_looks && program.changes();
    Ok(ExitCode::from(if failures.is_empty() {
        u8::from(programs.iter().any(is_wrong))
    } else {
        Failure::EXIT_CODE
    }))
}

/// Writes changed programs back.
fn write(programs: &[Formatted], failures: &mut Vec<Failure>) -> Result<(), Failure> {
    let (mut changed, mut unchanged) = (0, 0);
    for program in programs {
        match &program.source.place {
            None => output::print_raw(&program.text)?,
            Some(_) if !program.changes() => unchanged += 1,
            Some(place) => match replace(place, &program.source.text, &program.text) {
                Ok(()) => changed += 1,
                Err(failure) => failures.push(failure),
            },
        }
    }
    let report = match (changed, unchanged) {
        (0, 0) => return Ok(()),
        (0, _) => format!("{} laid out already.\n", count(unchanged, "file")),
        (_, 0) => format!("{} formatted.\n", count(changed, "file")),
        _ => format!("{} formatted, {unchanged} laid out already.\n", count(changed, "file")),
    };
    if programs.iter().any(|program| program.source.place.is_none()) {
        // Standard output has a program on it.
        output::say(&report);
        return Ok(());
    }
    output::print(&report)
}

fn listed(programs: &[Formatted]) -> String {
    let changing = programs.iter().filter(|program| program.changes());
    let names: Vec<String> =
        changing.map(|program| format!("would format {}\n", program.source.shown)).collect();
    match (names.len(), programs.len()) {
        (0, 0) => String::new(),
        (0, all) => format!("{} laid out already.\n", count(all, "file")),
        (some, _) => {
            format!("{}{} would be formatted; `pydslrep fmt` does it.\n", names.concat(), count(some, "file"))
        }
    }
}

/// A unified diff, as `patch` reads it.
fn diff(program: &Formatted) -> String {
    let shown = &program.source.shown;
    let diff = TextDiff::from_lines(program.source.text.as_str(), program.text.as_str());
    let unified = diff.unified_diff().header(shown, shown).to_string();
    unified.split_inclusive('\n').map(coloured).collect()
}

fn coloured(line: &str) -> String {
    let style = match line.as_bytes().first() {
        Some(b'-') => AnsiColor::Red.on_default(),
        Some(b'+') => AnsiColor::Green.on_default(),
        Some(b'@') => AnsiColor::Cyan.on_default(),
        _ => Style::new(),
    };
    let text = line.trim_end_matches(['\n', '\r']);
    format!("{style}{text}{style:#}{}", &line[text.len()..])
}

fn say_what_stayed(program: &Formatted) {
    let Source { shown, place, .. } = &program.source;
    let path = if place.is_some() { shown } else { "-" };
    output::error(
        &format!("{shown} has syntax errors: the entities they are in were left as they are"),
        Some(&format!("`pydslrep check {path}` shows how to fix them")),
    );
}
