//! Scenes of environments: files beside programs, supplied by the caller that can read them.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use pydslrep_scene::Scene;
use pydslrep_schema::Problem;
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use super::{Database, EntityId, FileId};
use crate::diagnostics::PlannedRun;
use crate::environment::{Environment, Robot};
use crate::names::Key;
use crate::{Fingerprint, Target, scene};

/// Scenes by the names of environments.
pub(super) type Scenes = BTreeMap<SmolStr, SceneFile>;

/// The scene of an environment, and what was found out about it.
#[derive(Debug, Clone)]
pub(super) struct SceneFile {
    text: Arc<str>,
    /// The fingerprint of the environment when its files were last touched because of it.
    touched_with: Option<Fingerprint>,
    /// The planned run of the environment in the scene. Clones share it; its fingerprint says when it is outdated.
    run: Arc<Mutex<Option<KnownRun>>>,
}

/// The fingerprint of an environment, and its planned run.
type KnownRun = (Fingerprint, Option<Arc<PlannedRun>>);

impl Database {
    /// Sets the text of the scene file of an environment by its name, or takes it away. Kept while a file is closed, and
    /// whether or not there is such an environment.
    pub fn set_scene(&mut self, file: FileId, environment: &str, text: Option<&str>) {
        let known = self.scenes.get(&file).and_then(|scenes| scenes.get(environment));
        if known.map(|known| known.text.as_ref()) == text {
            return;
        }
        let scenes = self.scenes.entry(file).or_default();
        match text {
            Some(text) => {
                let scene = SceneFile { text: text.into(), touched_with: None, run: Arc::default() };
                scenes.insert(environment.into(), scene)
            }
            None => scenes.remove(environment),
        };
        self.scenes.retain(|_, scenes| !scenes.is_empty());
        let seen = self.seen_from(file);
        self.touched.extend(seen);
    }

    /// The scenes there are: of which file, of which environment, and their texts.
    pub fn scenes(&self) -> impl Iterator<Item = (FileId, &str, &str)> {
        self.scenes.iter().flat_map(|(file, scenes)| {
            scenes.iter().map(|(name, scene)| (*file, name.as_str(), scene.text.as_ref()))
        })
    }

    /// The world that an environment drives in: what its scene file says, else an empty floor.
    ///
    /// # Errors
    /// When something is wrong with the file: what it means is not known.
    pub fn scene(&self, id: EntityId, environment: &Environment) -> Result<Scene, Vec<Problem>> {
        let floor = scene(environment);
        let Some(text) = self.scene_text(id) else { return Ok(floor) };
        let (scene, problems) = pydslrep_scene::read(text, floor);
        if problems.is_empty() { Ok(scene) } else { Err(problems) }
    }

    /// An environment with what its scene says of its robots' objects, and of their topics where scripts need them, as far as
    /// that is right.
    pub(crate) fn with_scene(&self, id: EntityId, environment: Environment) -> Environment {
        let has_topics = self.file_of(id).is_some_and(|file| self.target(file) == Target::Ros2);
        // Most files say nothing of objects and are not read.
        let text = self.scene_text(id).filter(|text| has_topics || text.contains("object"));
        if text.is_none() && !has_topics {
            return environment;
        }
        let floor = scene(&environment);
        let robots = match text {
            Some(text) => pydslrep_scene::read(text, floor).0.robots,
            None => floor.robots,
        };
        let placed = environment.robots.into_iter().zip(robots);
        let placed = placed.map(|(robot, placed)| {
            let mounts = || placed.sensors.iter().map(|sensor| sensor.mount).collect();
            let (ros2, mounts) = if has_topics { (placed.ros2(), mounts()) } else { Default::default() };
            Robot { ros2, mounts, objects: placed.objects, ..robot }
        });
        Environment { robots: placed.collect(), ..environment }
    }

    /// Returns the problems of a scene file, in the order of the text. Without an environment, or where a robot of it
    /// is broken, any name is allowed.
    pub fn scene_problems(&self, environment: Option<EntityId>, text: &str) -> Vec<Problem> {
        match environment.and_then(|id| self.floor(id)) {
            Some(floor) => pydslrep_scene::read(text, floor).1,
            None => pydslrep_scene::problems(text),
        }
    }

