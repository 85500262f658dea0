//! The keys under which the names of an entity are known.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Parse};
use smol_str::SmolStr;

use crate::entity::FileId;

/// A name of one kind as seen from one file.
pub(crate) type Key = (FileId, EntityKind, SmolStr);

/// The name that an entity declares.
pub(crate) fn defined_key(file: FileId, parse: &Parse) -> Option<Key> {
    let entity = parse.entity.as_ref()?;
    Some((file, entity.kind()?, entity.name()?.text.clone()))
}

/// The names that an entity uses.
pub(crate) fn used_keys(file: FileId, parse: &Parse) -> impl Iterator<Item = Key> {
    let references = parse.entity.as_ref().map(Entity::references).unwrap_or_default();
    references.into_iter().map(move |(kind, name)| (file, kind, name.text.clone()))
}

/// The names whose meaning depends on an entity: the one it declares, and those that may be hidden in skipped text.
pub(crate) fn visible_keys(file: FileId, parse: &Parse) -> impl Iterator<Item = Key> {
    hidden_keys(file, parse.skipped_names.iter()).chain(defined_key(file, parse))
}

/// Returns the keys that names in skipped text may declare.
pub(crate) fn hidden_keys<'a>(
    file: FileId,
    names: impl Iterator<Item = &'a SmolStr>,
) -> impl Iterator<Item = Key> {
    names.flat_map(move |name| EntityKind::ALL.map(|kind| (file, kind, name.clone())))
}
