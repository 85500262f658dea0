//! The names and entities that rules read while they checked an entity.

use pydslrep_syntax::EntityKind;
use smallvec::SmallVec;

use crate::entity::EntityId;
use crate::facts::keys::Key;

/// Where an entity's problems come from, beside the entity itself, the names it declares or uses (the index of names has
/// those), and the facts of its file that invalidate the whole file when they change. When one of these changes, the
/// entity is checked again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Reads {
    /// Names of others that were looked up.
    names: Vec<Key>,
    /// Entities whose [signatures](crate::signature::Signature) were looked at.
    entities: SmallVec<[EntityId; 4]>,
    /// Movements whose [summaries](crate::summary::Summary) were looked at.
    summaries: SmallVec<[EntityId; 4]>,
    /// Kinds of which all names in sight were iterated over.
    kinds: Kinds,
}

impl Reads {
    pub(crate) fn add_name(&mut self, key: Key) {
        self.names.push(key);
    }

    pub(crate) fn add_entity(&mut self, id: EntityId) {
        self.entities.push(id);
    }

    pub(crate) fn add_summary(&mut self, id: EntityId) {
        self.summaries.push(id);
    }

    pub(crate) fn add_kind(&mut self, kind: EntityKind) {
        self.kinds = self.kinds.with(kind);
    }

    /// Returns the same, each once and in an order that does not depend on the order of the rules.
    pub(crate) fn settled(mut self) -> Self {
        self.names.sort_unstable();
        self.names.dedup();
        self.entities.sort_unstable();
        self.entities.dedup();
        self.summaries.sort_unstable();
        self.summaries.dedup();
        self
    }

    pub(crate) fn names(&self) -> &[Key] {
        &self.names
    }

    pub(crate) fn entities(&self) -> &[EntityId] {
        &self.entities
    }

    pub(crate) fn summaries(&self) -> &[EntityId] {
        &self.summaries
    }

    pub(crate) fn kinds(&self) -> Kinds {
        self.kinds
    }

    /// Removes an entity that is no longer there.
    pub(crate) fn forget(&mut self, id: EntityId) {
        self.entities.retain(|other| *other != id);
        self.summaries.retain(|other| *other != id);
    }
}

/// A set of kinds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Kinds(u8);

impl Kinds {
    pub(crate) fn with(self, kind: EntityKind) -> Self {
        Self(self.0 | 1 << kind as u8)
    }

    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns whether the two have a kind in common.
    pub(crate) fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}
