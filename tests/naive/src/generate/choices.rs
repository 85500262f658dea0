//! Random choices from a tape of numbers. Zero, and the end of the tape, is always the simplest choice, so that failing
//! programs shrink.

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

    /// A number below `limit`, which must not be zero.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        usize::from(self.tape.next().unwrap_or(0)) % limit
    }

    /// True with a probability of 1 / `times`.
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
