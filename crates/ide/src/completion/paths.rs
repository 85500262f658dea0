//! Paths of imports: the programs that the database knows, as this file has to name them.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::{Span, Token, TokenKind};

use super::context::CursorContext;
use super::{Completion, CompletionKind};
use crate::FilePosition;
use crate::document_links::contents;

/// The path being typed.
pub(super) struct PathAt {
    /// What is between the quotes.
    span: Span,
    /// Whether the closing quote is missing.
    is_open: bool,
}

/// The string behind `import` that has the cursor between its quotes.
pub(super) fn string_at(database: &Database, position: FilePosition) -> Option<PathAt> {
    let before = position.offset.checked_sub(1)?;
    let entity = database.entity_at(position.file, before)?;
    let start = entity.span.start;
    let mut tokens = entity.parse.tokens.iter().filter(|(token, _)| !token.is_comment());
    let first = tokens.next().filter(|(token, _)| *token == TokenKind::Import);
    let (token, span) =
        tokens.next().filter(|(token, span)| is_at(*token, span.shifted(start), position.offset))?;
    first?;
    let (span, is_open) = (span.shifted(start), *token == TokenKind::UnterminatedString);
    let end = if is_open { span.end } else { span.end - 1 };
    Some(PathAt { span: Span::new(span.start + 1, end), is_open })
}

fn is_at(token: TokenKind, span: Span, offset: u32) -> bool {
    match token {
        TokenKind::String => span.start < offset && offset < span.end,
        TokenKind::UnterminatedString => span.start < offset && offset <= span.end,
        _ => false,
    }
}

/// The paths for a string.
pub(super) fn paths(database: &Database, file: FileId, at: &PathAt) -> Vec<Completion> {
    let text = |path: &str| if at.is_open { format!("{path}\"") } else { path.to_owned() };
    let written = database.slice(file, at.span);
    importable(database, file, &written)
        .into_iter()
        .map(|(path, imported)| item(database, &path, text(&path), at.span, imported))
        .collect()
}

/// The paths with quotes, where none is begun.
pub(super) fn quoted_paths(place: &CursorContext<'_>) -> Vec<Completion> {
    importable(place.database, place.file, "")
        .into_iter()
        .map(|(path, imported)| {
            let quoted = format!("\"{path}\"");
            item(place.database, &quoted, quoted.clone(), place.word, imported)
        })
        .collect()
}

fn item(database: &Database, label: &str, insert: String, replace: Span, imported: FileId) -> Completion {
    Completion {
        detail: contents(database, imported),
        insert,
        imports: Some(imported),
        ..Completion::new(label, CompletionKind::File, replace)
    }
}

/// The files that an import could add, with their paths, the nearest first; also the one that `written` leads to.
fn importable(database: &Database, file: FileId, written: &str) -> Vec<(String, FileId)> {
    let mut found = not_imported(database, file);
    let path = |imported: FileId| Some((database.path_for_import(file, imported)?, imported));
    let present = database.imported_files(file).filter(|imported| *imported != file).filter_map(path);
    found.extend(present.filter(|(path, _)| path == written));
    found
}

/// The other files that this one does not import yet, with the paths that lead there, the nearest first.
pub(super) fn not_imported(database: &Database, file: FileId) -> Vec<(String, FileId)> {
    let imported: Vec<FileId> = database.imported_files(file).collect();
    let others = database.files().filter(|other| *other != file && !imported.contains(other));
    let path = |other: FileId| Some((database.path_for_import(file, other)?, other));
    let mut paths: Vec<(String, FileId)> = others.filter_map(path).collect();
    paths.sort_by_cached_key(|(path, _)| (path.matches('/').count(), path.clone()));
    paths
}

/// The import of a path as a new first line; `before` is where the first import starts, if there is one.
pub(super) fn import_line(database: &Database, file: FileId, path: &str) -> (Span, String) {
    let line_ending = database.line_ending(file);
    let statements = database.import_statements(file);
    match statements.first() {
        Some((first, _)) if first.span.start == 0 || is_first(database, file, first.span.start) => {
            (Span::at(first.span.start), format!("import \"{path}\"{line_ending}"))
        }
        _ => {
            let mark = u32::from(database.slice(file, Span::new(0, 3)) == "\u{feff}") * 3;
            (Span::at(mark), format!("import \"{path}\"{line_ending}{line_ending}"))
        }
    }
}

/// Whether nothing but comments stands before an offset.
fn is_first(database: &Database, file: FileId, offset: u32) -> bool {
    let comment = |token: &Token| token.0.is_comment();
    let mut before = database.entities(file).take_while(|entity| entity.span.start < offset);
    before.all(|entity| entity.parse.tokens.iter().all(comment))
}
