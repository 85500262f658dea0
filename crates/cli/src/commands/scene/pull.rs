//! `pydslrep scene pull`: a program and its scene file from what is in a running `CoppeliaSim`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use pydslrep_output::write_new_folder;
use pydslrep_scene::ENDING;
use pydslrep_text::file_names::PROGRAM_EXTENSION as EXTENSION;
use serde::Deserialize;
use serde_json::json;

use super::address::Address;
use super::pulled::{Pulled, program_text, scene_text};
use crate::commands::new::is_name;
use crate::failure::Failure;
use crate::inputs::settings_here;
use crate::report::output;
use crate::run::interrupt;

/// Write a program and its scene file from the robots and obstacles in a running CoppeliaSim
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Name of the folder and of the program in it; letters, digits and `_`
    name: PathBuf,
    /// The environment [default: `NAME_area`]
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    #[command(flatten)]
    address: Address,
}

#[derive(Debug, Deserialize)]
struct Answer {
    scene: Pulled,
    /// What was not understood.
    unclear: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// If the simulator does not reply, it has no robot, or the folder exists.
pub(super) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let folder = &arguments.name;
    let name = folder.file_name().and_then(|name| name.to_str()).filter(|name| is_name(name));
    let environment = match (name, &arguments.environment) {
        (Some(name), None) => format!("{name}_area"),
        (Some(_), Some(environment)) if is_name(environment) => environment.clone(),
        _ => {
            return Err(Failure::new("that cannot be a name in a program")
                .help("use letters, digits and `_`; don't start with a digit"));
        }
    };
    if folder.exists() {
        return Err(Failure::new(format!("{} already exists", folder.display())).help("choose another name"));
    }
    let simulator = arguments.address.with(&settings_here()?.coppeliasim);
    let Some(answer) = simulator.ask::<Answer>("pull", json!({ "environment": environment }))? else {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    let (scene, mut unclear) = (answer.scene.with_distinct_wheels(), answer.unclear);
    unclear.extend(scene.unclear.iter().cloned());
    for note in &unclear {
        output::warning(note, None);
    }
    if scene.robots.is_empty() {
        return Err(Failure::new("the scene has no robot whose wheels turn by velocity")
            .help("wheels are shapes below revolute joints in velocity control, below one dynamic body"));
    }
    write(folder, name.unwrap_or_default(), &environment, &scene, simulator.port)?;
    Ok(ExitCode::SUCCESS)
}

fn write(folder: &Path, name: &str, environment: &str, scene: &Pulled, port: u16) -> Result<(), Failure> {
    let (program, file) = (format!("{name}.{EXTENSION}"), format!("{environment}{ENDING}"));
    let (program_content, scene_content) = (program_text(scene, environment, port), scene_text(scene));
    let files = [(program.as_str(), program_content.as_str()), (file.as_str(), scene_content.as_str())];
    write_new_folder(folder, &files).map_err(|error| Failure::unwritten(folder, &error))?;
    output::print(&format!(
        "Created {} and its scene {}: {} and {}.\n",
        folder.join(&program).display(),
        folder.join(&file).display(),
        output::count(scene.robots.len(), "robot"),
        output::count(scene.obstacles.len(), "obstacle"),
    ))
}
