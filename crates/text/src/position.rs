//! Lines and columns as people count them. The protocol of editors counts otherwise; the server converts.

use ropey::Rope;
use serde::Serialize;

/// A line and a column, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct LineColumn {
    /// Ends with `\n`, `\r\n` or `\r`.
    pub line: usize,
    /// In Unicode characters.
    pub column: usize,
}

impl LineColumn {
    /// The position of a byte offset; an offset past the end is the end.
    pub fn in_rope(text: &Rope, offset: u32) -> Self {
        let offset = (offset as usize).min(text.len_bytes());
        let line = text.byte_to_line(offset);
        let column = text.byte_to_char(offset) - text.line_to_char(line);
        Self { line: line + 1, column: column + 1 }
    }

    /// As [`Self::in_rope`], in a text that is read once.
    pub fn in_text(text: &str, offset: u32) -> Self {
        let before = text.get(..offset as usize).unwrap_or(text);
        let ends_line = |(at, end): (usize, char)| {
            let is_end = end == '\n' || (end == '\r' && !text[at + 1..].starts_with('\n'));
            is_end.then_some(at + 1)
        };
        let (mut line, mut start) = (1, 0);
        for end in before.char_indices().filter_map(ends_line) {
            (line, start) = (line + 1, end);
        }
        Self { line, column: before[start..].chars().count() + 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_end_in_every_way() {
        let text = "// 机器人 🤖 x\r\na\rb\nc";
        let rope = Rope::from_str(text);
        let at = |needle: &str| {
            let place = LineColumn::in_text(text, u32::try_from(text.find(needle).unwrap()).unwrap());
            (place.line, place.column)
        };
        assert_eq!(
            [at("机"), at("🤖"), at("x"), at("a\r"), at("b"), at("c")],
            [(1, 4), (1, 8), (1, 10), (2, 1), (3, 1), (4, 1)]
        );
        let offsets = text.char_indices().map(|(offset, _)| u32::try_from(offset).unwrap());
        for offset in offsets.chain([1000]) {
            assert_eq!(LineColumn::in_text(text, offset), LineColumn::in_rope(&rope, offset), "{offset}");
        }
        assert_eq!(LineColumn::in_text(text, 1000), LineColumn { line: 4, column: 2 });
    }
}