    /// The environments whose names came or went since this was last asked: each by its file and name. Also those of
    /// files that were closed.
    pub fn take_changed_environments(&mut self) -> Vec<(FileId, SmolStr)> {
        let changed = std::mem::take(&mut self.changed_environments);
        let mut changed: Vec<(FileId, SmolStr)> = changed.into_keys().collect();
        changed.sort_unstable();
        changed
    }

    /// The text of an environment's scene file.
    pub(crate) fn scene_text(&self, id: EntityId) -> Option<&Arc<str>> {
        let Entity::Environment(tree) = self.tree(id)? else { return None };
        let name = tree.name.as_ref()?.text.as_str();
        self.scenes.get(&self.file_of(id)?)?.get(name).map(|scene| &scene.text)
    }

    /// Returns the planned runs of the environments with a scene whose actions may be in a file. A run is computed
    /// again only where the environment's fingerprint changed.
    pub(crate) fn planned_runs(&self, file: FileId) -> Vec<Arc<PlannedRun>> {
        let mut planned_runs = Vec::new();
        for (home, scenes) in &self.scenes {
            if *home != file && !self.imported_files(*home).any(|imported| imported == file) {
                continue;
            }
            let found = scenes.iter().map(|(name, scene)| self.planned_run(*home, name, scene));
            planned_runs.extend(found.flatten());
        }
        planned_runs
    }

    fn planned_run(&self, home: FileId, name: &SmolStr, scene: &SceneFile) -> Option<Arc<PlannedRun>> {
        let id = self.environment_called(home, name)?;
        let fingerprint = self.fingerprint(id)?;
        let mut known = scene.run.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, run)) = known.as_ref()
            && *of == fingerprint
        {
            return run.clone();
        }
        let run = PlannedRun::new(self, id).map(Arc::new);
        *known = Some((fingerprint, run.clone()));
        run
    }

    /// Touches the files of environments that changed: the collisions on a path depend on everything the environment
    /// sees.
    pub(super) fn touch_in_scenes(&mut self) {
        let mut concerned: Vec<FileId> = Vec::new();
        let mut looked_at = Vec::new();
        for (home, scenes) in &self.scenes {
            let seen = self.seen_from(*home);
            if !seen.iter().any(|file| self.touched.contains(file)) {
                continue;
            }
            for (name, scene) in scenes {
                let fingerprint = self.environment_called(*home, name).and_then(|id| self.fingerprint(id));
                // Where there is something to say, other files may name a place that has moved.
                if fingerprint != scene.touched_with || scene.has_problems() {
                    concerned.extend(&seen);
                }
                looked_at.push((*home, name.clone(), fingerprint));
            }
        }
        for (home, name, fingerprint) in looked_at {
            if let Some(scene) = self.scenes.get_mut(&home).and_then(|scenes| scenes.get_mut(&name)) {
                scene.touched_with = fingerprint;
            }
        }
        self.touched.extend(concerned);
    }

    fn environment_called(&self, home: FileId, name: &SmolStr) -> Option<EntityId> {
        self.definitions(home, EntityKind::Environment, name).first().copied()
    }

    fn seen_from(&self, home: FileId) -> Vec<FileId> {
        std::iter::once(home).chain(self.imported_files(home)).collect()
    }
}

impl SceneFile {
    /// Returns whether the run is known to have problems.
    fn has_problems(&self) -> bool {
        let known = self.run.lock().unwrap_or_else(PoisonError::into_inner);
        known.as_ref().and_then(|(_, run)| run.as_ref()).is_some_and(|run| run.has_problems())
    }
}

