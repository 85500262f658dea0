//! Scenes of environments: files beside programs, supplied by the caller that can read them.

use std::sync::Arc;

use pydslrep_scene::Scene;
use pydslrep_schema::Problem;
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;
use smol_str::SmolStr;

use super::Facts;
use crate::entity::{EntityId, FileId};
use crate::environment::{Environment, Robot};
use crate::{Target, scene};

impl Facts {
    /// Sets the text of the scene file of an environment by its name, or takes it away; returns whether that is new.
    pub(crate) fn set_scene(&mut self, file: FileId, environment: &str, text: Option<&str>) -> bool {
        let known = self.scenes.get(&file).and_then(|scenes| scenes.get(environment));
        if known.map(AsRef::as_ref) == text {
            return false;
        }
        let scenes = self.scenes.entry(file).or_default();
        match text {
            Some(text) => scenes.insert(environment.into(), text.into()),
            None => scenes.remove(environment),
        };
        self.scenes.retain(|_, scenes| !scenes.is_empty());
        true
    }

    /// The scenes there are: of which file, of which environment, and their texts.
    pub fn scenes(&self) -> impl Iterator<Item = (FileId, &str, &str)> {
        self.scenes.iter().flat_map(|(file, scenes)| {
            scenes.iter().map(|(name, text)| (*file, name.as_str(), text.as_ref()))
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

    /// The text of an environment's scene file.
    pub(crate) fn scene_text(&self, id: EntityId) -> Option<&Arc<str>> {
        let Entity::Environment(tree) = self.tree(id)? else { return None };
        let name = tree.name.as_ref()?.text.as_str();
        self.scenes.get(&self.file_of(id)?)?.get(name)
    }

    /// The environment of a file that has a scene by this name.
    pub(crate) fn environment_called(&self, home: FileId, name: &SmolStr) -> Option<EntityId> {
        self.definitions(home, EntityKind::Environment, name).first().copied()
    }
}
