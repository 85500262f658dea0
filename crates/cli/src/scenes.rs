//! The scene that an environment is driven in: what its scene file says, else an empty floor.

use std::path::{Path, PathBuf};

use pydslrep_analysis::environment::Environment;
use pydslrep_files::without_mark;
use pydslrep_scene::Scene;

use crate::failure::Failure;
use crate::paths::{near, scene_path, shown};
use crate::render;
use crate::texts::read_file;

/// The scene that an environment of a program is to be driven in: of the file that was named, else of the one beside
/// the program, `<environment>.scene.toml`, if there is one.
///
/// # Errors
/// When the file cannot be read, and with everything that is wrong in it: what robots would meet could be another
/// thing than what was meant.
pub(crate) fn scene(
    environment: &Environment,
    program: Option<&Path>,
    named: Option<&Path>,
) -> Result<Scene, Failure> {
    let floor = pydslrep_analysis::scene(environment);
    let Some(path) = named.map(Path::to_owned).or_else(|| beside(environment, program?)) else {
        return Ok(floor);
    };
    let whole = read_file(&path)?;
    let text = without_mark(&whole);
    let (scene, problems) = pydslrep_scene::read(text, floor);
    if problems.is_empty() {
        return Ok(scene);
    }
    Err(Failure::Rendered(
        problems.iter().map(|problem| render::problem(&shown(&path), text, problem)).collect(),
    ))
}

fn beside(environment: &Environment, program: &Path) -> Option<PathBuf> {
    let path = scene_path(program, &environment.name);
    path.exists().then(|| near(&path))
}
