//! Positions in the files of a database.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::Span;
use pydslrep_text::LineColumn;
use serde::Serialize;

/// From one position to right before another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct PlaceRange {
    pub(crate) start: LineColumn,
    pub(crate) end: LineColumn,
}

/// The position of an offset in bytes.
pub(crate) fn place(database: &Database, file: FileId, offset: u32) -> LineColumn {
    let start = LineColumn { line: 1, column: 1 };
    database.text(file).map_or(start, |text| LineColumn::in_rope(text, offset))
}

/// Where a span is in a text that no database has.
pub(crate) fn range_in(text: &str, span: Span) -> PlaceRange {
    PlaceRange { start: LineColumn::in_text(text, span.start), end: LineColumn::in_text(text, span.end) }
}

/// Where a span is.
pub(crate) fn range(database: &Database, file: FileId, span: Span) -> PlaceRange {
    PlaceRange { start: place(database, file, span.start), end: place(database, file, span.end) }
}
