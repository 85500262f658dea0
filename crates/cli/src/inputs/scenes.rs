//! The scenes that environments are driven in, and their problems.

use std::collections::BTreeSet;
use std::path::Path;

use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{EntityId, FileId};
use pydslrep_config::Problem;
use pydslrep_scene::Scene;
use pydslrep_workspace::{NoEnvironment, SceneError, without_byte_order_mark};
use ropey::Rope;

use super::Inputs;
use super::paths::shown;
use super::read::{read_failure, read_file};
use crate::failure::Failure;
use crate::report::place::{self, PlaceRange};
use crate::report::render;

/// The severity of all problems in scenes: nothing is driven in such a scene.
pub(crate) const SEVERITY: pydslrep_analysis::Severity = pydslrep_analysis::Severity::Error;

/// A problem in a scene file.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SceneProblem {
    /// The name of the file in output.
    pub(crate) shown: String,
    /// Where it is in the file.
    pub(crate) range: PlaceRange,
    /// The problem itself.
    pub(crate) problem: Problem,
    /// It for people, with its line.
    rendered: String,
}

/// Problems for people, with source lines.
pub(crate) fn render(problems: &[SceneProblem]) -> String {
    problems.iter().map(|problem| problem.rendered.as_str()).collect()
}

impl Inputs {
    /// Uses a scene file for an environment of a program instead of the one beside the program.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(crate) fn use_scene(
        &mut self,
        file: FileId,
        environment: EntityId,
        path: &Path,
    ) -> Result<(), Failure> {
        let text = read_file(path)?;
        self.other_scene = Some(path.to_owned());
        let keys = self.workspace.scene_keys(file);
        if let Some((_, key)) = keys.into_iter().find(|(id, _)| *id == environment) {
            self.workspace.open(&key, Rope::from_str(without_byte_order_mark(&text)));
            self.names.insert(key, shown(path));
        }
        Ok(())
    }

    /// The environment of a program with this name, or its only one.
    ///
    /// # Errors
    /// If there is none, or several and none is named.
    pub(crate) fn choose_environment(
        &self,
        file: FileId,
        name: Option<&str>,
    ) -> Result<EntityId, NoEnvironment> {
        self.workspace.choose_environment(file, name)
    }

    /// The scene that an environment of a program is driven in: an empty floor if there is no scene file.
    ///
    /// # Errors
    /// When the file cannot be read, and with everything that is wrong in it.
    pub(crate) fn scene(&self, file: FileId, environment: &Environment) -> Result<Scene, Failure> {
        self.workspace.scene(file, environment).map_err(|error| match error {
            SceneError::Unreadable { key, error } => read_failure(&self.name(&key), &error),
            SceneError::Invalid { key, problems } => Failure::Rendered(self.render_problems(&key, &problems)),
        })
    }

    /// Returns the problems of the scenes of the named programs and folders, and the errors of scenes that could not be
    /// read.
    pub(crate) fn scene_problems(&self) -> (Vec<SceneProblem>, Vec<Failure>) {
        let of_programs = self.files.iter().flat_map(|file| self.workspace.scene_keys(*file));
        let keys: BTreeSet<String> =
            of_programs.map(|(_, key)| key).chain(self.scenes.iter().cloned()).collect();
        let (mut found, mut failures) = (Vec::new(), Vec::new());
        for key in &keys {
            failures.extend(self.workspace.read_error(key).map(|error| read_failure(&self.name(key), error)));
            let Some(document) = self.workspace.document(key) else { continue };
            let (shown, text) = (self.name(key), document.text.to_string());
            found.extend(self.workspace.problems(key).into_iter().map(|problem| SceneProblem {
                shown: shown.clone(),
                range: place::range_in(&text, problem.span.unwrap_or_default()),
                rendered: render::problem(&shown, &text, &problem),
                problem,
            }));
        }
        (found, failures)
    }
}
