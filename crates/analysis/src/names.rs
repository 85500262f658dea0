//! Who declares a name, and who uses it.

use std::hash::Hash;

use pydslrep_syntax::EntityKind;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use crate::{EntityId, FileId};

/// A name of one kind as seen from one file.
pub(crate) type Key = (FileId, EntityKind, SmolStr);

/// The index of names over all files. Names of different files never meet here; what an import makes visible is
/// looked up file by file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Names {
    defined: FxHashMap<Key, Vec<EntityId>>,
    /// The names of `defined`, by file and kind.
    by_kind: FxHashMap<(FileId, EntityKind), FxHashSet<SmolStr>>,
    /// The names of environments that are the same but for case, by how they are in lower case: their scripts would
    /// be the same file on some computers.
    folded: FxHashMap<(FileId, SmolStr), Vec<SmolStr>>,
    used: FxHashMap<Key, Vec<EntityId>>,
    skipped: FxHashMap<(FileId, SmolStr), u32>,
}

impl Names {
    /// The entities that declare a name, in the order of the text.
    pub(crate) fn defined(&self, key: &Key) -> &[EntityId] {
        self.defined.get(key).map_or(&[], Vec::as_slice)
    }

    /// The entities that use a name, each as often as it does.
    pub(crate) fn used(&self, key: &Key) -> &[EntityId] {
        self.used.get(key).map_or(&[], Vec::as_slice)
    }

    /// Every declared name of a kind in a file, in no order.
    pub(crate) fn all(&self, file: FileId, kind: EntityKind) -> impl Iterator<Item = &SmolStr> {
        self.by_kind.get(&(file, kind)).into_iter().flatten()
    }

    /// Whether the name stands in text that had to be skipped, and may be declared there.
    pub(crate) fn is_skipped(&self, file: FileId, name: &SmolStr) -> bool {
        self.skipped.contains_key(&(file, name.clone()))
    }

    /// Whether any name of the file stands in skipped text.
    pub(crate) fn any_skipped(&self, file: FileId) -> bool {
        self.skipped.keys().any(|(other, _)| *other == file)
    }

    /// The declared names of environments that are the same as `name` but for case, itself included, in no order.
    pub(crate) fn environments_but_for_case(&self, file: FileId, name: &SmolStr) -> &[SmolStr] {
        self.folded.get(&(file, name.to_ascii_lowercase().into())).map_or(&[], Vec::as_slice)
    }

    /// Adds a declaration; `order` tells where in the file an entity stands.
    pub(crate) fn define(&mut self, key: Key, entity: EntityId, order: impl Fn(EntityId) -> u64) {
        let is_new = self.by_kind.entry((key.0, key.1)).or_default().insert(key.2.clone());
        if is_new && key.1 == EntityKind::Environment {
            self.folded.entry((key.0, key.2.to_ascii_lowercase().into())).or_default().push(key.2.clone());
        }
        let entities = self.defined.entry(key).or_default();
        let place = entities.partition_point(|other| order(*other) < order(entity));
        entities.insert(place, entity);
    }

    /// Removes a declaration.
    pub(crate) fn undefine(&mut self, key: &Key, entity: EntityId) {
        remove(&mut self.defined, key, &entity);
        if !self.defined.contains_key(key)
            && let Some(names) = self.by_kind.get_mut(&(key.0, key.1))
        {
            names.remove(&key.2);
            if key.1 == EntityKind::Environment {
                remove(&mut self.folded, &(key.0, key.2.to_ascii_lowercase().into()), &key.2);
            }
        }
    }

    /// Adds a use.
    pub(crate) fn reference(&mut self, key: Key, entity: EntityId) {
        self.used.entry(key).or_default().push(entity);
    }

    /// Removes one use.
    pub(crate) fn unreference(&mut self, key: &Key, entity: EntityId) {
        remove(&mut self.used, key, &entity);
    }

    /// Adds a name in skipped text.
    pub(crate) fn skip(&mut self, file: FileId, name: SmolStr) {
        *self.skipped.entry((file, name)).or_default() += 1;
    }

    /// Removes a name in skipped text.
    pub(crate) fn unskip(&mut self, file: FileId, name: &SmolStr) {
        let key = (file, name.clone());
        if let Some(count) = self.skipped.get_mut(&key) {
            *count -= 1;
            if *count == 0 {
                self.skipped.remove(&key);
            }
        }
    }
}

/// Removes one value of a key, and the key with its last one.
fn remove<K: Eq + Hash, V: Eq>(map: &mut FxHashMap<K, Vec<V>>, key: &K, value: &V) {
    if let Some(values) = map.get_mut(key) {
        if let Some(place) = values.iter().position(|other| other == value) {
            values.remove(place);
        }
        if values.is_empty() {
            map.remove(key);
        }
    }
}
