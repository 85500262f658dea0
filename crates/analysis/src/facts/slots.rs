//! The slots that tile a file, and where each of them is.

use std::ops::{Deref, Range};

use crate::entity::EntityId;

/// Where an entity is in its file, without its absolute position: that would change with every edit before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct EntitySlot {
    pub(crate) entity: EntityId,
    pub(crate) len: u32,
}

/// The lengths of so many slots are added up, so that a place is found in a few hundred steps even in a file of a
/// hundred thousand lines, and a slot that grows changes one sum.
const BLOCK: usize = 64;

/// The slots of a file in the order of the text; their lengths add up to the text's.
#[derive(Debug, Clone, Default)]
pub(crate) struct EntitySlots {
    list: Vec<EntitySlot>,
    /// The length of each [`BLOCK`] of slots.
    blocks: Vec<u32>,
}

impl Deref for EntitySlots {
    type Target = [EntitySlot];

    fn deref(&self) -> &[EntitySlot] {
        &self.list
    }
}

impl From<Vec<EntitySlot>> for EntitySlots {
    fn from(list: Vec<EntitySlot>) -> Self {
        let blocks = list.chunks(BLOCK).map(length).collect();
        Self { list, blocks }
    }
}

impl EntitySlots {
    /// The slot that holds `offset` (the last one at the end of the text) and where it starts.
    pub(crate) fn at(&self, offset: u32) -> (usize, u32) {
        let (mut index, mut start) = (0, 0);
        for len in &self.blocks {
            if offset < start + len {
                break;
            }
            start += len;
            index += BLOCK;
        }
        for slot in self.list.get(index..).unwrap_or_default() {
            if offset < start + slot.len {
                return (index, start);
            }
            start += slot.len;
            index += 1;
        }
        let last = self.list.len().saturating_sub(1);
        (last, start - self.list.last().map_or(0, |slot| slot.len))
    }

    /// Where the slot at `index` starts.
    pub(crate) fn start_of(&self, index: usize) -> u32 {
        let block = index / BLOCK;
        self.blocks[..block].iter().sum::<u32>() + length(&self.list[block * BLOCK..index])
    }

    /// Puts other slots in the place of a range of them.
    pub(crate) fn replace(&mut self, range: Range<usize>, slots: Vec<EntitySlot>) {
        let first = range.start / BLOCK;
        let last = if range.len() == slots.len() { range.end.div_ceil(BLOCK) } else { usize::MAX };
        self.list.splice(range, slots);
        if last == usize::MAX {
            self.blocks.truncate(first);
            self.blocks.extend(self.list[first * BLOCK..].chunks(BLOCK).map(length));
        } else {
            let sums = self.list[first * BLOCK..].chunks(BLOCK).map(length);
            self.blocks[first..last].iter_mut().zip(sums).for_each(|(block, sum)| *block = sum);
        }
    }
}

fn length(slots: &[EntitySlot]) -> u32 {
    slots.iter().map(|slot| slot.len).sum()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Database;

    fn slots(lens: &[u32]) -> Vec<EntitySlot> {
        let mut database = Database::new();
        let file = database.open("a.pyr", "");
        let any = database.slots(file)[0];
        lens.iter().map(|&len| EntitySlot { len, ..any }).collect()
    }

    /// As the words say it, one slot after the other.
    fn walk(list: &[EntitySlot], offset: u32) -> (usize, u32) {
        let mut start = 0;
        for (index, slot) in list.iter().enumerate() {
            if offset < start + slot.len || index + 1 == list.len() {
                return (index, start);
            }
            start += slot.len;
        }
        (0, 0)
    }

    proptest! {
        #[test]
        fn places_are_those_of_a_walk(
            lens in prop::collection::vec(0_u32..9, 0..400),
            edits in prop::collection::vec((0_usize..400, 0_usize..90, prop::collection::vec(0_u32..9, 0..90)), 0..4),
            same in any::<bool>(),
        ) {
            let mut found = EntitySlots::from(slots(&lens));
            for (from, count, new) in edits {
                let from = from.min(found.len());
                let count = if same { new.len() } else { count }.min(found.len() - from);
                let new = if same { &new[..count] } else { &new[..] };
                found.replace(from..from + count, slots(new));
            }
            let list = found.to_vec();
            for offset in 0..=length(&list) {
                prop_assert_eq!(found.at(offset), walk(&list, offset));
            }
            for index in 0..=list.len() {
                prop_assert_eq!(found.start_of(index), length(&list[..index]));
            }
        }
    }
}
