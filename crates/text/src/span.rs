//! Ranges of text.

use std::ops::Range;

use ropey::Rope;

/// A place in a text, or a length, in bytes. Who reads a text refuses it beyond 4 GiB; here the rest of it counts as one
/// place.
pub fn offset(bytes: usize) -> u32 {
    u32::try_from(bytes).unwrap_or(u32::MAX)
}

/// A half-open range of bytes in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Span {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The range from `start` to `end`.
    pub fn new(start: u32, end: u32) -> Self {
        debug_assert!(start <= end);
        Self { start, end }
    }

    /// The empty range at `offset`.
    pub fn at(offset: u32) -> Self {
        Self { start: offset, end: offset }
    }

    /// The range of a whole text.
    pub fn of(text: &str) -> Self {
        (0..text.len()).into()
    }

    /// As [`Self::of`], of a rope.
    pub fn of_rope(text: &Rope) -> Self {
        (0..text.len_bytes()).into()
    }

    /// Length in bytes.
    pub fn len(self) -> u32 {
        self.end - self.start
    }

    /// Returns whether it covers nothing.
    pub fn is_empty(self) -> bool {
        self.start == self.end
    }

    /// Returns whether `offset` is inside or at either end, as a cursor does.
    pub fn touches(self, offset: u32) -> bool {
        self.start <= offset && offset <= self.end
    }

    /// The smallest range that covers both.
    pub fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The same range, `by` bytes further on.
    pub fn shifted(self, by: u32) -> Self {
        Self { start: self.start + by, end: self.end + by }
    }

    /// The text it covers; empty where it does not fit the text.
    pub fn text(self, text: &str) -> &str {
        text.get(Range::from(self)).unwrap_or_default()
    }

    /// As [`Self::text`], of a rope.
    pub fn slice(self, text: &Rope) -> String {
        text.get_byte_slice(Range::from(self)).map_or_else(String::new, |slice| slice.to_string())
    }
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Self {
        Self::new(offset(range.start), offset(range.end))
    }
}

impl From<Span> for Range<usize> {
    fn from(span: Span) -> Self {
        span.start as usize..span.end as usize
    }
}

#[cfg(feature = "chumsky")]
impl chumsky::span::Span for Span {
    type Context = ();
    type Offset = u32;

    fn new((): (), range: Range<u32>) -> Self {
        // The parser library joins token spans front to back, but an empty match between two tokens comes out with
        // its ends swapped; such a span means the point before the next token.
        Self { start: range.start, end: range.end.max(range.start) }
    }
    fn context(&self) {}
    fn start(&self) -> u32 {
        self.start
    }
    fn end(&self) -> u32 {
        self.end
    }
}
