//! Fingerprints of environments: cheap to compare, so that what follows from one is computed once.

use std::sync::Arc;

use pydslrep_syntax::Parse;

use crate::entity::EntityId;
use crate::facts::Facts;

/// All that an environment is made of, itself and its scene included. As long as two of them are equal, so is what follows
/// from the environment: its script, its path, and what that meets.
#[derive(Debug, Clone)]
pub struct Fingerprint {
    parts: Vec<(EntityId, Arc<Parse>)>,
    scene: Option<Arc<str>>,
}

impl Fingerprint {
    /// That of an environment from which these entities are reached.
    pub(crate) fn new(facts: &Facts, environment: EntityId, reached: &[EntityId]) -> Option<Self> {
        let parse = |id: &EntityId| Some((*id, Arc::clone(facts.shared_parse(*id)?)));
        let parts = reached.iter().map(parse).collect::<Option<_>>()?;
        Some(Self { parts, scene: facts.scene_text(environment).cloned() })
    }
}

impl PartialEq for Fingerprint {
    /// A part that was read again counts as changed.
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene
            && self.parts.len() == other.parts.len()
            && self.parts.iter().zip(&other.parts).all(|(a, b)| a.0 == b.0 && Arc::ptr_eq(&a.1, &b.1))
    }
}
