//! Programs at random: always grammatical, mostly meaningful, some of them with mistakes in what they mean.

mod author;
mod choices;
mod layout;
mod words;

use proptest::prelude::{Strategy, any};

use author::Author;
use choices::Choices;

/// What kind of programs to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "any of them goes with any other")]
pub struct Recipe {
    /// About how many entities and actions there may be together; each would be one line in a tidy program.
    pub lines: usize,
    /// Whether there may be mistakes in the meaning, from the whole catalogue. Without, a program may still earn
    /// warnings and hints, such as for a sensor nothing uses.
    pub mistakes: bool,
    /// Whether there may be comments, odd line ends, missing white space, `^` and odd ways to write a number. Without,
    /// there is one space between two tokens and an entity per line.
    pub odd_layout: bool,
    /// Whether the two older spellings may occur.
    pub older_spellings: bool,
    /// Whether imports may stand at the top (of `lib.pyr` and `parts/more.pyr`).
    pub imports: bool,
}

impl Default for Recipe {
    fn default() -> Self {
        Self { lines: 60, mistakes: true, odd_layout: true, older_spellings: true, imports: false }
    }
}

impl Recipe {
    /// The program that belongs to a seed: the same one every time.
    pub fn seeded(self, seed: u64) -> String {
        self.write(Choices::seeded(seed))
    }

    /// For properties: what fails shrinks to a smaller program of plainer choices.
    pub fn strategy(self) -> impl Strategy<Value = String> {
        // More than a program of this size needs, so that most end because they are long enough.
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

/// A program of about so many lines, mistakes and odd layout included: the same one every time for a seed.
pub fn program(seed: u64, lines: usize) -> String {
    Recipe { lines, ..Recipe::default() }.seeded(seed)
}

/// Programs of up to about sixty lines, mistakes and odd layout included.
pub fn programs() -> impl Strategy<Value = String> {
    Recipe::default().strategy()
}
