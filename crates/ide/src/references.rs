//! Find references: all references to a name, in its file and in those that import it, with or without its declaration.
//!
//! For an undeclared name, the references in the same file.

use pydslrep_analysis::{Database, EntityId, FileSpan};

use crate::FilePosition;
use crate::cursor::{Referent, referent_at};

/// The references to the name at a position, by file and in text order; `None` if there is no name.
pub fn references(
    database: &Database,
    position: FilePosition,
    include_declaration: bool,
) -> Option<Vec<FileSpan>> {
    let referent = referent_at(database, position)?;
    let mut places = database.references(referent.home, referent.kind, &referent.name);
    if include_declaration {
        places.extend(declarations(database, &referent));
    }
    places.sort_unstable();
    Some(places)
}

/// Returns the number of entities that declare or use the name at a position, including uses of the same name in files
/// that import its file; found without reading them.
pub fn count_mentions(database: &Database, position: FilePosition) -> usize {
    let Some(Referent { home, kind, name, .. }) = referent_at(database, position) else { return 0 };
    let users = |file| database.users(file, kind, &name).len();
    let importing = database.importing(home).into_iter();
    database.definitions(home, kind, &name).len() + users(home) + importing.map(users).sum::<usize>()
}

/// The declarations of a referent.
pub(crate) fn declarations(database: &Database, referent: &Referent) -> Vec<FileSpan> {
    let Referent { home, kind, name, .. } = referent;
    let spans = database.declarations(*home, *kind, name).into_iter();
    spans.map(|span| FileSpan { file: *home, span }).collect()
}

/// The position of the name that an entity declares.
pub fn declaration(database: &Database, id: EntityId) -> Option<FilePosition> {
    let (file, tree) = (database.file_of(id)?, database.tree(id)?);
    let referent = Referent { kind: tree.kind()?, name: tree.name()?.text.clone(), home: file };
    let FileSpan { file, span } = declarations(database, &referent).into_iter().next()?;
    Some(FilePosition { file, offset: span.start })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{at_cursor_in, marked};

    /// Checks the texts of all files with references in brackets and declarations marked `=`; and that every reference gives
    /// the same result.
    fn check(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let Some(all) = references(&database, position, true) else {
            return expected.assert_eq("nothing");
        };
        let uses = references(&database, position, false).unwrap();
        for place in &all {
            let again = FilePosition { file: place.file, offset: place.span.end };
            assert_eq!(references(&database, again, true).as_ref(), Some(&all));
            assert_eq!(references(&database, again, false).as_ref(), Some(&uses));
        }
        let shown = |file| {
            let here = all.iter().filter(|place| place.file == file);
            let spans: Vec<_> =
                here.map(|place| (place.span, if uses.contains(place) { "" } else { "=" })).collect();
            (!spans.is_empty())
                .then(|| format!("{}: {}", database.path(file), marked(&database, file, &spans)))
        };
        expected.assert_eq(&database.files().filter_map(shown).collect::<Vec<_>>().join("\n"));
    }

    #[test]
    fn references_have_the_same_kind() {
        check(
            &[(
                "a.pyr",
                "robot r with port 1 has { a$0, b a } wheels with sensors { a }\nwheel a with radius 4\nsensor a",
            )],
            &expect![[r"
                a.pyr: robot r with port 1 has { [a], b [a] } wheels with sensors { a }
                wheel =[a] with radius 4
                sensor a"]],
        );
        check(
            &[(
                "a.pyr",
                "sensor ^robots$0\nsensor s\nmovement m of r { turn left until { ^robots ^s } turn right until { s ^robots } }",
            )],
            &expect![[r"
                a.pyr: sensor =[^robots]
                sensor s
                movement m of r { turn left until { [^robots] ^s } turn right until { s [^robots] } }"]],
        );
    }

    #[test]
    fn importing_files_use_it_too_unless_they_have_their_own() {
        let files = [
            ("main.pyr", "import \"parts.pyr\"\nrobot r with port 1 has { w } wheels"),
            ("own.pyr", "import \"parts.pyr\"\nwheel w with radius 3\nrobot r with port 1 has { w } wheels"),
            ("parts.pyr", "wheel $0w with radius 4\nrobot p with port 1 has { w } wheels"),
            ("stranger.pyr", "robot r with port 1 has { w } wheels"),
            ("twice.pyr", "import \"own.pyr\" import \"parts.pyr\"\nrobot r with port 1 has { w } wheels"),
        ];
        check(
            &files,
            &expect![[r#"
                main.pyr: import "parts.pyr"
                robot r with port 1 has { [w] } wheels
                parts.pyr: wheel =[w] with radius 4
                robot p with port 1 has { [w] } wheels"#]],
        );
        let own = files.map(|(path, text)| {
            (path, if path == "own.pyr" { text.replace("{ w", "{ w$0") } else { text.replace("$0", "") })
        });
        let own: Vec<(&str, &str)> = own.iter().map(|(path, text)| (*path, text.as_str())).collect();
        check(
            &own,
            &expect![[r#"
                own.pyr: import "parts.pyr"
                wheel =[w] with radius 3
                robot r with port 1 has { [w] } wheels
                twice.pyr: import "own.pyr" import "parts.pyr"
                robot r with port 1 has { [w] } wheels"#]],
        );
    }

    #[test]
    fn twins_count_as_one() {
        check(
            &[(
                "a.pyr",
                "wheel a with radius 4\nwheelH $0a with radius 5\nrobot r with port 1 has { a } wheels",
            )],
            &expect![[r"
                a.pyr: wheel =[a] with radius 4
                wheelH =[a] with radius 5
                robot r with port 1 has { [a] } wheels"]],
        );
    }

    #[test]
    fn references_in_entities_with_errors_are_included() {
        check(
            &[(
                "a.pyr",
                "wheel a with raduis\nrobot r has { a$0 § wheels\nrobot q port 3 has { b a\nmovement a of { }",
            )],
            &expect![[r"
                a.pyr: wheel =[a] with raduis
                robot r has { [a] § wheels
                robot q port 3 has { b [a]
                movement a of { }"]],
        );
        check(
            &[(
                "a.pyr",
                "robot r with port 1 has { nobody$0 } wheels\nrobot s with port 1 has { nobody } wheels",
            )],
            &expect![[r"
                a.pyr: robot r with port 1 has { [nobody] } wheels
                robot s with port 1 has { [nobody] } wheels"]],
        );
        check(&[("a.pyr", "wheel a with ra$0dius 4")], &expect!["nothing"]);
    }

    #[test]
    fn a_movement_is_referred_to_by_do() {
        check(
            &[
                (
                    "parts.pyr",
                    "robot r\nmovement side of r { slam }\nmovement n of r { repeat 2 times { do side } }",
                ),
                (
                    "main.pyr",
                    "import \"parts.pyr\"\nmovement all of r { do si$0de if { side } clear { do side } else { do ^side } }",
                ),
            ],
            &expect![[r#"
                parts.pyr: robot r
                movement =[side] of r { slam }
                movement n of r { repeat 2 times { do [side] } }
                main.pyr: import "parts.pyr"
                movement all of r { do [side] if { side } clear { do [side] } else { do [^side] } }"#]],
        );
    }
}
