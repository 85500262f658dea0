//! Random programs: always grammatical, mostly meaningful, some with semantic errors.

mod author;
mod choices;
mod layout;
mod words;

use proptest::prelude::{Strategy, any};

use author::Author;
use choices::Choices;

/// The options of generated programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "they are independent")]
pub struct Recipe {
    /// The approximate number of entities and actions; each is one line in a tidy program.
    pub lines: usize,
    /// Whether there may be semantic errors of all codes. Otherwise there may still be warnings and hints, such as for
    /// unused sensors.
    pub mistakes: bool,
    /// Whether there may be comments, unusual line breaks, missing white space, `^` and unusual number formats. Otherwise
    /// there is one entity per line, with single spaces.
    pub odd_layout: bool,
    /// Whether the two deprecated spellings may occur.
    pub older_spellings: bool,
    /// Whether there may be imports (of `lib.pyr` and `parts/more.pyr`).
    pub imports: bool,
}

impl Default for Recipe {
    fn default() -> Self {
        Self { lines: 60, mistakes: true, odd_layout: true, older_spellings: true, imports: false }
    }
}

impl Recipe {
    /// The program of a seed.
    pub fn seeded(self, seed: u64) -> String {
        self.write(Choices::seeded(seed))
    }

    /// A strategy for property tests: failures shrink to smaller programs with simpler choices.
    pub fn strategy(self) -> impl Strategy<Value = String> {
        // More than a program of this size needs, so that most reach their length.
        let longest = self.lines.saturating_mul(12) + 12;
        proptest::collection::vec(any::<u16>(), 0..longest)
            .prop_map(move |tape| self.write(Choices::recorded(tape)))
    }

    fn write(self, choices: Choices) -> String {
        let mut author = Author::new(self, choices);
        author.write();
        author.text()
    }
}

/// The program of a seed with about `lines` lines, including errors and unusual layout.
pub fn program(seed: u64, lines: usize) -> String {
    Recipe { lines, ..Recipe::default() }.seeded(seed)
}

/// Programs of up to about sixty lines, including errors and unusual layout.
pub fn programs() -> impl Strategy<Value = String> {
    Recipe::default().strategy()
}
