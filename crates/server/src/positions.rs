//! Positions: the only place where the protocol's lines and columns meet byte offsets.
//!
//! A client counts columns in UTF-8, UTF-16 or UTF-32 code units, as negotiated; everything else counts
//! bytes. Whatever a client sends becomes a valid offset: lines and columns past the end are clamped (columns to
//! before the line's ending), and a position inside a character snaps down to its start.

use std::cell::Cell;

use pydslrep_syntax::Span;
use pydslrep_text::offset as to_u32;
use ropey::{Rope, RopeSlice};
use tower_lsp::ls_types::{Position, PositionEncodingKind, Range};

/// The unit in which a client counts columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// Two for characters outside the basic plane, else one: the protocol's default.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// Chooses one that the client offers: UTF-8 if possible, because it costs nothing; otherwise UTF-16, which every
    /// client must support; UTF-32 only where a client offers nothing else.
    pub(crate) fn negotiate(offered: Option<&[PositionEncodingKind]>) -> Self {
        let offered = offered.unwrap_or_default();
        let offers = |kind| offered.contains(&kind);
        if offers(PositionEncodingKind::UTF8) {
            Self::Utf8
        } else if offers(PositionEncodingKind::UTF32) && !offers(PositionEncodingKind::UTF16) {
            Self::Utf32
        } else {
            Self::Utf16
        }
    }

    /// The protocol's name for it.
    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }

    /// Length of a text in this unit.
    pub(crate) fn length(self, text: &str) -> u32 {
        to_u32(match self {
            Self::Utf8 => text.len(),
            Self::Utf16 if text.is_ascii() => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
            Self::Utf32 => text.chars().count(),
        })
    }
}

/// The byte offset of a position.
pub(crate) fn to_offset(text: &Rope, position: Position, encoding: Encoding) -> u32 {
    let line = position.line as usize;
    if line >= text.len_lines() {
        return to_u32(text.len_bytes());
    }
    let content = without_ending(text.line(line));
    let column = position.character as usize;
    let char_index = match encoding {
        Encoding::Utf8 => content.byte_to_char(column.min(content.len_bytes())),
        Encoding::Utf16 => content.utf16_cu_to_char(column.min(content.len_utf16_cu())),
        Encoding::Utf32 => column.min(content.len_chars()),
    };
    to_u32(text.line_to_byte(line) + content.char_to_byte(char_index))
}

/// The position of a byte offset; past the end it is the end.
pub(crate) fn to_position(text: &Rope, offset: u32, encoding: Encoding) -> Position {
    let offset = (offset as usize).min(text.len_bytes());
    let line = text.byte_to_line(offset);
    let content = without_ending(text.line(line));
    let byte = (offset - text.line_to_byte(line)).min(content.len_bytes());
    let char_index = content.byte_to_char(byte);
    let column = match encoding {
        Encoding::Utf8 => content.char_to_byte(char_index),
        Encoding::Utf16 => content.char_to_utf16_cu(char_index),
        Encoding::Utf32 => char_index,
    };
    Position::new(to_u32(line), to_u32(column))
}

/// The bytes a range covers; its ends may be swapped.
pub(crate) fn to_span(text: &Rope, range: Range, encoding: Encoding) -> Span {
    let a = to_offset(text, range.start, encoding);
    let b = to_offset(text, range.end, encoding);
    Span { start: a.min(b), end: a.max(b) }
}

/// The range that bytes cover.
pub(crate) fn to_range(text: &Rope, span: Span, encoding: Encoding) -> Range {
    Range::new(to_position(text, span.start, encoding), to_position(text, span.end, encoding))
}

/// Converts many offsets of one text, or of a part of it: worth its pass over the text from about a hundred offsets.
pub(crate) struct LineTable {
    text: String,
    /// Where the text starts in its document.
    offset: u32,
    line: u32,
    /// Where its lines start in it.
    starts: Vec<u32>,
    encoding: Encoding,
    /// The line of the last result: offsets are usually in order.
    last: Cell<usize>,
}

impl LineTable {
    /// Reads the whole text once.
    pub(crate) fn new(text: &Rope, encoding: Encoding) -> Self {
        Self::read(text.slice(..), 0, 0, encoding)
    }

