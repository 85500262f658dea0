//! Settings and scene files: diagnostics, completion, hover, outline and fixes for keys, values and the names of robots and
//! sensors in a `pydslrep.toml` and in a `<environment>.scene.toml`, also while they are incomplete. A scene belongs to its
//! program: definition, references, highlights and rename work in both directions, and actions of the program create the
//! scene and complete it.
//!
//! A text, an offset and the kind of file in, plain structs out. `config` and `scene` list the keys.

mod completion;
mod fixes;
mod hover;
mod outline;
mod scene_actions;
mod scene_names;
mod statements;

pub use completion::toml_completions;
pub use fixes::{KeyFix, toml_fixes};
pub use hover::toml_hover;
pub use outline::toml_symbols;
pub use scene_actions::{SceneAction, scene_actions};
pub use scene_names::{
    NameInScene, SceneChanges, ScenePlace, highlights_in_scene, mentions_in_scenes, name_in_scene,
    rename_in_scenes,
};

use pydslrep_analysis::{Database, EntityId};
use pydslrep_config::Config;
use pydslrep_schema::{Names, Problem, Schema};
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::{Entity, Name, References};

/// The kind of a TOML file, with the declarations that its names can refer to.
#[derive(Clone, Copy)]
pub enum TomlFile<'a> {
    /// A `pydslrep.toml`.
    Settings,
    /// The scene of an environment, if there is one of its name.
    Scene(&'a Database, Option<EntityId>),
}

impl TomlFile<'_> {
    /// Returns the problems of a text, in its order.
    pub fn problems(self, text: &str) -> Vec<Problem> {
        match self {
            Self::Settings => Config::from_toml(text).1,
            Self::Scene(database, environment) => database.scene_problems(environment, text),
        }
    }

    fn schema(self) -> &'static Schema {
        match self {
            Self::Settings => &pydslrep_config::SCHEMA,
            Self::Scene(..) => &pydslrep_scene::SCHEMA,
        }
    }

    /// The names of robots with those of their parts, as far as they are declared.
    fn names(self) -> Names {
        let Self::Scene(database, Some(environment)) = self else { return Names::default() };
        let tree = database.file_of(environment).zip(database.tree(environment));
        let Some((file, Entity::Environment(tree))) = tree else { return Names::default() };
        distinct(tree.robots.as_ref(), |robot| {
            let id = database.resolve(file, EntityKind::Robot, &robot.text).entity();
            match id.and_then(|id| database.tree(id)) {
                Some(Entity::Robot(tree)) => {
                    let parts = |list: Option<&References>| distinct(list, |_| Names::default());
                    let (sensors, wheels) = (parts(tree.sensors.as_ref()), parts(tree.wheels.as_ref()));
                    Names(vec![("sensors".to_owned(), sensors), ("wheels".to_owned(), wheels)])
                }
                _ => Names::default(),
            }
        })
    }
}

/// The names of a list, each once, with those inside of them.
fn distinct(list: Option<&References>, inner: impl Fn(&Name) -> Names) -> Names {
    let mut distinct = Names::default();
    for name in list.map_or(&[][..], |list| &list.names) {
        if !distinct.0.iter().any(|(known, _)| *known == name.text) {
            distinct.0.push((name.text.to_string(), inner(name)));
        }
    }
    distinct
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A text, and the offset of `$0` in it.
    pub(super) fn at_cursor(fixture: &str) -> (String, u32) {
        let offset = fixture.find("$0").expect("the fixture has no `$0`");
        (fixture.replacen("$0", "", 1), u32::try_from(offset).unwrap())
    }

    /// A program of a robot with a sensor, and its environment.
    pub(super) fn program() -> (Database, Option<EntityId>) {
        let mut database = Database::new();
        let file = database.open(
            "a.pyr",
            "wheel a with radius 4 wheel b with radius 4 sensor front sensor back : bumper\n\
             robot rover with port 1 has { a b } wheels with sensors { front back }\n\
             robot größe with port 2 has { a b } wheels\n\
             environment yard has { rover größe } robots with { } moves",
        );
        let environment = database.environments(file)[0].0;
        (database, Some(environment))
    }
}
