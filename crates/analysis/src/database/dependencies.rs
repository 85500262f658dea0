//! Who depends on what: the reads of rules, kept in both directions, so that a change finds those it invalidates.

use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;

use crate::entity::EntityId;
use crate::facts::keys::Key;
use crate::reads::{Kinds, Reads};

/// Most are read by a few; those need no memory of their own.
type Readers = SmallVec<[EntityId; 4]>;

/// The dependencies of all entities.
#[derive(Debug, Clone, Default)]
pub(super) struct Dependencies {
    by_entity: Vec<Links>,
    /// The entities whose rules looked a name up that they neither declare nor use.
    by_name: FxHashMap<Key, Readers>,
    /// Entities whose problems speak of all names of a kind ("did you mean …"), not only of those they use.
    of_kinds: FxHashSet<EntityId>,
}

#[derive(Debug, Clone, Default)]
struct Links {
    /// The names and entities that the entity's problems come from.
    reads: Reads,
    /// The entities whose rules read this one's signature.
    readers: Readers,
    /// The entities whose rules read this one's summary.
    summary_readers: Readers,
}

impl Dependencies {
    /// The entities whose rules read the signature of an entity.
    pub(super) fn readers(&self, id: EntityId) -> &[EntityId] {
        self.links(id).map_or(&[], |links| &links.readers)
    }

    /// The entities whose rules read the summary of a movement.
    pub(super) fn summary_readers(&self, id: EntityId) -> &[EntityId] {
        self.links(id).map_or(&[], |links| &links.summary_readers)
    }

    /// The entities whose rules looked a name up that they neither declare nor use.
    pub(super) fn readers_of_name(&self, key: &Key) -> impl Iterator<Item = EntityId> {
        self.by_name.get(key).into_iter().flatten().copied()
    }

    /// The entities whose problems speak of all names of one of these kinds.
    pub(super) fn readers_of_kinds(&self, kinds: Kinds) -> impl Iterator<Item = EntityId> {
        let meets =
            move |id: &&EntityId| self.links(**id).is_some_and(|links| links.reads.kinds().meets(kinds));
        self.of_kinds.iter().filter(meets).copied()
    }

    /// Notes what the problems of an entity come from now. Mostly it is what it was, and then costs one comparison.
    pub(super) fn set_reads(&mut self, id: EntityId, reads: Reads) {
        let links = self.links_mut(id);
        if links.reads == reads {
            return;
        }
        let before = std::mem::take(&mut links.reads);
        self.forget_reads(id, &before);
        for other in reads.entities() {
            self.links_mut(*other).readers.push(id);
        }
        for other in reads.summaries() {
            self.links_mut(*other).summary_readers.push(id);
        }
        for key in reads.names() {
            self.by_name.entry(key.clone()).or_default().push(id);
        }
        if !reads.kinds().is_empty() {
            self.of_kinds.insert(id);
        }
        self.links_mut(id).reads = reads;
    }

    /// Removes an entity that is gone from both directions.
    pub(super) fn remove(&mut self, id: EntityId) {
        let Links { reads, readers, summary_readers } = std::mem::take(self.links_mut(id));
        self.forget_reads(id, &reads);
        for reader in readers.into_iter().chain(summary_readers) {
            self.links_mut(reader).reads.forget(id);
        }
    }

    fn forget_reads(&mut self, id: EntityId, reads: &Reads) {
        for other in reads.entities() {
            remove_reader(&mut self.links_mut(*other).readers, id);
        }
        for other in reads.summaries() {
            remove_reader(&mut self.links_mut(*other).summary_readers, id);
        }
        for key in reads.names() {
            if let Some(readers) = self.by_name.get_mut(key) {
                remove_reader(readers, id);
                if readers.is_empty() {
                    self.by_name.remove(key);
                }
            }
        }
        self.of_kinds.remove(&id);
    }

    fn links(&self, id: EntityId) -> Option<&Links> {
        self.by_entity.get(id.index())
    }

    fn links_mut(&mut self, id: EntityId) -> &mut Links {
        let count = self.by_entity.len().max(id.index() + 1);
        self.by_entity.resize_with(count, Links::default);
        &mut self.by_entity[id.index()]
    }
}

fn remove_reader(readers: &mut Readers, id: EntityId) {
    if let Some(place) = readers.iter().position(|reader| *reader == id) {
        readers.swap_remove(place);
    }
}
