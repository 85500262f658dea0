//! Random programs: always grammatical, mostly meaningful, some with semantic errors.

mod author;
mod choices;
mod layout;
mod mutation;
mod statements;
mod words;

use proptest::prelude::{Strategy, any};

use author::Author;
use choices::Choices;

pub use mutation::mutated;

use crate::Source;

/// Which statements generated programs have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statements {
    /// Only those of language 0.2; and names that are no words of later versions.
    Flat,
    /// All. A third of the programs has only those of 0.2.
    Any,
    /// All whose planned path is known: no `until`, `if` and `slam`. Without [`Recipe::mistakes`], a movement has at most about
    /// 300 actions and 2 000 s when its loops are unrolled, and no circle is smaller than 10 cm.
    Known,
}

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
    /// Which statements there may be.
    pub statements: Statements,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            lines: 60,
            mistakes: true,
            odd_layout: true,
            older_spellings: true,
            imports: false,
            statements: Statements::Any,
        }
    }
}

impl Recipe {
    /// The program of a seed.
    pub fn seeded(self, seed: u64) -> String {
        self.author(Choices::seeded(seed)).text()
    }

    /// A strategy for property tests: failures shrink to smaller programs with simpler choices.
    pub fn strategy(self) -> impl Strategy<Value = String> {
        self.tapes().prop_map(move |tape| self.author(Choices::recorded(tape)).text())
    }

    /// A strategy for projects of several files; `imports` has no meaning here.
    pub fn projects(self) -> impl Strategy<Value = Vec<Source>> {
        let dealing = proptest::collection::vec(any::<u16>(), 100..400);
        (self.tapes(), dealing).prop_map(move |(tape, dealing)| {
            self.author(Choices::recorded(tape)).files(Choices::recorded(dealing))
        })
    }

    fn tapes(self) -> impl Strategy<Value = Vec<u16>> {
        // More than a program of this size needs, so that most reach their length.
        let longest = self.lines.saturating_mul(24) + 24;
        proptest::collection::vec(any::<u16>(), 0..longest)
    }

    fn author(self, choices: Choices) -> Author {
        let mut author = Author::new(self, choices);
        author.write();
        author
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
