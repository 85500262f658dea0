//! The problems of all entities.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::diagnostics::Problem;
use crate::entity::{EntityId, FileId};

/// The problems of entities, and the entities that have any.
#[derive(Debug, Clone, Default)]
pub(super) struct Problems {
    by_entity: Vec<Vec<Problem>>,
    /// Entities with problems.
    in_files: FxHashMap<FileId, FxHashSet<EntityId>>,
    /// Entities with a problem whose fix renames them, also in the files that import theirs.
    renaming: FxHashMap<FileId, FxHashSet<EntityId>>,
}

impl Problems {
    /// The problems of an entity.
    pub(super) fn of(&self, id: EntityId) -> &[Problem] {
        self.by_entity.get(id.index()).map_or(&[], Vec::as_slice)
    }

    /// The entities of a file that have problems, in no order.
    pub(super) fn in_file(&self, file: FileId) -> impl Iterator<Item = EntityId> {
        self.in_files.get(&file).into_iter().flatten().copied()
    }

    /// Returns the number of entities of a file that have problems.
    pub(super) fn count(&self, file: FileId) -> usize {
        self.in_files.get(&file).map_or(0, FxHashSet::len)
    }

    /// Returns whether a problem of a file has a fix that renames something, also in the files that import it.
    pub(super) fn any_renames(&self, file: FileId) -> bool {
        self.renaming.get(&file).is_some_and(|entities| !entities.is_empty())
    }

    /// Replaces the problems of an entity of a file.
    pub(super) fn set(&mut self, id: EntityId, file: FileId, problems: Vec<Problem>) {
        set_member(&mut self.in_files, file, id, !problems.is_empty());
        set_member(&mut self.renaming, file, id, problems.iter().any(Problem::renames));
        let count = self.by_entity.len().max(id.index() + 1);
        self.by_entity.resize_with(count, Vec::new);
        self.by_entity[id.index()] = problems;
    }
}

/// Adds an entity to the set of its file, or removes it.
fn set_member(
    sets: &mut FxHashMap<FileId, FxHashSet<EntityId>>,
    file: FileId,
    id: EntityId,
    is_member: bool,
) {
    if is_member {
        sets.entry(file).or_default().insert(id);
    } else if let Some(members) = sets.get_mut(&file) {
        members.remove(&id);
    }
}
