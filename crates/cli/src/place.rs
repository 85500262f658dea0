//! Places in a text as people count them.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::Span;
use serde::Serialize;

/// A line and a column, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Place {
    pub(crate) line: usize,
    /// In Unicode characters.
    pub(crate) column: usize,
}

/// From one place to right before another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct PlaceRange {
    pub(crate) start: Place,
    pub(crate) end: Place,
}

/// Where an offset in bytes is; at the end where it is behind it.
pub(crate) fn place(database: &Database, file: FileId, offset: u32) -> Place {
    let Some(text) = database.text(file) else { return Place { line: 1, column: 1 } };
    let offset = (offset as usize).min(text.len_bytes());
    let line = text.byte_to_line(offset);
    let column = text.byte_to_char(offset) - text.line_to_char(line);
    Place { line: line + 1, column: column + 1 }
}

/// Where an offset in bytes is in a text that no database has; at the end where it is behind it.
fn place_in(text: &str, offset: u32) -> Place {
    let before = text.get(..offset as usize).unwrap_or(text);
    let ends_line = |(at, end): (usize, char)| {
        let is_end = end == '\n' || (end == '\r' && !text[at + 1..].starts_with('\n'));
        is_end.then_some(at + 1)
    };
    let ends: Vec<usize> = before.char_indices().filter_map(ends_line).collect();
    let start = ends.last().copied().unwrap_or(0);
    Place { line: ends.len() + 1, column: before[start..].chars().count() + 1 }
}

/// Where a span is in a text that no database has.
pub(crate) fn range_in(text: &str, span: Span) -> PlaceRange {
    PlaceRange { start: place_in(text, span.start), end: place_in(text, span.end) }
}

/// Where a span is.
pub(crate) fn range(database: &Database, file: FileId, span: Span) -> PlaceRange {
    PlaceRange { start: place(database, file, span.start), end: place(database, file, span.end) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_end_in_every_way() {
        let mut database = Database::new();
        let text = "// 机器人 🤖 x\r\na\rb\nc";
        let file = database.open("a.pyr", text);
        let at = |needle: &str| {
            let place = place(&database, file, u32::try_from(text.find(needle).unwrap()).unwrap());
            (place.line, place.column)
        };
        assert_eq!(
            [at("机"), at("🤖"), at("x"), at("a\r"), at("b"), at("c")],
            [(1, 4), (1, 8), (1, 10), (2, 1), (3, 1), (4, 1)]
        );
        for offset in text.char_indices().map(|(offset, _)| u32::try_from(offset).unwrap()) {
            assert_eq!(place_in(text, offset), place(&database, file, offset), "{offset}");
        }
        assert_eq!(place_in(text, 1000), place(&database, file, 1000));
        let end = place(&database, file, 1000);
        assert_eq!((end.line, end.column), (4, 2));
    }
}
