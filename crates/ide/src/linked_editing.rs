//! Linked editing: while a name is edited, its declaration and references change with it, unless other files use it.

use pydslrep_analysis::{Database, FileSpan};
use pydslrep_syntax::Span;

use crate::FilePosition;
use crate::cursor::referent_at;
use crate::references::declarations;

/// The ranges that are edited together with the name at a position, in text order. Empty unless it is safe: the name must
/// be declared once, in this file, used in no other, and be spelled the same everywhere.
pub fn linked_editing_ranges(database: &Database, position: FilePosition) -> Vec<Span> {
    linked(database, position).unwrap_or_default()
}

fn linked(database: &Database, position: FilePosition) -> Option<Vec<Span>> {
    let referent = referent_at(database, position)?;
    let declared = declarations(database, &referent);
    let uses = database.references(referent.home, referent.kind, &referent.name);
    let here = |place: &FileSpan| place.file == position.file;
    if declared.len() != 1
        || uses.is_empty()
        || !declared.iter().chain(&uses).all(here)
        || database.may_hide(position.file, &referent.name)
    {
        return None;
    }
    let mut spans: Vec<Span> = declared.into_iter().chain(uses).map(|place| place.span).collect();
    spans.sort_unstable();
    let texts: Vec<String> = spans.iter().map(|span| database.slice(position.file, *span)).collect();
    texts.windows(2).all(|pair| pair[0] == pair[1]).then_some(spans)
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{at_cursor_in, marked};

    fn check(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let spans: Vec<_> =
            linked_editing_ranges(&database, position).into_iter().map(|span| (span, "")).collect();
        expected.assert_eq(&marked(&database, position.file, &spans));
    }

    fn check_none(files: &[(&str, &str)]) {
        let (database, position) = at_cursor_in(files);
        assert_eq!(linked_editing_ranges(&database, position), []);
    }

    #[test]
    fn a_name_and_its_uses_are_linked() {
        check(
            &[
                (
                    "a.pyr",
                    "wheel ^left with radius 4\nrobot r with port 1 has { ^left$0 } wheels\nsensor ^left",
                ),
                (
                    "b.pyr",
                    "import \"a.pyr\" wheel ^left with radius 3 robot q with port 1 has { ^left } wheels",
                ),
            ],
            &expect![[r"
                wheel [^left] with radius 4
                robot r with port 1 has { [^left] } wheels
                sensor ^left"]],
        );
        check(
            &[("a.pyr", "import \"gone.pyr\" robot r$0 with port\nmovement m of r {")],
            &expect![[r#"
                import "gone.pyr" robot [r] with port
                movement m of [r] {"#]],
        );
    }

    #[test]
    fn a_movement_is_linked_where_it_is_done() {
        check(
            &[(
                "a.pyr",
                "movement side of r { slam }\nmovement all of r { repeat 2 times { do si$0de } do side }",
            )],
            &expect![[r"
                movement [side] of r { slam }
                movement all of r { repeat 2 times { do [side] } do [side] }"]],
        );
    }

    #[test]
    fn names_used_in_other_files_are_not_linked() {
        check_none(&[
            ("a.pyr", "wheel a$0 with radius 4\nrobot r with port 1 has { a } wheels"),
            ("b.pyr", "import \"a.pyr\" robot q with port 1 has { a } wheels"),
        ]);
        check_none(&[
            ("a.pyr", "wheel a with radius 4"),
            ("b.pyr", "import \"a.pyr\" robot q with port 1 has { a$0 a } wheels"),
        ]);
    }

    #[test]
    fn ambiguous_names_are_not_linked() {
        for text in [
            "wheel a with radius 4\nwheel a with radius 4\nrobot r with port 1 has { a$0 } wheels",
            "wheel a with radius 4\nrobot r with port 1 has { ^a$0 } wheels",
            "wheel a with radius 4\nrobot r with port 1 has { a$0 } wheels a",
            "wheel a with radius 4\nrobot r with port 1 has { a$0 } wheels /* a",
            "robot r with port 1 has { a$0 a } wheels",
            "wheel $0a with radius 4",
            "wheel a with rad$0ius 4",
        ] {
            check_none(&[("a.pyr", text)]);
        }
    }
}
