//! `pydslrep scene pull`: a program and its scene file from the scene of a running `CoppeliaSim`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::Args;
use pydslrep_analysis::Severity;
use pydslrep_output::write_new_folder;
use pydslrep_scene::ENDING;
use pydslrep_text::file_names::PROGRAM_EXTENSION as EXTENSION;
use pydslrep_workspace::{MemoryFiles, Workspace, key_of};
use ropey::Rope;
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
    /// The parts of the scene that were not recognised.
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
    check(folder, &program_content, environment, &scene_content)?;
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

/// Checks the files to write as an editor would.
fn check(folder: &Path, program: &str, environment: &str, scene: &str) -> Result<(), Failure> {
    let place = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let (program_path, scene_path) =
        (place.join(format!("program.{EXTENSION}")), place.join(format!("{environment}{ENDING}")));
    let files = MemoryFiles::default();
    files.write(&scene_path, scene);
    let mut workspace = Workspace::new(Arc::new(files));
    let key = key_of(&program_path);
    workspace.open(&key, Rope::from_str(program));
    let in_scene = workspace.problems(&key_of(&scene_path)).into_iter().map(|problem| problem.message);
    let database = workspace.database();
    let of_program = database.file(&key).map(|file| database.diagnostics(file)).unwrap_or_default();
    let in_program = of_program.into_iter().filter(|problem| problem.severity == Severity::Error);
    let mut errors = in_scene.chain(in_program.map(|problem| problem.message));
    match errors.next() {
        None => Ok(()),
        Some(first) => {
            let more = errors.count();
            let more = if more > 0 {
                format!(", and {}", output::count(more, "other error"))
            } else {
                String::new()
            };
            Err(Failure::new(format!("what is in the scene makes no program: {first}{more}"))
                .help("correct the scene in CoppeliaSim; nothing was written"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(radius: f64, name: &str) -> Result<(), Failure> {
        let wheel = |name: &str, y: f64| json!({ "name": name, "radius": radius, "x": 0.0, "y": y });
        let scene: Pulled = serde_json::from_value(json!({
            "robots": [{
                "name": "rover", "type": "tw", "x": 1.0, "y": 0.0, "heading": 0.5, "length": 0.3, "width": 0.3,
                "grip": 1.0, "rim_speed": null, "rim_acceleration": 1.0,
                "wheels": [wheel("l", 0.15), wheel("r", -0.15)], "sensors": [],
            }],
            "obstacles": [{
                "name": name, "x": 5.0, "y": 5.0, "heading": 0.0, "size": [1.0, 1.0], "radius": null, "corners": [],
            }],
        }))
        .unwrap();
        check(Path::new("hall"), &program_text(&scene, "area", 23000), "area", &scene_text(&scene))
    }

    #[test]
    fn what_makes_no_program_is_not_written() {
        assert!(checked(0.045, "the \"crate\"").is_ok());
        for radius in [1e5, 1e300] {
            let Err(Failure::Message { message, .. }) = checked(radius, "crate") else { panic!("{radius}") };
            assert!(message.starts_with("what is in the scene makes no program: "), "{message}");
            assert!(message.len() < 400, "{message}");
        }
    }
}
