//! The reads of rules, kept in both directions so that a change finds those it invalidates.

use smallvec::SmallVec;

use super::{Database, EntityId};
use crate::reads::Reads;

impl Database {
    /// Notes what the problems of an entity come from now. Mostly it is what it was, and then costs one comparison.
    pub(super) fn set_reads(&mut self, id: EntityId, reads: Reads) {
        let Some(data) = self.data_mut(id).filter(|data| data.reads != reads) else { return };
        let before = std::mem::take(&mut data.reads);
        for other in before.entities() {
            if let Some(other) = self.data_mut(*other) {
                remove_reader(&mut other.readers, id);
            }
        }
        for other in before.summaries() {
            if let Some(other) = self.data_mut(*other) {
                remove_reader(&mut other.summary_readers, id);
            }
        }
        for key in before.names() {
            self.names.remove_reader(key, id);
        }
        for other in reads.entities() {
            if let Some(other) = self.data_mut(*other) {
                other.readers.push(id);
            }
        }
        for other in reads.summaries() {
            if let Some(other) = self.data_mut(*other) {
                other.summary_readers.push(id);
            }
        }
        for key in reads.names() {
            self.names.add_reader(key.clone(), id);
        }
        if reads.kinds().is_empty() {
            self.name_dependents.remove(&id);
        } else {
            self.name_dependents.insert(id);
        }
        if let Some(data) = self.data_mut(id) {
            data.reads = reads;
        }
    }

    /// Removes an entity that is about to go from both directions.
    pub(super) fn forget_reads(&mut self, id: EntityId) {
        self.set_reads(id, Reads::default());
        let readers = self.data_mut(id).map(|data| {
            let mut readers = std::mem::take(&mut data.readers);
            readers.extend(std::mem::take(&mut data.summary_readers));
            readers
        });
        for reader in readers.unwrap_or_default() {
            if let Some(reader) = self.data_mut(reader) {
                reader.reads.forget(id);
            }
        }
    }

    fn data_mut(&mut self, id: EntityId) -> Option<&mut super::EntityData> {
        self.entities.get_mut(id.0 as usize)?.as_mut()
    }
}

fn remove_reader(readers: &mut SmallVec<[EntityId; 4]>, id: EntityId) {
    if let Some(place) = readers.iter().position(|reader| *reader == id) {
        readers.swap_remove(place);
    }
}
