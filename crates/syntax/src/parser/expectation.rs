//! Expectations of the rules in a place. Rules fail at almost every token that they read, each time with their
//! expectations, so this is a set that is made without allocating.

use crate::{EntityKind, Expected, KEYWORDS, Quantity, TokenKind, TokenSet};

/// A set of [`Expected`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Expectation {
    words: TokenSet,
    /// A bit for each of [`OTHERS`].
    others: u32,
}

/// The words that can be expected beside keywords.
const SIGNS: [TokenKind; 5] = [
    TokenKind::OpenBrace,
    TokenKind::CloseBrace,
    TokenKind::Comma,
    TokenKind::Colon,
    // Rules ask whether it is there.
    TokenKind::Cursor,
];

/// All that is no word; [`bit`] says where each is.
const OTHERS: [Expected; 23] = [
    Expected::NameOf(EntityKind::Wheel),
    Expected::NameOf(EntityKind::Sensor),
    Expected::NameOf(EntityKind::Ip),
    Expected::NameOf(EntityKind::Robot),
    Expected::NameOf(EntityKind::Movement),
    Expected::NameOf(EntityKind::Environment),
    Expected::ReferenceTo(EntityKind::Wheel),
    Expected::ReferenceTo(EntityKind::Sensor),
    Expected::ReferenceTo(EntityKind::Ip),
    Expected::ReferenceTo(EntityKind::Robot),
    Expected::ReferenceTo(EntityKind::Movement),
    Expected::ReferenceTo(EntityKind::Environment),
    Expected::Number(Quantity::Radius),
    Expected::Number(Quantity::Distance),
    Expected::Number(Quantity::Speed),
    Expected::Number(Quantity::Angle),
    Expected::Number(Quantity::Time),
    Expected::Number(Quantity::Count),
    Expected::Port,
    Expected::Address,
    Expected::Path,
    Expected::Action,
    Expected::Declaration,
];

const fn bit(expected: Expected) -> Option<u32> {
    Some(match expected {
        Expected::Word(_) => return None,
        Expected::NameOf(kind) => kind as u32,
        Expected::ReferenceTo(kind) => 6 + kind as u32,
        Expected::Number(quantity) => 12 + quantity as u32,
        Expected::Port => 18,
        Expected::Address => 19,
        Expected::Path => 20,
        Expected::Action => 21,
        Expected::Declaration => 22,
    })
}

/// Each has the bit of its place, and no other has it: what is put into a set is what comes out.
const _: () = {
    assert!(OTHERS.len() <= u32::BITS as usize);
    let mut place = 0;
    while place < OTHERS.len() {
        assert!(matches!(bit(OTHERS[place]), Some(bit) if bit as usize == place));
        place += 1;
    }
};

impl Expectation {
    /// Returns the union of the two.
    pub(super) fn or(self, other: Self) -> Self {
        Self { words: self.words.or(other.words), others: self.others | other.others }
    }

    pub(super) fn is_empty(self) -> bool {
        self == Self::default()
    }

    /// All that is in it, in order.
    pub(super) fn to_vec(self) -> Vec<Expected> {
        let keywords = KEYWORDS.iter().map(|(keyword, _)| *keyword);
        let words = SIGNS.into_iter().chain(keywords).filter(|word| self.words.has(*word));
        let is_there = |other: &Expected| bit(*other).is_some_and(|bit| self.others & (1 << bit) != 0);
        let mut all: Vec<Expected> =
            words.map(Expected::Word).chain(OTHERS.into_iter().filter(is_there)).collect();
        all.sort_unstable();
        all
    }
}

impl From<Expected> for Expectation {
    fn from(expected: Expected) -> Self {
        let words = match expected {
            Expected::Word(word) => TokenSet::of(&[word]),
            _ => TokenSet::default(),
        };
        Self { words, others: bit(expected).map_or(0, |bit| 1 << bit) }
    }
}

impl FromIterator<Expected> for Expectation {
    fn from_iter<I: IntoIterator<Item = Expected>>(all: I) -> Self {
        all.into_iter().map(Self::from).fold(Self::default(), Self::or)
    }
}
