//! Scene files: keys of a `<environment>.scene.toml`, and the names of its program's robots and sensors, are checked.
//!
//! Its text and the environment it is about in, plain structs out.

use pydslrep_analysis::{Database, EntityId};
use pydslrep_notation::Problem;

/// What is wrong with a scene file. Without an environment, or where that is broken, names can be any.
pub fn scene_problems(database: &Database, environment: Option<EntityId>, text: &str) -> Vec<Problem> {
    match environment.and_then(|id| database.floor(id)) {
        Some(floor) => pydslrep_scene::read(text, floor).1,
        None => pydslrep_scene::problems(text),
    }
}
