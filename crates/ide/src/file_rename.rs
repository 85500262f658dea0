//! Renaming files: when a program or folder is renamed or moved, imports of it, and the imports of the moved programs
//! themselves, are updated to refer to the same programs as before.
//!
//! Imports that stay correct, and unresolved ones, are left as they are.

use pydslrep_analysis::{Database, Edit, FileId, path};

use crate::document_links::path_span;

/// The rename of a file, or of a folder and its contents.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileRename {
    /// The old path.
    pub from: String,
    /// The new path.
    pub to: String,
}

impl FileRename {
    /// The new path of a file; `None` if this rename does not affect it.
    fn apply(&self, path: &str) -> Option<String> {
        let rest = path.strip_prefix(&self.from)?;
        (rest.is_empty() || rest.starts_with('/')).then(|| format!("{}{rest}", self.to))
    }
}

/// The edits to make before the rename, by file and in text order. All renames happen at once, so two files may swap
/// names.
pub fn rename_files(database: &Database, renames: &[FileRename]) -> Vec<Edit> {
    database.files().flat_map(|file| edits_in(database, file, renames)).collect()
}

fn edits_in(database: &Database, file: FileId, renames: &[FileRename]) -> Vec<Edit> {
    if database.imports(file).is_empty() {
        return Vec::new();
    }
    let own = database.path(file);
    let own_after = renamed(own, renames);
    let edits = database.import_statements(file).into_iter().filter_map(|(entity, imported)| {
        let target = renamed(&imported, renames);
        if target.is_none() && (own_after.is_none() || database.file(&imported).is_none()) {
            return None;
        }
        let (importer, target) = (own_after.as_deref().unwrap_or(own), target.unwrap_or(imported));
        let span = path_span(database, &entity)?;
        let written = database.slice(file, span);
        if path::join(importer, &written) == target {
            return None;
        }
        let text = path::relative(importer, &target)?;
        Some(Edit { file, span, text })
    });
    edits.collect()
}

