//! Formatting: the edits that bring a document, or a range of it, into the canonical layout.

use pydslrep_analysis::Snapshot;
use pydslrep_syntax::{Span, TextEdit, format_edits};

/// The edits that bring a file into the canonical layout, in order and without overlaps. Entities with errors stay as
/// they are.
pub fn format(snapshot: &Snapshot) -> Vec<TextEdit> {
    edits(snapshot, &snapshot.text().to_string())
}

/// The edits within a range. An edit moves the text after it, so its end decides whether it is in the range: selecting
/// whole lines indents the first of them, but not the line after the last.
pub fn format_range(snapshot: &Snapshot, range: Span) -> Vec<TextEdit> {
    let text = snapshot.text().to_string();
    let mut edits = edits(snapshot, &text);
    let mut end = range.end;
    if end < Span::of(&text).end {
        // Exclude the line after the last.
        let lines = range.text(&text);
        end -= Span::of(lines).len() - Span::of(lines.trim_end_matches(['\n', '\r'])).len();
    }
    edits.retain(|edit| range.start <= edit.span.end && edit.span.end <= end);
    edits
}

fn edits(snapshot: &Snapshot, text: &str) -> Vec<TextEdit> {
    format_edits(text, snapshot.entities().map(|entity| (entity.span, entity.parse)))
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::apply_edits;

    use pydslrep_analysis::{Database, FileId};

    use super::*;

    fn snapshot(database: &Database, file: FileId) -> Snapshot {
        database.snapshot(file, None).unwrap()
    }

    #[test]
    fn a_document_is_formatted_around_errors() {
        let text = "wheel  a with radius 3\r\nmovement  m of r{slam}\r\nwheel  b with 3\r\n";
        let mut database = Database::new();
        let file = database.open("a.pyr", text);
        assert_eq!(
            apply_edits(text, &format(&snapshot(&database, file))),
            "wheel a with radius 3\r\n\r\nmovement m of r {\r\n  slam\r\n}\r\n\r\nwheel  b with 3\r\n"
        );
    }

    #[test]
    fn edited_documents_are_formatted() {
        let mut database = Database::new();
        let file = database.open("a.pyr", "wheel a with radius 3\nsensor  s\n");
        database.edit(file, Span::new(5, 6), "   ");
        let text = database.text(file).map(ToString::to_string).unwrap();
        assert_eq!(
            apply_edits(&text, &format(&snapshot(&database, file))),
            "wheel a with radius 3\n\nsensor s\n"
        );
    }

    #[test]
    fn a_range_is_formatted_alone() {
        let text = "movement m of r {\nmove 1  meters\nturn   left\nslam\n}\n";
        let mut database = Database::new();
        let file = database.open("a.pyr", text);
        let lines = Span::new(33, 45);
        assert_eq!(lines.text(text), "turn   left\n");
        assert_eq!(
            apply_edits(text, &format_range(&snapshot(&database, file), lines)),
            "movement m of r {\nmove 1  meters\n  turn left\nslam\n}\n"
        );
        assert_eq!(
            format_range(&snapshot(&database, file), Span::of(text)),
            format(&snapshot(&database, file))
        );
        assert_eq!(format_range(&snapshot(&database, file), Span::at(3)), []);
    }
}
