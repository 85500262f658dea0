//! Scenes: the files `<environment>.scene.toml` beside programs, as the client shows them, else from the disk.

use std::collections::BTreeSet;
use std::path::Path;

use pydslrep_analysis::{EntityId, FileId};
use pydslrep_scene::ENDING;
use pydslrep_syntax::EntityKind;
use rustc_hash::FxHashMap;
use tower_lsp::ls_types::Uri;

use super::State;

/// Which programs have an environment that a scene is about.
#[derive(Debug, Default)]
pub(crate) struct SceneUsers {
    /// By the keys of scenes, whether or not there are such files.
    programs: FxHashMap<String, BTreeSet<FileId>>,
}

impl SceneUsers {
    /// Whether a program has an environment for a scene.
    pub(crate) fn is_wanted(&self, scene: &str) -> bool {
        self.programs.contains_key(scene)
    }

    fn of(&self, scene: &str) -> Vec<FileId> {
        self.programs.get(scene).into_iter().flatten().copied().collect()
    }

    fn add(&mut self, scene: &str, program: FileId) {
        self.programs.entry(scene.to_owned()).or_default().insert(program);
    }

    fn remove(&mut self, scene: &str, program: FileId) {
        if let Some(programs) = self.programs.get_mut(scene) {
            programs.remove(&program);
            if programs.is_empty() {
                self.programs.remove(scene);
            }
        }
    }

    /// The scenes a program has an environment for; all are looked at.
    fn wanted_by(&self, program: FileId) -> Vec<String> {
        let wanted = self.programs.iter().filter(|(_, programs)| programs.contains(&program));
        wanted.map(|(scene, _)| scene.clone()).collect()
    }
}

impl State {
    /// Finds the scenes of environments that came, and lets go of those whose environments went, since this was last
    /// done.
    pub(crate) fn follow_scenes(&mut self) {
        for (file, environment) in self.database.take_changed_environments() {
            let program = self.database.path(file);
            if program.is_empty() {
                // It is closed, and where it was is no longer known.
                self.database.set_scene(file, &environment, None);
                for scene in self.scenes.wanted_by(file) {
                    self.let_go(&scene, file);
                }
                continue;
            }
            let Some(scene) = scene_key(program, &environment) else { continue };
            if self.database.definitions(file, EntityKind::Environment, &environment).is_empty() {
                self.database.set_scene(file, &environment, None);
                self.let_go(&scene, file);
                continue;
            }
            self.scenes.add(&scene, file);
            self.find_scene(&scene);
            let text = self.documents.get(&scene).map(|document| document.text.to_string());
            self.database.set_scene(file, &environment, text.as_deref());
            // There is another program that its names can be checked against.
            self.stale.documents.insert(scene);
        }
    }

    /// Gives the database the text of a scene wherever there is an environment for it.
    pub(crate) fn give_scene(&mut self, scene: &str) {
        let Some(environment) = environment_of(scene) else { return };
        let text = self.documents.get(scene).map(|document| document.text.to_string());
        for file in self.scenes.of(scene) {
            self.database.set_scene(file, environment, text.as_deref());
        }
    }

    /// The file of a scene was created, changed or deleted, by whomever.
    pub(crate) fn scene_file_changed(&mut self, scene: &str, uri: &Uri) {
        // What the client has open is as the client says.
        if self.documents.get(scene).is_some_and(|document| document.version.is_some()) {
            return;
        }
        self.remove(scene);
        if (self.scenes.is_wanted(scene) || self.is_part_of_workspace(scene))
            && let Ok(text) = pydslrep_files::read(Path::new(scene))
        {
            self.insert_from_disk(scene.to_owned(), uri.clone(), &text);
        }
        self.give_scene(scene);
    }

    /// The environment that a scene is about: of the programs beside it the first one has it.
    pub(crate) fn environment_in(&self, scene: &str) -> Option<EntityId> {
        let name = environment_of(scene)?;
        let first = self.scenes.of(scene).into_iter().min_by_key(|file| self.database.path(*file))?;
        self.database.definitions(first, EntityKind::Environment, &name.into()).first().copied()
    }

    /// The scenes, by their keys, that are about environments of a program.
    pub(crate) fn scenes_of(&self, program: FileId) -> Vec<String> {
        let scenes = self.database.scenes().filter(|(file, ..)| *file == program);
        scenes.filter_map(|(file, environment, _)| scene_key(self.database.path(file), environment)).collect()
    }

    fn find_scene(&mut self, scene: &str) {
        if self.documents.contains_key(scene) {
            return;
        }
        let path = Path::new(scene);
        if let (Ok(text), Some(uri)) = (pydslrep_files::read(path), Uri::from_file_path(path)) {
            self.insert_from_disk(scene.to_owned(), uri, &text);
        }
    }

    /// A program has no environment for a scene any more; a file that is nobody's business is forgotten.
    fn let_go(&mut self, scene: &str, program: FileId) {
        self.scenes.remove(scene, program);
        self.stale.documents.insert(scene.to_owned());
        let is_open = self.documents.get(scene).is_some_and(|document| document.version.is_some());
        if !is_open && !self.scenes.is_wanted(scene) && !self.is_in_workspace(scene) {
            self.remove(scene);
        }
    }
}

/// The key of the scene of an environment; `None` for a program that is in no folder.
fn scene_key(program: &str, environment: &str) -> Option<String> {
    let (folder, _) = program.rsplit_once('/').filter(|_| program.starts_with('/'))?;
    Some(format!("{folder}/{environment}{ENDING}"))
}

/// The name of the environment that a scene is about.
fn environment_of(scene: &str) -> Option<&str> {
    scene.rsplit('/').next()?.strip_suffix(ENDING)
}
