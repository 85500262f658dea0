//! Which statements a program may have.

/// An edition of the language.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Edition {
    /// All that this version has.
    #[default]
    Current,
    /// The language of the article of 2020, and nothing else.
    Article,
}

impl Edition {
    /// All of them, the usual one first.
    pub const ALL: [Self; 2] = [Self::Current, Self::Article];

    /// The word it is chosen by.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Current => "current",
            Self::Article => "article",
        }
    }

    /// Returns a description in a few words.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Current => "everything that this version has",
            Self::Article => "only what the article of 2020 has: the rest is an error",
        }
    }

    /// The edition of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|edition| edition.word() == word)
    }
}
