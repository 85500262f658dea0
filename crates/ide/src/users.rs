//! The users of an entity, direct and through others.

use pydslrep_analysis::{Database, EntityId, FileId};
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Entity;
use rustc_hash::FxHashSet;

/// The environments in some files that use an entity. One uses itself.
pub(crate) fn environments_using(database: &Database, id: EntityId, files: &[FileId]) -> Vec<EntityId> {
    let users = |id: EntityId| {
        let tree = database.tree(id);
        let named = tree.and_then(|tree| Some((tree.kind()?, &tree.name()?.text)));
        let of_file = |file: &FileId| named.map(|(kind, name)| database.users(*file, kind, name));
        files.iter().filter_map(of_file).flatten().copied().collect::<Vec<EntityId>>()
    };
    let mut found = vec![id];
    let mut seen: FxHashSet<EntityId> = found.iter().copied().collect();
    let mut next = 0;
    while let Some(&id) = found.get(next) {
        next += 1;
        found.extend(users(id).into_iter().filter(|user| seen.insert(*user)));
    }
    let is_environment =
        |id: &EntityId| database.tree(*id).and_then(Entity::kind) == Some(EntityKind::Environment);
    found.retain(is_environment);
    found
}
