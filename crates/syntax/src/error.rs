//! Syntax errors as data. Their wording is up to the caller.

use smol_str::SmolStr;

use crate::{EntityKind, Span, TokenKind};

/// One mistake in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SyntaxError {
    /// The smallest text that has to change; empty where something is missing.
    pub span: Span,
    /// Its kind, with the details.
    pub kind: SyntaxErrorKind,
}

/// The kinds of mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SyntaxErrorKind {
    /// Something has to be between what came before and what comes next.
    Missing {
        /// All that could be there.
        expected: Vec<Expected>,
        /// The next token.
        found: Found,
        /// The entity it is part of.
        inside: Option<EntityKind>,
    },
    /// Something is where something else belongs.
    Unexpected {
        /// All that could be there.
        expected: Vec<Expected>,
        /// The token that is there.
        found: Found,
        /// The entity it is part of.
        inside: Option<EntityKind>,
    },
    /// Something that is missing elsewhere: it is too early or too late.
    Misplaced {
        /// As written.
        written: SmolStr,
        /// Where it belongs.
        to: u32,
        /// The entity it is part of.
        inside: Option<EntityKind>,
    },
    /// A list or a movement's actions without their braces; the opening one belongs at the error's place.
    Unbraced {
        /// Where the closing brace belongs.
        close: u32,
        /// The entity it is part of.
        inside: Option<EntityKind>,
    },
    /// A word that is nearly a keyword that could be there.
    Misspelt {
        /// As written.
        written: SmolStr,
        /// The nearest keyword.
        keyword: TokenKind,
    },
    /// A keyword where a name belongs; `^` before it would make it one.
    KeywordAsName {
        /// As written.
        written: SmolStr,
        /// The kind of the named entity.
        of: EntityKind,
    },
    /// Digits and points that are no number.
    MalformedNumber {
        /// As written.
        written: SmolStr,
    },
    /// A port with a fraction, or an address for a port.
    PortNotWhole {
        /// As written.
        written: SmolStr,
    },
    /// `{ }` where at least one reference must be.
    EmptyList {
        /// The kind of its entries.
        of: EntityKind,
    },
    /// Characters no token starts with.
    InvalidCharacter {
        /// As written.
        written: SmolStr,
    },
    /// A name with characters in it that names cannot have.
    InvalidName {
        /// The whole name as written.
        written: SmolStr,
    },
    /// A comment as other languages write it; the error is at what begins it.
    ForeignComment {
        /// The text that begins it.
        written: SmolStr,
    },
    /// `/*` without `*/`.
    UnterminatedComment,
    /// `"` without its end on the line.
    UnterminatedString,
}

/// Something that could be in a place, in a person's terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Expected {
    /// A certain word or sign.
    Word(TokenKind),
    /// A name for a new entity.
    NameOf(EntityKind),
    /// The name of an entity declared elsewhere.
    ReferenceTo(EntityKind),
    /// A number.
    Number(Quantity),
    /// A port.
    Port,
    /// An IPv4 address.
    Address,
    /// A path in quotes.
    Path,
    /// Another action.
    Action,
    /// The next entity, or nothing.
    Declaration,
}

/// The quantity that a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// A wheel's radius.
    Radius,
    /// The distance of a move.
    Distance,
    /// The speed of a move.
    Speed,
    /// The angle of a turn.
    Angle,
    /// The time of a wait.
    Time,
    /// The number of rounds.
    Count,
}

impl Quantity {
    /// Returns its name in messages, with its unit where it has only one.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::Radius => "a radius in centimetres",
            Self::Distance => "a distance",
            Self::Speed => "a speed in centimetres per second",
            Self::Angle => "an angle in degrees",
            Self::Time => "a time in seconds",
            Self::Count => "a number of times",
        }
    }

    /// Returns its name in messages, without article and unit.
    pub fn noun(self) -> &'static str {
        let phrase = self.phrase();
        let noun = phrase.split_once(' ').map_or(phrase, |(_, noun)| noun);
        noun.split_once(" in ").map_or(noun, |(noun, _)| noun)
    }

    /// Its placeholder in the form of a statement.
    pub fn placeholder(self) -> &'static str {
        match self {
            Self::Radius => "CENTIMETRES",
            Self::Distance => "DISTANCE",
            Self::Speed => "SPEED",
            Self::Angle => "DEGREES",
            Self::Time => "SECONDS",
            Self::Count => "COUNT",
        }
    }
}

/// The token that is where something else was expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Found {
    /// The end of the entity.
    End,
    /// This text.
    Text(SmolStr),
}
