//! An entity as it was before an edit, and its tokens after it.

use crate::lexer::{Token, lex_unless};
use crate::{Parse, Span};

/// What an entity was before an edit.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// What was read.
    pub parse: &'a Parse,
    /// Where its text is now.
    pub now: Span,
    /// The range of its earlier text that was replaced.
    pub edited: Span,
    /// How much longer its text is now, in bytes.
    pub growth: i64,
}

/// How far behind a token the lexer may look to find its end, in bytes: a sign and a letter, which belong to a name
/// together, have seven.
const LOOKAHEAD: u32 = 16;

/// As [`lex`](crate::lex), of a text in which an entity may be known as it was before an edit: of that, only the tokens are
/// read that the edit may have changed.
pub fn lex_again(text: &str, earlier: Option<&Earlier<'_>>) -> Vec<Token> {
    lex_unless(text, |start, before| {
        let previous = before.last().map(|(_, last)| last.end);
        earlier.and_then(|earlier| earlier.tokens_at(start, previous))
    })
}

impl<'a> Earlier<'a> {
    /// The tokens from `start` on that are as they were, with how far they have moved, where a token begins there after one
    /// that ends at `previous`.
    fn tokens_at(&self, start: u32, previous: Option<u32>) -> Option<(&'a [Token], i64)> {
        if !(self.now.start..self.now.end).contains(&start) {
            return None;
        }
        let tokens = &self.parse.tokens;
        let offset = i64::from(self.now.start);
        if start == self.now.start {
            let end = tokens.partition_point(|(_, span)| span.end + LOOKAHEAD <= self.edited.start);
            return (end > 0).then(|| (&tokens[..end], offset));
        }
        let then = u32::try_from(i64::from(start) - offset - self.growth).ok()?;
        let index = tokens.partition_point(|(_, span)| span.start < then);
        let begins = tokens.get(index).is_some_and(|(_, span)| span.start == then);
        // Tokens without a gap between them may be one.
        let gap = index.checked_sub(1).is_some_and(|last| tokens[last].1.end < then);
        let is_after = then >= self.edited.end && gap && previous.is_some_and(|end| end < start);
        (begins && is_after).then(|| (&tokens[index..], offset + self.growth))
    }
}