/// The new path according to the innermost rename that affects it.
fn renamed(path: &str, renames: &[FileRename]) -> Option<String> {
    let concerning = renames.iter().filter_map(|rename| Some((rename.from.len(), rename.apply(path)?)));
    concerning.max_by_key(|(length, _)| *length).map(|(_, to)| to)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;

    use super::*;
    use crate::fixture::applied;

    fn database(files: &[(&str, &str)]) -> Database {
        let mut database = Database::new();
        for (path, text) in files {
            database.open(path, text);
        }
        database
    }

    fn to(from: &str, to: &str) -> FileRename {
        FileRename { from: from.to_owned(), to: to.to_owned() }
    }

    /// The files that change, each under its new path.
    fn check(files: &[(&str, &str)], renames: &[FileRename], expected: &Expect) {
        let database = database(files);
        let edits = rename_files(&database, renames);
        let mut shown = String::new();
        for file in database.files().filter(|file| edits.iter().any(|edit| edit.file == *file)) {
            let path = database.path(file);
            let after = renamed(path, renames).unwrap_or_else(|| path.to_owned());
            shown += &format!("{after}: {}\n", applied(&database, file, &edits));
        }
        expected.assert_eq(&shown);
    }

    const FILES: &[(&str, &str)] = &[
        ("/w/lib/wheels.pyr", "wheel a with radius 4"),
        ("/w/lib/robots.pyr", "import \"wheels.pyr\" import \"gone.pyr\" /* é */"),
        ("/w/main.pyr", "import \"./lib/../lib/robots.pyr\" import \"lib/wheels.pyr"),
        ("/w/library.pyr", "// import \"lib/wheels.pyr\""),
    ];

    #[test]
    fn a_file_is_followed_by_its_importers() {
        check(
            FILES,
            &[to("/w/lib/wheels.pyr", "/w/lib/round.pyr")],
            &expect![[r#"
                /w/lib/robots.pyr: import "round.pyr" import "gone.pyr" /* é */
                /w/main.pyr: import "./lib/../lib/robots.pyr" import "lib/round.pyr
            "#]],
        );
    }

    #[test]
    fn a_file_that_moves_takes_its_imports_along() {
        check(
            FILES,
            &[to("/w/lib/robots.pyr", "/w/old/robots.pyr")],
            &expect![[r#"
                /w/old/robots.pyr: import "../lib/wheels.pyr" import "gone.pyr" /* é */
                /w/main.pyr: import "old/robots.pyr" import "lib/wheels.pyr
            "#]],
        );
    }

    #[test]
    fn a_folder_keeps_what_its_files_say_of_each_other() {
        check(
            FILES,
            &[to("/w/lib", "/w/parts")],
            &expect![[r#"
                /w/main.pyr: import "parts/robots.pyr" import "parts/wheels.pyr
            "#]],
        );
    }

    #[test]
    fn what_is_known_of_no_disk_is_followed_too() {
        check(
            &[("/w/main.pyr", "import \"ignored/a.pyr\" import \"other.pyr\"")],
            &[to("/w/ignored", "/w/b")],
            &expect![[r#"
                /w/main.pyr: import "b/a.pyr" import "other.pyr"
            "#]],
        );
    }

    #[test]
    fn files_may_change_places() {
        check(
            &[("/a.pyr", "import \"b.pyr\""), ("/b.pyr", "import \"c.pyr\""), ("/c.pyr", "")],
            &[to("/a.pyr", "/b.pyr"), to("/b.pyr", "/a.pyr")],
            &expect![[r#"
                /b.pyr: import "a.pyr"
            "#]],
        );
    }

    #[test]
    fn a_path_that_no_import_can_write_is_left() {
        check(FILES, &[to("/w/lib/wheels.pyr", "/w/lib/\"round\".pyr")], &expect![[""]]);
    }

    fn place() -> impl Strategy<Value = String> {
        prop::sample::select(vec!["/w", "/w/a", "/w/b", "/w/a/c", "/w/d/e"])
            .prop_flat_map(|folder| (0..4_u8).prop_map(move |name| format!("{folder}/{name}.pyr")))
    }

    proptest! {
        /// Every import refers to the same file after the rename, wherever both of them moved.
        #[test]
        fn imports_lead_to_the_same_files(
            places in prop::collection::btree_set(place(), 2..6),
            imports in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..8),
            moves in prop::collection::vec((any::<prop::sample::Index>(), "/w/(a/|f/)?[xyz]"), 1..3),
        ) {
            let places: Vec<String> = places.into_iter().collect();
            let mut texts = vec![String::new(); places.len()];
            for (importer, imported) in &imports {
                let (importer, imported) = (importer.index(places.len()), imported.index(places.len()));
                let written = path::relative(&places[importer], &places[imported]).unwrap();
                texts[importer] += &format!("import \"{written}\"\n");
            }
            // Files, and folders with their contents.
            let renames: Vec<FileRename> = moves.iter().enumerate().map(|(number, (which, new))| {
                let from = which.get(&places);
                let folder = from.rsplit_once('/').unwrap().0;
                if number == 1 && folder != "/w" { to(folder, new) } else { to(from, &format!("{new}.pyr")) }
            }).collect();
            let database = database(&places.iter().zip(&texts).map(|(a, b)| (&**a, &**b)).collect::<Vec<_>>());
            let edits = rename_files(&database, &renames);
            let after = |path: &str| renamed(path, &renames).unwrap_or_else(|| path.to_owned());
            for file in database.files() {
                let mut alone = Database::new();
                let moved = alone.open(&after(database.path(file)), &applied(&database, file, &edits));
                let expected: Vec<String> = database.imports(file).iter().map(|path| after(path)).collect();
                prop_assert_eq!(alone.imports(moved), expected);
            }
        }
    }
}
