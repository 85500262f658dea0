//! `pydslrep new`: a starter program with its scene.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use crate::failure::Failure;
use crate::help::Help;
use crate::report::output;
use pydslrep_output::write_new_folder;
use pydslrep_scene::ENDING;
use pydslrep_text::file_names::{PROGRAM_EXTENSION as EXTENSION, is_reserved_on_windows};

const HELP: Help = Help {
    examples: &[
        ("pydslrep new patrol", "creates patrol/patrol.pyr and its scene"),
        ("pydslrep run patrol/patrol.pyr", ""),
    ],
    notes: &[],
};

/// Start a program: a robot that drives a square
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// Name of the folder, the program and its environment; letters, digits and `_`
    name: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// If the name is not valid or taken, or the files cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let folder = &arguments.name;
    let name =
        folder.file_name().and_then(|name| name.to_str()).filter(|name| is_name(name)).ok_or_else(|| {
            Failure::new(format!("`{}` cannot be a name in a program", folder.display()))
                .help("use letters, digits and `_`; don't start with a digit: `pydslrep new patrol_1`")
        })?;
    if is_reserved_on_windows(name) {
        return Err(Failure::new(format!("Windows has no files called `{name}`")).help("choose another name"));
    }
    if folder.exists() {
        return Err(Failure::new(format!("{} already exists", folder.display())).help("choose another name"));
    }
    let files = [(format!("{name}.{EXTENSION}"), text(name)), (format!("{name}_area{ENDING}"), scene_text())];
    let files = files.each_ref().map(|(name, text)| (name.as_str(), text.as_str()));
    write_new_folder(folder, &files).map_err(|error| Failure::unwritten(folder, &error))?;
    let [program, scene] = files.map(|(name, _)| folder.join(name));
    output::print(&next_steps(&program, &scene))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns whether a text can be a name in a program.
pub(crate) fn is_name(name: &str) -> bool {
    name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric())
        && !name.starts_with(|c: char| c.is_ascii_digit())
}

/// The program. The ending of its environment's name keeps it from being a keyword or hiding a module of
/// Python's.
fn text(name: &str) -> String {
    format!(
        "\
// {name}: a two-wheeled robot drives a square and comes back to where it started.
//
//   pydslrep check {name}.{EXTENSION}    what is wrong with this program
//   pydslrep run {name}.{EXTENSION}      drive it in the embedded simulator
//   pydslrep build {name}.{EXTENSION}    write its Python script for CoppeliaSim

// Parts. A wheel's name is also that of its joint in the simulator; radii are in centimetres.
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

// A robot of type `tw` has two wheels: left, right.
robot robot_1 type tw with port 23000 has {{ wheelL wheelR }} wheels

// Moves go straight ahead (at 9 cm/s if nothing is said), turns are in place and in degrees (90 if nothing is said).
movement square of robot_1 {{
  move 1 meters
  turn left
  move 1 meters
  turn left
  move 100 centimeters at 15
  turn left
  move 1 meters
  turn left
}}

// The environment says which robots there are and which movements they make, one after the other.
environment {name}_area has {{ robot_1 }} robots with {{ square }} moves
",
    )
}

/// Returns the scene that the robot drives in.
fn scene_text() -> String {
    "\
# What the embedded simulator puts on the floor. Metres and degrees; x is ahead of a robot with heading 0, y to its left.

[world]
size = [4, 4]

# In the middle of the square.
[[box]]
name = \"crate\"
at = [0.5, 0.5]
size = [0.4, 0.4]
heading = 20

# Where the robot starts: x, y and heading.
[robots.robot_1]
start = [0, 0, 0]

# Without this table, robots drive in an ideal world.
# [noise]
# wheel-slip = 2
# sensor = 0.01
"
    .to_owned()
}

fn next_steps(program: &Path, scene: &Path) -> String {
    let (program, scene) = (program.display(), scene.display());
    format!("Created {program} and its scene {scene}. Run it with\n\n    pydslrep run {program}\n")
}
