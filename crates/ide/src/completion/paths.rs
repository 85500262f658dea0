//! Import paths: the programs of the workspace, relative to the importing file.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::{Span, Token, TokenKind};

use super::context::CompletionContext;
use super::{Completion, CompletionKind};
use crate::FilePosition;
use crate::document_links::summary;

/// The path being typed.
pub(super) struct PathAt {
    /// The text between the quotes.
    span: Span,
    /// True if the closing quote is missing.
    is_open: bool,
}

/// The string after `import`, if the cursor is between its quotes.
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

/// The paths with quotes, for an import without a string.
pub(super) fn quoted_paths(context: &CompletionContext<'_>) -> Vec<Completion> {
    importable(context.database, context.file, "")
        .into_iter()
        .map(|(path, imported)| {
            let quoted = format!("\"{path}\"");
            item(context.database, &quoted, quoted.clone(), context.word, imported)
        })
        .collect()
}

fn item(database: &Database, label: &str, insert: String, replace: Span, imported: FileId) -> Completion {
    Completion {
        detail: summary(database, imported),
        insert,
        imports: Some(imported),
        ..Completion::new(label, CompletionKind::File, replace)
    }
}

/// The files that can be imported, with their paths, the nearest first; and the one that `written` refers to.
fn importable(database: &Database, file: FileId, written: &str) -> Vec<(String, FileId)> {
    let mut found = not_imported(database, file);
    let path = |imported: FileId| Some((database.path_for_import(file, imported)?, imported));
    let present = database.imported_files(file).filter(|imported| *imported != file).filter_map(path);
    found.extend(present.filter(|(path, _)| path == written));
    found
}

/// The other files that this one does not import yet, with their relative paths, the nearest first.
pub(super) fn not_imported(database: &Database, file: FileId) -> Vec<(String, FileId)> {
    let imported: Vec<FileId> = database.imported_files(file).collect();
    let others = database.files().filter(|other| *other != file && !imported.contains(other));
    let path = |other: FileId| Some((database.path_for_import(file, other)?, other));
    let mut paths: Vec<(String, FileId)> = others.filter_map(path).collect();
    paths.sort_by_cached_key(|(path, _)| (path.matches('/').count(), path.clone()));
    paths
}

/// The edit that imports a path: before the first import, or at the top of the file.
pub(super) fn import_line(database: &Database, file: FileId, path: &str) -> (Span, String) {
    let line_ending = database.line_ending(file);
    let statements = database.import_statements(file);
    match statements.first() {
        Some((first, _)) if first.span.start == 0 || is_first(database, file, first.span.start) => {
            (Span::at(first.span.start), format!("import \"{path}\"{line_ending}"))
        }
        _ => {
            let start = u32::from(database.slice(file, Span::new(0, 3)) == "\u{feff}") * 3;
            (Span::at(start), format!("import \"{path}\"{line_ending}{line_ending}"))
        }
    }
}

/// Returns whether only comments precede an offset.
fn is_first(database: &Database, file: FileId, offset: u32) -> bool {
    let comment = |token: &Token| token.0.is_comment();
    let mut before = database.entities(file).take_while(|entity| entity.span.start < offset);
    before.all(|entity| entity.parse.tokens.iter().all(comment))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::completion::testing::check_in;

    #[test]
    fn imports_offer_existing_files() {
        let files =
            |last| [("lib/wheels.pyr", "wheel big with radius 9"), ("b.pyr", ""), ("lib/a.pyr", last)];
        check_in(
            &files("import \"$0\""),
            &expect![[r#"
            wheels.pyr [1 wheel] "" -> "wheels.pyr"
            ../b.pyr [declares nothing] "" -> "../b.pyr"
        "#]],
        );
        check_in(
            &files("import \"whe$0\nsensor s"),
            &expect![[r#"
                wheels.pyr [1 wheel] "whe" -> "wheels.pyr\""
            "#]],
        );
        check_in(
            &files("import \"wheels.pyr\" import $0"),
            &expect![[r#"
            "../b.pyr" [declares nothing] "" -> "\"../b.pyr\""
        "#]],
        );
    }
}
