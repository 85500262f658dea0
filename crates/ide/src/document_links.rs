//! Document links: the path of an import opens the file; the tooltip lists what it declares.

use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span};

use crate::symbols::counted;

/// A link from a path to its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DocumentLink {
    /// The path, without its quotes.
    pub span: Span,
    /// The target.
    pub file: FileId,
    /// A summary of its declarations.
    pub tooltip: String,
}

/// The resolved imports of a file in text order.
pub fn document_links(database: &Database, file: FileId) -> Vec<DocumentLink> {
    let links = database.import_statements(file).into_iter().filter_map(|(entity, path)| {
        let imported = database.imported_files(file).find(|other| database.path(*other) == path)?;
        Some(DocumentLink {
            span: path_span(database, &entity)?,
            file: imported,
            tooltip: tooltip(database, imported),
        })
    });
    links.collect()
}

/// The range of an import's path, without its quotes; the closing one may be missing.
pub(crate) fn path_span(database: &Database, entity: &EntityRef<'_>) -> Option<Span> {
    let Some(Entity::Import(import)) = &entity.parse.entity else { return None };
    let quoted = import.path_span?.shifted(entity.span.start);
    let text = database.slice(entity.file, quoted);
    let opening = u32::from(text.starts_with('"'));
    let closing = u32::from(text.len() > 1 && text.ends_with('"'));
    Some(Span::new(quoted.start + opening, quoted.end - closing))
}

fn tooltip(database: &Database, file: FileId) -> String {
    let name = database.path(file).rsplit('/').next().unwrap_or_default();
    format!("Open {name}: {}", summary(database, file))
}

/// The number of declarations of each kind, such as `2 wheels, 1 sensor`.
pub(crate) fn summary(database: &Database, file: FileId) -> String {
    let counts: Vec<String> = EntityKind::ALL
        .iter()
        .map(|kind| (database.count(file, *kind), kind.noun()))
        .filter(|(count, _)| *count > 0)
        .map(|(count, noun)| counted(count as usize, noun))
        .collect();
    if counts.is_empty() { "declares nothing".to_owned() } else { counts.join(", ") }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_analysis::Absence;

    use super::*;

    fn shown(database: &Database, file: FileId) -> String {
        let line = |link: DocumentLink| {
            let place = database.slice(file, link.span);
            format!("{} {place:?} -> {}: {}\n", link.span.start, database.path(link.file), link.tooltip)
        };
        document_links(database, file).into_iter().map(line).collect()
    }

    fn check(text: &str, expected: &Expect) {
        let mut database = Database::new();
        database.open("d/parts.pyr", "wheel a with radius 4 wheelH b sensor s : bumper robot r has");
        database.open("empty.pyr", "// é\n");
        let file = database.open("d/main.pyr", text);
        expected.assert_eq(&shown(&database, file));
    }

    #[test]
    fn imports_lead_to_their_files() {
        check(
            "/* é */ import \"parts.pyr\"\nimport \"gone.pyr\"\nwheel a\nimport import \"../empty.pyr\"\nimport \"parts.pyr",
            &expect![[r#"
                17 "parts.pyr" -> d/parts.pyr: Open parts.pyr: 2 wheels, 1 sensor, 1 robot
                69 "../empty.pyr" -> empty.pyr: Open empty.pyr: declares nothing
                91 "parts.pyr" -> d/parts.pyr: Open parts.pyr: 2 wheels, 1 sensor, 1 robot
            "#]],
        );
        check("wheel a with radius 4\n// import \"parts.pyr\"\nimport \"\"", &expect![[""]]);
    }

    #[test]
    fn what_may_not_be_imported_is_no_link() {
        let mut database = Database::new();
        database.open("a.pyr", "sensor s");
        let file = database.open("b.pyr", "import \"a.pyr\"");
        assert_eq!(document_links(&database, file).len(), 1);
        database.set_absence(file, "a.pyr", Some(Absence::Outside));
        assert_eq!(document_links(&database, file), []);
    }
}
