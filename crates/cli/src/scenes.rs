//! The scene of an environment: what its scene file says, else an empty floor.

use std::path::{Path, PathBuf};

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{EntityId, FileId};
use pydslrep_files::{read, without_mark};
use pydslrep_scene::{ENDING, Scene};

use crate::failure::Failure;
use crate::paths::{near, shown};
use crate::render;
use crate::sources::Sources;
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
    Err(Failure::Shown(
        problems.iter().map(|problem| render::problem(&shown(&path), text, problem)).collect(),
    ))
}

fn beside(environment: &Environment, program: &Path) -> Option<PathBuf> {
    let path = path(program, &environment.name);
    path.exists().then(|| near(&path))
}

/// Where the scene of an environment of a program would be.
fn path(program: &Path, environment: &str) -> PathBuf {
    program.with_file_name(format!("{environment}{ENDING}"))
}

/// Where the scenes of all environments of a program would be, with the environments' names.
pub(crate) fn paths(sources: &Sources, file: FileId) -> Vec<(String, PathBuf)> {
    let Some(program) = sources.place(file) else { return Vec::new() };
    let environments = sources.database.environments(file).into_iter();
    environments.map(|(_, name)| (name.text.to_string(), path(program, &name.text))).collect()
}

/// Tells the database which scenes there are, so that it can tell what is in the way. A scene that cannot be read, or
/// that is wrong, is a matter of those who drive in it.
pub(crate) fn tell(sources: &mut Sources, files: &[FileId]) {
    for file in files {
        for (environment, path) in paths(sources, *file) {
            let text = read(&path).ok();
            sources.database.set_scene(*file, &environment, text.as_deref().map(without_mark));
        }
    }
}

/// The same of a scene that was named for one environment. One that cannot be read is told of later.
pub(crate) fn tell_named(sources: &mut Sources, file: FileId, environment: EntityId, named: Option<&Path>) {
    let name = sources.database.tree(environment).and_then(|tree| tree.name()).map(|name| name.text.clone());
    if let (Some(name), Some(Ok(text))) = (name, named.map(read)) {
        sources.database.set_scene(file, &name, Some(without_mark(&text)));
    }
}