    /// Reads only the lines that `span` touches; offsets outside them are clamped to them.
    pub(crate) fn of_part(text: &Rope, span: Span, encoding: Encoding) -> Self {
        let line_of = |offset: u32| text.byte_to_line((offset as usize).min(text.len_bytes()));
        let (first, after) = (line_of(span.start), line_of(span.end) + 1);
        let start = text.line_to_char(first);
        let part = text.slice(start..text.line_to_char(after));
        Self::read(part, text.char_to_byte(start), first, encoding)
    }

    fn read(text: RopeSlice<'_>, offset: usize, line: usize, encoding: Encoding) -> Self {
        let text = text.to_string();
        let mut starts = vec![0];
        let bytes = text.as_bytes();
        for (at, &byte) in bytes.iter().enumerate() {
            if byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n')) {
                starts.push(to_u32(at + 1));
            }
        }
        Self { text, offset: to_u32(offset), line: to_u32(line), starts, encoding, last: Cell::new(0) }
    }

    /// As [`to_position`].
    pub(crate) fn position(&self, offset: u32) -> Position {
        let offset = self.clamp(offset);
        let line = self.line_of(to_u32(offset));
        let before = &self.text[self.starts[line] as usize..offset];
        // This applies only between the two characters of a CRLF.
        let before = before.strip_suffix('\r').unwrap_or(before);
        Position::new(self.line + to_u32(line), self.encoding.length(before))
    }

    /// As [`to_range`].
    pub(crate) fn range(&self, span: Span) -> Range {
        Range::new(self.position(span.start), self.position(span.end))
    }

    /// An offset in the document as one in the text, at a character's start.
    fn clamp(&self, offset: u32) -> usize {
        let mut offset = (offset.saturating_sub(self.offset) as usize).min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }

    fn line_of(&self, offset: u32) -> usize {
        let near = self.last.get();
        let holds = |line: usize| {
            self.starts.get(line).is_some_and(|&start| start <= offset)
                && self.starts.get(line + 1).is_none_or(|&next| offset < next)
        };
        let line = (near..near + 4)
            .find(|&line| holds(line))
            .unwrap_or_else(|| self.starts.partition_point(|&start| start <= offset) - 1);
        self.last.set(line);
        line
    }
}

