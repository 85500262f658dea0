//! Decisions, drawn from a tape of numbers. Zero is always the plainest choice, and so is the end of the tape: that is
//! what lets a failing program shrink.

use std::iter::Peekable;

pub(super) struct Choices {
    tape: Peekable<Box<dyn Iterator<Item = u16>>>,
}

impl Choices {
    pub(super) fn recorded(tape: Vec<u16>) -> Self {
        let tape: Box<dyn Iterator<Item = u16>> = Box::new(tape.into_iter());
        Self { tape: tape.peekable() }
    }

    /// An endless tape, by splitmix64.
    pub(super) fn seeded(seed: u64) -> Self {
        let mut state = seed;
        let tape: Box<dyn Iterator<Item = u16>> = Box::new(std::iter::from_fn(move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut mixed = state;
            mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            u16::try_from((mixed ^ (mixed >> 31)) >> 48).ok()
        }));
        Self { tape: tape.peekable() }
    }

    pub(super) fn has_more(&mut self) -> bool {
        self.tape.peek().is_some()
    }

    /// A number less than `limit`, which is not zero.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        usize::from(self.tape.next().unwrap_or(0)) % limit
    }

    /// True once in so many times.
    pub(super) fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == times - 1
    }

    pub(super) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for index in (1..items.len()).rev() {
            let other = index - self.below(index + 1);
            items.swap(index, other);
        }
    }
}
