//! Document highlight: the references (read) and declarations (write) of the name at the cursor, within the file.

use pydslrep_analysis::Database;
use pydslrep_syntax::Span;

use crate::FilePosition;
use crate::cursor::referent_at;

/// A highlighted range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Highlight {
    /// Its range in the file.
    pub span: Span,
    /// True for a declaration, false for a reference.
    pub is_declaration: bool,
}

/// The occurrences of the name at a position, within the same file, in text order.
pub fn highlights(database: &Database, position: FilePosition) -> Vec<Highlight> {
    let Some(referent) = referent_at(database, position) else { return Vec::new() };
    // All references in one file resolve alike, even if to nothing.
    let uses = database.uses(position.file, referent.kind, &referent.name);
    let declared = database.declarations(position.file, referent.kind, &referent.name);
    let uses = uses.into_iter().map(|span| Highlight { span, is_declaration: false });
    let declared = declared.into_iter().map(|span| Highlight { span, is_declaration: true });
    let mut highlights: Vec<Highlight> = uses.chain(declared).collect();
    highlights.sort_unstable();
    highlights
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{at_cursor_in, marked};

    fn check(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let spans: Vec<(Span, &str)> = highlights(&database, position)
            .into_iter()
            .map(|highlight| (highlight.span, if highlight.is_declaration { "write" } else { "read" }))
            .collect();
        expected.assert_eq(&marked(&database, position.file, &spans));
    }

    #[test]
    fn uses_are_reads_and_declarations_writes() {
        check(
            &[(
                "a.pyr",
                "robot rover with port 1 has { ^left } wheels\nwheel ^lef$0t with radius 4\nsensor ^left\nrobot s has { a ^left",
            )],
            &expect![[r"
                robot rover with port 1 has { read[^left] } wheels
                wheel write[^left] with radius 4
                sensor ^left
                robot s has { a read[^left]"]],
        );
        check(
            &[(
                "a.pyr",
                "movement m of r { }\nmovement m of r { }\nenvironment e has { r } robots with { m m$0 } moves",
            )],
            &expect![[r"
                movement write[m] of r { }
                movement write[m] of r { }
                environment e has { r } robots with { read[m] read[m] } moves"]],
        );
    }

    #[test]
    fn other_files_are_not_highlighted() {
        check(
            &[
                ("parts.pyr", "wheel a with radius 4"),
                ("main.pyr", "import \"parts.pyr\" robot r with port 1 has { $0a b a } wheels"),
            ],
            &expect![[r#"import "parts.pyr" robot r with port 1 has { read[a] b read[a] } wheels"#]],
        );
        check(
            &[
                ("main.pyr", "import \"parts.pyr\" robot r with port 1 has { a } wheels"),
                ("parts.pyr", "wheel a$0 with radius 4"),
            ],
            &expect!["wheel write[a] with radius 4"],
        );
        check(&[("a.pyr", "whe$0el a with radius 4")], &expect!["wheel a with radius 4"]);
    }

    #[test]
    fn movements_that_are_done_and_sensors_of_conditions() {
        check(
            &[(
                "a.pyr",
                "movement wait of r { repeat 2 times { do wa$0it wait 2 seconds do\nwait } }\nmovement n of r { do wait }",
            )],
            &expect![[r#"
                movement write[wait] of r { repeat 2 times { do read[wait] wait 2 seconds do
                read[wait] } }
                movement n of r { do read[wait] }"#]],
        );
        check(
            &[(
                "a.pyr",
                "sensor clear\nmovement m of r { if { clear } clear { wait until { cle$0ar } clear } else if { clear } detect { } }",
            )],
            &expect![[r#"
                sensor write[clear]
                movement m of r { if { read[clear] } clear { wait until { read[clear] } clear } else if { read[clear] } detect { } }"#]],
        );
    }
}
