//! A statement that is one problem as a whole, with the correct one in its place.

use pydslrep_syntax::Span;

/// A statement and how the language has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rewrite {
    /// From its first token to its last.
    pub(super) span: Span,
    /// The correct spelling.
    pub(super) text: String,
    /// The missing and the superfluous parts.
    pub(super) message: String,
    /// The title of the fix.
    pub(super) title: String,
    /// The pattern to follow.
    pub(super) help: String,
    /// True for a fix that is offered only for a problem that has no other.
    pub(super) is_fallback: bool,
}

impl Rewrite {
    /// Returns whether it replaces all other problems at a span.
    pub(super) fn covers(&self, span: Span) -> bool {
        !self.is_fallback && self.reaches(span)
    }

    /// Returns whether a name is in it as it was written.
    pub(super) fn keeps(&self, name: &str) -> bool {
        self.text.split(' ').any(|word| word == name)
    }

    /// Returns whether a span is within it.
    pub(super) fn reaches(&self, span: Span) -> bool {
        self.span.start <= span.start && span.end <= self.span.end
    }
}
