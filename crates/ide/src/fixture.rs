//! Test programs with a cursor, marked `$0`.

use pydslrep_analysis::{Database, Edit, FileId};
use pydslrep_syntax::Span;

use crate::FilePosition;

/// A database with one file, and the position of `$0` in it.
pub(crate) fn at_cursor(fixture: &str) -> (Database, FilePosition) {
    let offset = fixture.find("$0").expect("the fixture has no `$0`");
    let mut database = Database::new();
    let file = database.open("test.pyr", &fixture.replacen("$0", "", 1));
    (database, FilePosition { file, offset: u32::try_from(offset).unwrap() })
}

/// A database with several files, each `(path, text)`, and the position of the only `$0`.
pub(crate) fn at_cursor_in(files: &[(&str, &str)]) -> (Database, FilePosition) {
    let mut database = Database::new();
    let mut position = None;
    for (path, text) in files {
        let file = database.open(path, &text.replacen("$0", "", 1));
        if let Some(offset) = text.find("$0") {
            position = Some(FilePosition { file, offset: u32::try_from(offset).unwrap() });
        }
    }
    (database, position.expect("no file of the fixture has a `$0`"))
}

/// The text of a file with spans in brackets, each after its own mark, for snapshots.
pub(crate) fn marked(database: &Database, file: FileId, spans: &[(Span, &str)]) -> String {
    let mut text = database.text(file).unwrap().to_string();
    let mut spans = spans.to_vec();
    spans.sort_unstable();
    for (span, mark) in spans.into_iter().rev() {
        text.insert(span.end as usize, ']');
        text.insert_str(span.start as usize, &format!("{mark}["));
    }
    text
}

/// Declarations that most fixtures need.
pub(crate) const PARTS: &str = "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5\nsensor front\nsensor back : bumper\n\
     robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }\n";

/// The text of a file after edits that do not overlap.
pub(crate) fn applied(database: &Database, file: FileId, edits: &[Edit]) -> String {
    let mut text = database.text(file).unwrap().to_string();
    let mut edits: Vec<&Edit> = edits.iter().filter(|edit| edit.file == file).collect();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    for edit in edits.into_iter().rev() {
        text.replace_range(std::ops::Range::from(edit.span), &edit.text);
    }
    text
}