/// Keeps account of environments that come (1) or go (-1) with a declaration of theirs.
pub(super) fn count_environment(changed: &mut FxHashMap<(FileId, SmolStr), i32>, key: &Key, by: i32) {
    let (file, EntityKind::Environment, name) = key else { return };
    let entry = (*file, name.clone());
    let more = changed.get(&entry).copied().unwrap_or(0) + by;
    if more == 0 {
        changed.remove(&entry);
    } else {
        changed.insert(entry, more);
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::Span;

    use super::*;

    const PROGRAM: &str = "wheel a with radius 4 wheel b with radius 4 wheel c with radius 4\n\
        robot r with port 1 has { a b } wheels movement m of r { move 2 meters }\n\
        environment e has { r } robots with { m } moves";

    fn replace(database: &mut Database, file: FileId, old: &str, new: &str) {
        let text = database.text(file).unwrap().to_string();
        let at = u32::try_from(text.find(old).unwrap()).unwrap();
        database.edit(file, Span::new(at, at + u32::try_from(old.len()).unwrap()), new);
    }

    fn changed(database: &mut Database) -> Vec<String> {
        database.take_changed_environments().into_iter().map(|(_, name)| name.to_string()).collect()
    }

    #[test]
    fn an_environment_has_the_objects_that_its_scene_names() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        let (id, _) = database.environments(file)[0].clone();
        let paths = |database: &Database| {
            let objects = database.environment(id).unwrap().robots.remove(0).objects;
            objects
                .into_iter()
                .map(|(part, paths)| format!("{part}: {}", paths.join(" ")))
                .collect::<Vec<_>>()
        };
        assert!(paths(&database).is_empty());
        let scene = "[robots.r]\nobject = '/P3DX'\nstart = 1\n[robots.r.wheels.a]\nobject = '/P3DX/left'";
        database.set_scene(file, "e", Some(scene));
        assert_eq!(
            paths(&database),
            ["a: /P3DX/left", "r: /P3DX"],
            "what is wrong with others does not matter"
        );
    }

    #[test]
    fn a_run_is_planned_again_only_when_it_is_another_one() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        database.set_scene(file, "e", Some("[[box]]\nat = [1, 0]\nsize = [0.4, 0.4]"));
        let run = |database: &Database| database.planned_runs(file).remove(0);
        let first = run(&database);
        replace(&mut database, file, "c with radius 4", "c with radius 45");
        replace(&mut database, file, "c with", "c\n\nwith");
        assert!(Arc::ptr_eq(&run(&database), &first), "nobody has this wheel");
        replace(&mut database, file, "move 2", "move 3");
        let second = run(&database);
        assert!(!Arc::ptr_eq(&second, &first));
        database.set_scene(file, "e", Some("[[box]]\nat = [1, 1]\nsize = [0.4, 0.4]"));
        assert!(!Arc::ptr_eq(&run(&database), &second));
        assert!(!run(&database).has_problems());
    }

    /// Text typed elsewhere in the program does not make the imported files outdated.
    #[test]
    fn files_are_touched_where_what_is_met_may_change() {
        let mut database = Database::new();
        let parts = database.open("parts.pyr", PROGRAM.split("environment").next().unwrap());
        let text = "import \"parts.pyr\" sensor s\nenvironment e has { r } robots with { m } moves";
        let main = database.open("main.pyr", text);
        database.set_scene(main, "e", Some("[[box]]\nat = [1, 1]\nsize = [0.4, 0.4]"));
        database.take_touched();
        replace(&mut database, main, "sensor s", "sensor t");
        assert_eq!(database.take_touched(), [main]);
        database.set_scene(main, "e", Some("[[box]]\nat = [1, 0]\nsize = [0.4, 0.4]"));
        assert_eq!(database.take_touched(), [parts, main]);
        replace(&mut database, main, "{ m }", "{ }");
        assert_eq!(database.take_touched(), [parts, main]);
    }

    #[test]
    fn environments_that_come_and_go_are_told() {
        let mut database = Database::new();
        let file = database.open("a.pyr", PROGRAM);
        assert_eq!(changed(&mut database), ["e"]);
        replace(&mut database, file, "{ m }", "{ m m }");
        replace(&mut database, file, "move 2", "move 3");
        assert_eq!(changed(&mut database), [""; 0]);
        replace(&mut database, file, "environment e", "environment east");
        assert_eq!(changed(&mut database), ["e", "east"]);
        database.open("a.pyr", &PROGRAM.replace("environment e", "environment east"));
        assert_eq!(changed(&mut database), [""; 0]);
        database.close(file);
        assert_eq!(changed(&mut database), ["east"]);
    }
}
