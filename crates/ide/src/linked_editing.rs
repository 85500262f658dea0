//! Linked editing: while a name is typed over, its declaration and uses change with it, where no other file is
//! concerned.

use pydslrep_analysis::{Database, FileSpan};
use pydslrep_syntax::Span;

use crate::FilePosition;
use crate::cursor::referent_at;
use crate::references::declarations;

/// The places in the same file that are edited together with the name at a place, in the order of the text; none where
/// that is not safe: the name must be declared once, here, used here only, and be written alike everywhere.
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
    fn other_files_are_not_left_behind() {
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
    fn what_is_in_doubt_is_not_linked() {
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