fn without_ending(line: RopeSlice<'_>) -> RopeSlice<'_> {
    let mut end = line.len_chars();
    if end > 0 && line.char(end - 1) == '\n' {
        end -= 1;
    }
    if end > 0 && line.char(end - 1) == '\r' {
        end -= 1;
    }
    line.slice(..end)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Encoding; 3] = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32];
    const TEXTS: &[&str] = &[
        "",
        "wheel a with radius 4.5",
        "a\nb\n",
        "a\r\nb\r\n\r\nc",
        "a\rb\r\rc\r",
        "mixed\nlines\r\nof\rall\n\rkinds",
        "// é ü\n",
        "// 日本語 comment\nwheel",
        "// 🤖🛞 robots\r\n🤖",
        "e\u{301} combining\n\u{feff}bom",
        "one line\u{2028}still it\u{b}and\u{c}this\u{85}too\n",
    ];

    fn offset(text: &str, line: u32, column: u32, encoding: Encoding) -> u32 {
        to_offset(&Rope::from_str(text), Position::new(line, column), encoding)
    }

    #[test]
    fn every_character_survives_the_way_there_and_back() {
        for text in TEXTS {
            let rope = Rope::from_str(text);
            for encoding in ALL {
                let table = LineTable::new(&rope, encoding);
                for (at, _) in text.char_indices().chain([(text.len(), ' ')]) {
                    let at32 = to_u32(at);
                    let position = to_position(&rope, at32, encoding);
                    assert_eq!(table.position(at32), position, "{text:?} at {at}, {encoding:?}");
                    let inside_crlf = at > 0 && text[..at].ends_with('\r') && text[at..].starts_with('\n');
                    let expected = if inside_crlf { at32 - 1 } else { at32 };
                    assert_eq!(
                        to_offset(&rope, position, encoding),
                        expected,
                        "{text:?} at {at}, {encoding:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn columns_are_counted_in_the_negotiated_unit() {
        // Bytes: 🤖 4, 日 3, é 2. UTF-16: 2, 1, 1. Characters: 1, 1, 1.
        let rope = Rope::from_str("x\n🤖日é|");
        let bar = to_u32("x\n🤖日é".len());
        let columns = ALL.map(|encoding| to_position(&rope, bar, encoding));
        assert_eq!(columns, [Position::new(1, 9), Position::new(1, 4), Position::new(1, 3)]);
    }

    #[test]
    fn lines_end_at_lf_crlf_and_cr_only() {
        assert_eq!(offset("a\r\nb\rc\nd", 3, 0, Encoding::Utf16), 7);
        let rope = Rope::from_str("a\u{2028}b\u{b}c\u{85}d\ne");
        assert_eq!(to_position(&rope, to_u32(rope.len_bytes()), Encoding::Utf16), Position::new(1, 1));
    }

    #[test]
    fn positions_past_the_end_are_clamped() {
        for encoding in ALL {
            for text in ["ab\r\ncd", "ab\rcd", "ab\ncd"] {
                assert_eq!(offset(text, 0, 99, encoding), 2, "before the line's ending");
                assert_eq!(offset(text, 1, u32::MAX, encoding), to_u32(text.len()));
                assert_eq!(offset(text, 2, 0, encoding), to_u32(text.len()));
                assert_eq!(offset(text, u32::MAX, u32::MAX, encoding), to_u32(text.len()));
            }
            assert_eq!(offset("", 7, 7, encoding), 0);
            assert_eq!(to_position(&Rope::from_str("ab\n"), 99, encoding), Position::new(1, 0));
        }
    }

    #[test]
    fn positions_inside_a_character_snap_down() {
        assert_eq!(offset("🤖x", 0, 1, Encoding::Utf16), 0, "between surrogates");
        for column in 0..4 {
            assert_eq!(offset("🤖x", 0, column, Encoding::Utf8), 0);
        }
        assert_eq!(offset("🤖x", 0, 4, Encoding::Utf8), 4);
        assert_eq!(to_position(&Rope::from_str("é"), 1, Encoding::Utf8), Position::new(0, 0));
        assert_eq!(LineTable::new(&Rope::from_str("é"), Encoding::Utf8).position(1), Position::new(0, 0));
    }

    #[test]
    fn swapped_ranges_are_understood() {
        let rope = Rope::from_str("abc\ndef");
        let range = Range::new(Position::new(1, 2), Position::new(0, 1));
        assert_eq!(to_span(&rope, range, Encoding::Utf16), Span { start: 1, end: 6 });
    }

    #[test]
    fn the_best_encoding_offered_is_taken() {
        let (utf8, utf16, utf32) =
            (PositionEncodingKind::UTF8, PositionEncodingKind::UTF16, PositionEncodingKind::UTF32);
        assert_eq!(Encoding::negotiate(None), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(&[])), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(std::slice::from_ref(&utf16))), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(std::slice::from_ref(&utf32))), Encoding::Utf32);
        assert_eq!(Encoding::negotiate(Some(&[utf32.clone(), utf16.clone()])), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(Some(&[utf16, utf32, utf8])), Encoding::Utf8);
        assert_eq!(Encoding::negotiate(Some(&["utf-7".to_owned().into()])), Encoding::Utf16);
    }

    #[test]
    fn a_table_of_a_part_agrees_with_the_whole() {
        for text in TEXTS {
            let rope = Rope::from_str(text);
            let length = to_u32(text.len());
            for encoding in ALL {
                for (start, end) in
                    (0..=length).flat_map(|start| (start..=length).map(move |end| (start, end)))
                {
                    let part = LineTable::of_part(&rope, Span { start, end }, encoding);
                    for offset in start..=end {
                        assert_eq!(
                            part.position(offset),
                            to_position(&rope, offset, encoding),
                            "{text:?} at {offset} of {start}..{end}"
                        );
                    }
                }
            }
        }
    }
}
