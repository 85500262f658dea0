//! Scenes: the files `<environment>.scene.toml` beside programs.

use pydslrep_analysis::{EntityId, FileId};
use pydslrep_syntax::EntityKind;
use pydslrep_text::file_names::SCENE_SUFFIX;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

use crate::keys::path_of;
use crate::settings::folder;
use crate::{ReadError, Workspace};

/// Which programs have the environment of a scene.
#[derive(Debug, Clone, Default)]
pub(crate) struct SceneUsers {
    /// By the keys of scenes, whether or not there are such files.
    programs: FxHashMap<String, BTreeSet<FileId>>,
}

impl SceneUsers {
    /// Returns whether a program has the environment of a scene.
    pub(crate) fn has_users(&self, scene: &str) -> bool {
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

    /// The scenes that a program has an environment for; visits all of them.
    fn used_by(&self, program: FileId) -> Vec<String> {
        let used = self.programs.iter().filter(|(_, programs)| programs.contains(&program));
        used.map(|(scene, _)| scene.clone()).collect()
    }
}

impl Workspace {
    /// The keys of the scenes of all environments of a program, with the environments; whether or not there are such
    /// files.
    pub fn scene_keys(&self, program: FileId) -> Vec<(EntityId, String)> {
        let path = self.database.path(program);
        let environments = self.database.environments(program).into_iter();
        environments.filter_map(|(id, name)| Some((id, scene_key(path, &name.text)?))).collect()
    }

    /// The key of the scene of an environment of a program, whether or not there is such a file.
    pub fn scene_key(&self, program: FileId, environment: &str) -> Option<String> {
        scene_key(self.database.path(program), environment)
    }

    /// Reads a scene that was found in a folder, unless it is there already.
    pub fn load_scene(&mut self, scene: &str) {
        if !self.documents.contains_key(scene) && !self.unreadable.contains_key(scene) {
            self.read_scene(scene);
        }
    }

    /// The environment that a scene is checked against: that of the first program beside it that has one.
    pub fn environment_of_scene(&self, scene: &str) -> Option<EntityId> {
        let name = environment_name(scene)?;
        let first = self.scenes.of(scene).into_iter().min_by_key(|file| self.database.path(*file))?;
        self.database.definitions(first, EntityKind::Environment, &name.into()).first().copied()
    }

    /// Returns whether several programs have the environment of a scene.
    pub fn is_shared_scene(&self, scene: &str) -> bool {
        self.scenes.of(scene).len() > 1
    }

    /// The environments of a scene: of each program beside it that has one of its name.
    pub fn environments_of_scene(&self, scene: &str) -> Vec<EntityId> {
        let Some(name) = environment_name(scene).map(Into::into) else { return Vec::new() };
        let programs = self.scenes.of(scene).into_iter();
        let first = |file| self.database.definitions(file, EntityKind::Environment, &name).first().copied();
        programs.filter_map(first).collect()
    }

    /// The keys of the scenes that were found for environments of a program.
    pub(crate) fn scenes_of(&self, program: FileId) -> Vec<String> {
        let scenes = self.database.scenes().filter(|(file, ..)| *file == program);
        scenes.filter_map(|(file, environment, _)| scene_key(self.database.path(file), environment)).collect()
    }

    /// Finds the scenes of environments that came, and drops those of environments that went, since this was last
    /// done.
    pub(crate) fn follow_scenes(&mut self) {
        for (file, environment) in self.database.take_changed_environments() {
            let program = self.database.path(file);
            if program.is_empty() {
                // It is closed, and its path is no longer known.
                self.database.set_scene(file, &environment, None);
                for scene in self.scenes.used_by(file) {
                    self.drop_scene(&scene, file);
                }
                continue;
            }
            let Some(scene) = scene_key(program, &environment) else { continue };
            if self.database.definitions(file, EntityKind::Environment, &environment).is_empty() {
                self.database.set_scene(file, &environment, None);
                self.drop_scene(&scene, file);
                continue;
            }
            self.scenes.add(&scene, file);
            self.load_scene(&scene);
            let text = self.scene_text(&scene);
            self.database.set_scene(file, &environment, text.as_deref());
            // There is another program that its names can be checked against.
            self.changes.documents.insert(scene);
        }
    }

    /// Gives the database the text of a scene for every program with its environment.
    pub(crate) fn share_scene(&mut self, scene: &str) {
        let Some(environment) = environment_name(scene) else { return };
        let text = self.scene_text(scene);
        for file in self.scenes.of(scene) {
            self.database.set_scene(file, environment, text.as_deref());
        }
    }

    /// The file of a scene that is not open was created, changed or deleted.
    pub(crate) fn scene_file_changed(&mut self, scene: &str) {
        self.remove(scene);
        self.unreadable.remove(scene);
        if self.scenes.has_users(scene) || self.is_listed(scene) {
            self.read_scene(scene);
        }
        self.share_scene(scene);
    }

    fn scene_text(&self, scene: &str) -> Option<String> {
        self.documents.get(scene).map(|document| document.text.to_string())
    }

    fn read_scene(&mut self, scene: &str) {
        match self.files.read(&path_of(scene)) {
            Ok(text) => self.insert_file(scene, &text),
            Err(ReadError::Missing) => {}
            Err(error) => drop(self.unreadable.insert(scene.to_owned(), error)),
        }
    }

    /// A program no longer has an environment for a scene.
    fn drop_scene(&mut self, scene: &str, program: FileId) {
        self.scenes.remove(scene, program);
        self.changes.documents.insert(scene.to_owned());
        let is_open = self.documents.get(scene).is_some_and(|document| document.is_open);
        if !is_open && !self.scenes.has_users(scene) && !self.contains(scene) {
            self.remove(scene);
            self.unreadable.remove(scene);
        }
    }
}

/// The key of the scene of an environment; `None` for a program without a folder.
fn scene_key(program: &str, environment: &str) -> Option<String> {
    Some(format!("{}/{environment}{SCENE_SUFFIX}", folder(program)?))
}

/// The name of the environment that a scene is for.
fn environment_name(scene: &str) -> Option<&str> {
    scene.rsplit('/').next()?.strip_suffix(SCENE_SUFFIX)
}
