//! The declarations and the uses of names.

use std::collections::hash_map::Entry;

use pydslrep_syntax::EntityKind;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;
use smol_str::SmolStr;

use crate::entity::{EntityId, FileId};
use crate::facts::keys::Key;

/// The index of names over all files. Names of different files never meet here; what an import makes visible is
/// looked up file by file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Names {
    known: FxHashMap<Key, Mentions>,
    /// The names that are declared, by file and kind.
    by_kind: FxHashMap<(FileId, EntityKind), FxHashSet<SmolStr>>,
    /// The names of environments that are the same except for case, by how they are in lower case: their scripts would
    /// be the same file on some computers.
    folded: FxHashMap<(FileId, SmolStr), Vec<SmolStr>>,
    skipped: FxHashMap<(FileId, SmolStr), u32>,
    /// The number of different names of a file in skipped text; files without any have no entry.
    skipped_counts: FxHashMap<FileId, usize>,
}

/// Most names are declared once and used a few times; those need no memory of their own.
type Entities = SmallVec<[EntityId; 4]>;

/// Where a name occurs.
#[derive(Debug, Clone, Default)]
struct Mentions {
    /// In the order of the text.
    defined: Entities,
    /// Each as often as it uses the name.
    used: Entities,
}

impl Names {
    /// The entities that declare a name, in the order of the text.
    pub(crate) fn defined(&self, key: &Key) -> &[EntityId] {
        self.known.get(key).map_or(&[], |mentions| &mentions.defined)
    }

    /// The entities that use a name, each as often as it does.
    pub(crate) fn used(&self, key: &Key) -> &[EntityId] {
        self.known.get(key).map_or(&[], |mentions| &mentions.used)
    }

    /// The entities that declare or use a name.
    pub(crate) fn mentions(&self, key: &Key) -> impl Iterator<Item = EntityId> {
        let mentions = self.known.get(key).into_iter();
        mentions.flat_map(|it| it.defined.iter().chain(&it.used)).copied()
    }

    /// Every declared name of a kind in a file, in no order.
    pub(crate) fn all(&self, file: FileId, kind: EntityKind) -> impl Iterator<Item = &SmolStr> {
        self.by_kind.get(&(file, kind)).into_iter().flatten()
    }

    /// Returns whether the name is in text that had to be skipped, and may be declared there.
    pub(crate) fn is_skipped(&self, file: FileId, name: &SmolStr) -> bool {
        self.skipped.contains_key(&(file, name.clone()))
    }

    /// Returns whether any name of the file is in skipped text.
    pub(crate) fn any_skipped(&self, file: FileId) -> bool {
        self.skipped_counts.contains_key(&file)
    }

    /// The declared names of environments that are the same as `name` except for case, itself included, in no order.
    pub(crate) fn environments_but_for_case(&self, file: FileId, name: &SmolStr) -> &[SmolStr] {
        self.folded.get(&(file, name.to_ascii_lowercase().into())).map_or(&[], Vec::as_slice)
    }

    /// Adds a declaration; `order` is the place of the entity in the file.
    pub(crate) fn define(&mut self, key: Key, entity: EntityId, order: impl Fn(EntityId) -> u64) {
        if self.defined(&key).is_empty() {
            self.by_kind.entry((key.0, key.1)).or_default().insert(key.2.clone());
            if key.1 == EntityKind::Environment {
                self.folded.entry(folded(&key)).or_default().push(key.2.clone());
            }
        }
        let entities = &mut self.known.entry(key).or_default().defined;
        let place = entities.partition_point(|other| order(*other) < order(entity));
        entities.insert(place, entity);
    }

    /// Removes a declaration.
    pub(crate) fn undefine(&mut self, key: &Key, entity: EntityId) {
        self.remove(key, |mentions| remove(&mut mentions.defined, entity));
        if !self.defined(key).is_empty() {
            return;
        }
        if let Some(names) = self.by_kind.get_mut(&(key.0, key.1)) {
            names.remove(&key.2);
        }
        if key.1 == EntityKind::Environment
            && let Entry::Occupied(mut twins) = self.folded.entry(folded(key))
        {
            twins.get_mut().retain(|name| *name != key.2);
            if twins.get().is_empty() {
                twins.remove();
            }
        }
    }

    /// Adds a use.
    pub(crate) fn reference(&mut self, key: Key, entity: EntityId) {
        self.known.entry(key).or_default().used.push(entity);
    }

    /// Removes one use.
    pub(crate) fn unreference(&mut self, key: &Key, entity: EntityId) {
        self.remove(key, |mentions| remove(&mut mentions.used, entity));
    }

    /// Changes where a name occurs, and forgets a name that occurs nowhere.
    fn remove(&mut self, key: &Key, change: impl FnOnce(&mut Mentions)) {
        if let Some(mentions) = self.known.get_mut(key) {
            change(mentions);
            if mentions.defined.is_empty() && mentions.used.is_empty() {
                self.known.remove(key);
            }
        }
    }

    /// Adds a name in skipped text.
    pub(crate) fn skip(&mut self, file: FileId, name: SmolStr) {
        let count = self.skipped.entry((file, name)).or_default();
        *count += 1;
        if *count == 1 {
            *self.skipped_counts.entry(file).or_default() += 1;
        }
    }

    /// Removes a name in skipped text.
    pub(crate) fn unskip(&mut self, file: FileId, name: &SmolStr) {
        let key = (file, name.clone());
        if let Some(count) = self.skipped.get_mut(&key) {
            *count -= 1;
            if *count == 0 {
                self.skipped.remove(&key);
                let different = self.skipped_counts.entry(file).or_default();
                *different -= 1;
                if *different == 0 {
                    self.skipped_counts.remove(&file);
                }
            }
        }
    }
}

/// Returns the file and name of an environment in lower case, as for script names where case is ignored.
fn folded(key: &Key) -> (FileId, SmolStr) {
    (key.0, key.2.to_ascii_lowercase().into())
}

/// Removes an entity once.
fn remove(entities: &mut Entities, entity: EntityId) {
    if let Some(place) = entities.iter().position(|other| *other == entity) {
        entities.remove(place);
    }
}
