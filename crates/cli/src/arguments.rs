//! The command line.

use std::path::Path;

use clap::builder::styling::{AnsiColor, Effects, Styles};
use clap::error::{ContextKind, ContextValue};
use clap::{ColorChoice, Parser, Subcommand};
use pydslrep_workspace::DocumentKind;

use crate::commands::{
    build, check, completions, doctor, explain, fmt, lsp, new, own, plan, preview, replay, run, scene, share,
    sim, stats,
};
use crate::failure::Failure;
use crate::help::{self, Help};

/// Cargo's own colours.
const STYLES: Styles = Styles::styled()
    .header(AnsiColor::BrightGreen.on_default().effects(Effects::BOLD))
    .usage(AnsiColor::BrightGreen.on_default().effects(Effects::BOLD))
    .literal(AnsiColor::BrightCyan.on_default().effects(Effects::BOLD))
    .placeholder(AnsiColor::Cyan.on_default());

const HELP: Help = Help {
    examples: &[
        ("pydslrep new patrol", "create a program that drives a square"),
        ("pydslrep check patrol/patrol.pyr", "show its errors and how to fix them"),
        ("pydslrep run patrol/patrol.pyr", "run it in the embedded simulator"),
        ("pydslrep build patrol/patrol.pyr", "generate its Python script for CoppeliaSim"),
    ],
    notes: &[
        "Exit codes: 0 fine, 1 errors in the program or a movement that failed, 2 wrong use or an outside \
         failure (file, port, missing Python), 130 interrupted.",
    ],
};

/// Check, plan and run programs for mobile robots, and generate Python scripts for the simulators CoppeliaSim and V-REP.
#[derive(Debug, Parser)]
#[command(name = "pydslrep", version, styles = STYLES, after_help = HELP.text(), propagate_version = true)]
#[command(term_width = help::columns())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// When to use colours; `auto` uses them on terminals unless `NO_COLOR` is set.
    #[arg(
        long,
        global = true,
        value_enum,
        default_value_t,
        value_name = "WHEN",
        hide_possible_values = true
    )]
    #[arg(help = "When to use colours: auto, always or never")]
    color: ColorChoice,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Check(check::Arguments),
    Build(build::Arguments),
    // By far the largest.
    Run(Box<run::Arguments>),
    Sim(sim::Arguments),
    Scene(scene::Arguments),
    Plan(plan::Arguments),
    Replay(replay::Arguments),
    Preview(preview::Arguments),
    Doctor(doctor::Arguments),
    Fmt(fmt::Arguments),
    Explain(explain::Arguments),
    Stats(stats::Arguments),
    New(new::Arguments),
    Lsp(lsp::Arguments),
    Completions(completions::Arguments),
    #[command(hide = true)]
    Share(share::Arguments),
    #[command(name = "self")]
    Own(own::Arguments),
}

impl Arguments {
    /// Applies the choice of colours to everything that is printed from now on.
    pub(crate) fn apply_color(&self) {
        match self.color {
            ColorChoice::Auto => anstream::ColorChoice::Auto,
            ColorChoice::Always => anstream::ColorChoice::Always,
            ColorChoice::Never => anstream::ColorChoice::Never,
        }
        .write_global();
    }
}

/// A suggestion if a program is in the place of a command.
pub(crate) fn suggestion(error: &clap::Error) -> Option<Failure> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let path = Path::new(word);
    let command = if path.is_dir() {
        "check"
    } else if path.is_file() || DocumentKind::of_file(path) == Some(DocumentKind::Program) {
        "run"
    } else {
        return None;
    };
    let failure = Failure::new(format!("there is no command `{word}`"));
    Some(failure.help(format!("did you mean `pydslrep {command} {word}`?")))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Arguments::command().debug_assert();
    }
}
