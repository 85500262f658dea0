//! `pydslrep scene push`: builds the scene of a program.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use pydslrep_config::Config;
use serde::Deserialize;
use serde_json::json;

use crate::failure::Failure;
use crate::inputs::{Inputs, program};
use crate::report::output;
use crate::run::interrupt;
use crate::run::scene_description::describe;

use super::address::{Address, Simulator};
use super::json::report_json;

/// Build a program's robots and obstacles in a running CoppeliaSim
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input
    program: PathBuf,
    /// The environment to build; required if there are several
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// The scene to build [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Replace what an earlier push has made; nothing else is touched
    #[arg(long)]
    replace: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    address: Address,
}

#[derive(Debug, Deserialize)]
struct Answer {
    /// Further changes, and those that failed.
    notes: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// If anything outside of the program fails.
pub(super) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (mut inputs, file) = Inputs::open_one(&arguments.program, &Config::default())?;
    let id = program::environment(&inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let Some(environment) = program::prepare(&inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let scene = inputs.scene(file, &environment)?;
    let reach = pydslrep_analysis::reach(&environment, &scene)
        .map_err(|error| Failure::new(format!("`{}` cannot be built: {error}", environment.name)))?;
    let parameters = json!({
        "scene": describe(&environment.name, &scene, reach),
        "replace": arguments.replace,
    });
    let simulator = arguments.address.with(&inputs.settings(file).coppeliasim);
    let answer = simulator.ask::<Answer>("push", parameters);
    if arguments.json {
        let built = |answer: Answer| json!({ "robots": scene.robots.len(), "obstacles": scene.obstacles.len(), "notes": answer.notes });
        return report_json(answer, built);
    }
    let Some(answer) = answer? else {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    for note in &answer.notes {
        output::warning(note, None);
    }
    let Simulator { host, port, .. } = simulator;
    output::print(&format!(
        "Built {} and {} in CoppeliaSim at {host}:{port}. Run the program there with\n\n    pydslrep run {} --host {host} --port {port}\n",
        output::count(scene.robots.len(), "robot"),
        output::count(scene.obstacles.len(), "obstacle"),
        arguments.program.display(),
    ))?;
    Ok(ExitCode::SUCCESS)
}
