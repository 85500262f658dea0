//! Rename: renames an entity and all references to it, in all files; refused, with the reason, if the meaning of the
//! program would change.
//!
//! Several declarations of one name in one file are renamed together, because a reference could mean either. Comments
//! stay as they are.

use std::fmt;

use pydslrep_analysis::{Database, Edit, FileId, FileSpan};
use pydslrep_syntax::{EntityKind, Span, TokenKind, escape, lex};
use smol_str::SmolStr;

use crate::FilePosition;
use crate::cursor::{name_at, referent_at, token_at};
use crate::references::declarations;

/// The name to rename.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RenameTarget {
    /// The range of the name at the cursor, including `^`.
    pub span: Span,
    /// The name as written there.
    pub text: String,
}

/// Why a rename is refused; shown to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RenameError {
    /// The new name is not valid.
    Invalid(String),
    /// The name at the cursor cannot be renamed, or not to this name.
    Impossible(String),
}

impl fmt::Display for RenameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(reason) | Self::Impossible(reason) => f.write_str(reason),
        }
    }
}

/// The name that a rename at this position would change.
///
/// # Errors
///
/// If there is none, or it cannot be renamed at all.
pub fn prepare_rename(database: &Database, position: FilePosition) -> Result<RenameTarget, RenameError> {
    renamed_at(database, position)?;
    let span = name_at(database, position).ok_or_else(no_name)?.span;
    Ok(RenameTarget { span, text: database.slice(position.file, span) })
}

/// The edits that rename the entity at a position, by file and in text order.
///
/// # Errors
///
/// If there is no name, the new one is not valid, or the meaning of the program would change.
pub fn rename(database: &Database, position: FilePosition, new: &str) -> Result<Vec<Edit>, RenameError> {
    let renamed = renamed_at(database, position)?;
    let new = parse_name(new)?;
    if new != renamed.name {
        renamed.check_free(database, &new)?;
    }
    let text = escape(&new);
    let edit = |place: FileSpan| {
        // In `sensor^s` only the `^` separates the two words.
        let separator = if text.starts_with('^') || is_separated(database, place) { "" } else { "^" };
        Edit { file: place.file, span: place.span, text: format!("{separator}{text}") }
    };
    Ok(renamed.places.into_iter().map(edit).collect())
}

/// Returns whether a name at a location is separated from the text before it.
pub(crate) fn is_separated(database: &Database, place: FileSpan) -> bool {
    let before = Span::new(place.span.start.saturating_sub(1), place.span.start);
    let apart = |c: char| c.is_ascii_whitespace() || "{},:/\"".contains(c);
    place.span.start == 0 || database.slice(place.file, before).starts_with(apart)
}

/// Parses a name; the result has no `^`.
pub(crate) fn parse_name(text: &str) -> Result<SmolStr, RenameError> {
    match lex(text)[..] {
        [(token, span)] if span == Span::of(text) && token.is_name() && token != TokenKind::MalformedName => {
            Ok(text.strip_prefix('^').unwrap_or(text).into())
        }
        [(token, span)] if span == Span::of(text) && token.is_keyword() => {
            Err(RenameError::Invalid(format!("`{text}` is a keyword; write `^{text}` to use it as a name")))
        }
        _ => Err(RenameError::Invalid(format!(
            "`{text}` is not a valid name: use unaccented letters, digits and underscores; don't start with a digit"
        ))),
    }
}

/// A declared name and all its locations.
struct Renamed {
    kind: EntityKind,
    name: SmolStr,
    /// The declaring file.
    home: FileId,
    places: Vec<FileSpan>,
}

fn renamed_at(database: &Database, position: FilePosition) -> Result<Renamed, RenameError> {
    let referent = referent_at(database, position).ok_or_else(|| no_referent(database, position))?;
    let declared = declarations(database, &referent);
    let (kind, name, home) = (referent.kind, referent.name, referent.home);
    if declared.is_empty() {
        return Err(impossible(format!("no {} called `{name}` is declared", kind.noun())));
    }
    let candidates = database.candidates(position.file, kind, &name);
    if candidates.iter().any(|id| database.file_of(*id) != Some(home)) {
        return Err(impossible(format!(
            "two imported files declare {} called `{name}`; rename it in one of them",
            kind.a_noun()
        )));
    }
    let mut places = database.references(home, kind, &name);
    places.extend(declared);
    places.sort_unstable();
    let renamed = Renamed { kind, name, home, places };
    renamed.check_invalid_code(database)?;
    Ok(renamed)
}

impl Renamed {
    /// The declaring file and those that import it.
    fn files<'a>(&self, database: &'a Database) -> impl Iterator<Item = FileId> + 'a {
        std::iter::once(self.home).chain(database.importing(self.home))
    }

    /// Invalid code may contain references that would not be renamed.
    fn check_invalid_code(&self, database: &Database) -> Result<(), RenameError> {
        for file in self.files(database) {
            let is_own = file == self.home || database.definitions(file, self.kind, &self.name).is_empty();
            if is_own && database.may_hide(file, &self.name) {
                return Err(in_invalid_code(database, file, &self.name));
            }
        }
        Ok(())
    }

    /// Refuses a name that is already taken, or used, in any affected file.
    fn check_free(&self, database: &Database, new: &SmolStr) -> Result<(), RenameError> {
        for file in self.files(database) {
            let is_edited = file == self.home || self.places.iter().any(|place| place.file == file);
            let uses_new = !database.users(file, self.kind, new).is_empty();
            if !is_edited && (!uses_new || !database.definitions(file, self.kind, new).is_empty()) {
                continue;
            }
            if let Some(taken) = database.candidates(file, self.kind, new).first() {
                return Err(self.taken(database, file, database.file_of(*taken).unwrap_or(file), new));
            }
            if uses_new {
                return Err(impossible(format!(
                    "{} uses an undeclared {} called `{new}`, which would then refer to this one",
                    file_name(database, file),
                    self.kind.noun(),
                )));
            }
            if is_edited && database.may_hide(file, new) {
                return Err(in_invalid_code(database, file, new));
            }
        }
        Ok(())
    }

    fn taken(&self, database: &Database, file: FileId, declaring: FileId, new: &SmolStr) -> RenameError {
        let (file, declaring) = (file_name(database, file), file_name(database, declaring));
        let imported = if file == declaring { String::new() } else { format!(", which {file} imports") };
        impossible(format!("there is already {} called `{new}` in {declaring}{imported}", self.kind.a_noun()))
    }
}

fn no_referent(database: &Database, position: FilePosition) -> RenameError {
    match token_at(database, position) {
        Some((token, _)) if token.is_name() => {
            impossible("the code around this name is invalid; fix it first".to_owned())
        }
        _ => no_name(),
    }
}

fn no_name() -> RenameError {
    impossible("there is no name to rename here".to_owned())
}

fn in_invalid_code(database: &Database, file: FileId, name: &SmolStr) -> RenameError {
    impossible(format!("`{name}` appears in invalid code in {}; fix that first", file_name(database, file)))
}

fn impossible(reason: String) -> RenameError {
    RenameError::Impossible(reason)
}

/// The last part of a file's path.
fn file_name(database: &Database, file: FileId) -> String {
    database.path(file).rsplit('/').next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::at_cursor_in;

    /// Checks all files after a rename, or the reason for its refusal.
    fn check(files: &[(&str, &str)], new: &str, expected: &Expect) {
        let (mut database, position) = at_cursor_in(files);
        let shown = match rename(&database, position, new) {
            Err(RenameError::Invalid(reason)) => format!("invalid: {reason}"),
            Err(RenameError::Impossible(reason)) => reason,
            Ok(edits) => {
                for edit in edits.iter().rev() {
                    database.edit(edit.file, edit.span, &edit.text);
                }
                let text = |file| database.text(file).unwrap().to_string();
                database.files().map(text).collect::<Vec<_>>().join("\n---\n")
            }
        };
        expected.assert_eq(&shown);
    }

    #[test]
    fn all_references_are_renamed() {
        check(
            &[
                (
                    "parts.pyr",
                    "wheel a with radius 4 // a\nsensor a\nrobot p with port 1 has { a, a } wheels",
                ),
                (
                    "main.pyr",
                    "import \"parts.pyr\" robot r with port 1 has { $0a } wheels with sensors { a }",
                ),
                (
                    "own.pyr",
                    "import \"parts.pyr\" wheel a with radius 3 robot q with port 1 has { a } wheels",
                ),
            ],
            "b",
            &expect![[r#"
                wheel b with radius 4 // a
                sensor a
                robot p with port 1 has { b, b } wheels
                ---
                import "parts.pyr" robot r with port 1 has { b } wheels with sensors { a }
                ---
                import "parts.pyr" wheel a with radius 3 robot q with port 1 has { a } wheels"#]],
        );
    }

    #[test]
    fn keywords_come_and_go_with_their_escape() {
        let program = "robot ^robots with port 1\nmovement m of ^rob$0ots { turn left }";
        check(
            &[("a.pyr", program)],
            "rover",
            &expect![[r"
                robot rover with port 1
                movement m of rover { turn left }"]],
        );
        check(
            &[("a.pyr", program)],
            "^move",
            &expect![[r"
                robot ^move with port 1
                movement m of ^move { turn left }"]],
        );
        check(
            &[("a.pyr", program)],
            "^distance",
            &expect![[r"
                robot distance with port 1
                movement m of distance { turn left }"]],
        );
        check(
            &[("a.pyr", program)],
            "move",
            &expect!["invalid: `move` is a keyword; write `^move` to use it as a name"],
        );
    }

    #[test]
    fn an_escape_that_separates_stays() {
        check(
            &[("a.pyr", "sensor^s$0\nmovement m of r { turn left until{^s^t s, ö^s x-^s} }")],
            "front",
            &expect![[r"
                sensor^front
                movement m of r { turn left until{front^t front, ö^front x-^front} }"]],
        );
    }

    #[test]
    fn invalid_names_are_refused() {
        check(
            &[("a.pyr", "wheel a$0 with radius 4")],
            "two words",
            &expect![
                "invalid: `two words` is not a valid name: use unaccented letters, digits and underscores; don't start with a digit"
            ],
        );
        let (database, position) = at_cursor_in(&[("a.pyr", "wheel a$0 with radius 4")]);
        for text in [
            "",
            " a",
            "a ",
            "2a",
            "^",
            "^^a",
            "é",
            "a-b",
            "4",
            "a.b",
            "it's",
            "{",
            "\u{feff}a",
            "// a",
            "\"a\"",
            "a\n",
        ] {
            assert!(matches!(rename(&database, position, text), Err(RenameError::Invalid(_))), "{text:?}");
        }
    }

    #[test]
    fn a_name_that_is_taken_is_refused() {
        let same = "there is already a wheel called `b` in a.pyr";
        let check = |files: &[(&str, &str)], reason: Option<&str>| {
            let (database, position) = at_cursor_in(files);
            let refused = rename(&database, position, "b").err().map(|refusal| refusal.to_string());
            assert_eq!(refused.as_deref(), reason, "{files:?}");
        };
        check(&[("a.pyr", "wheel a$0 with radius 4 wheelH b with radius 4")], Some(same));
        check(&[("a.pyr", "wheel a$0 with radius 4 sensor b")], None);
        // It would shadow an import.
        check(
            &[("a.pyr", "wheel b with radius 4"), ("main.pyr", "import \"a.pyr\" wheel a$0 with radius 4")],
            Some("there is already a wheel called `b` in a.pyr, which main.pyr imports"),
        );
        // A file that uses it declares one of its own.
        let user = "import \"a.pyr\" wheel b with radius 3 robot r with port 1 has { a b } wheels";
        check(
            &[("a.pyr", "wheel a$0 with radius 4"), ("main.pyr", user)],
            Some("there is already a wheel called `b` in main.pyr"),
        );
        // A reference to another import would become ambiguous.
        let user = "import \"b.pyr\" import \"a.pyr\" robot r with port 1 has { b } wheels";
        check(
            &[("b.pyr", "wheel b with radius 4"), ("a.pyr", "wheel a$0 with radius 4"), ("main.pyr", user)],
            Some("there is already a wheel called `b` in b.pyr, which main.pyr imports"),
        );
        // Files that use neither, or declare their own, are not affected.
        let user = "import \"b.pyr\" import \"a.pyr\"";
        check(
            &[("b.pyr", "wheel b with radius 4"), ("a.pyr", "wheel a$0 with radius 4"), ("main.pyr", user)],
            None,
        );
        let user = "import \"a.pyr\" wheel b with radius 3 robot r with port 1 has { b } wheels";
        check(&[("a.pyr", "wheel a$0 with radius 4"), ("main.pyr", user)], None);
        // An unresolved reference would resolve to it.
        let user = "import \"a.pyr\" robot r with port 1 has { b } wheels";
        check(
            &[("a.pyr", "wheel a$0 with radius 4"), ("main.pyr", user)],
            Some("main.pyr uses an undeclared wheel called `b`, which would then refer to this one"),
        );
    }

    #[test]
    fn twins_are_renamed_together() {
        check(
            &[(
                "a.pyr",
                "wheel a with radius 4\nwheel $0a with radius 5\nrobot r with port 1 has { a } wheels",
            )],
            "b",
            &expect![[r"
                wheel b with radius 4
                wheel b with radius 5
                robot r with port 1 has { b } wheels"]],
        );
    }

    #[test]
    fn a_name_of_two_imports_is_renamed_at_its_declaration() {
        let user = "import \"a.pyr\" import \"b.pyr\" robot r with port 1 has { w } wheels";
        check(
            &[
                ("a.pyr", "wheel w with radius 4"),
                ("b.pyr", "wheel w with radius 4"),
                ("main.pyr", &user.replace("w }", "$0w }")),
            ],
            "v",
            &expect!["two imported files declare a wheel called `w`; rename it in one of them"],
        );
        check(
            &[("a.pyr", "wheel w with radius 4"), ("b.pyr", "wheel w$0 with radius 4"), ("main.pyr", user)],
            "v",
            &expect![[r#"
                wheel w with radius 4
                ---
                wheel v with radius 4
                ---
                import "a.pyr" import "b.pyr" robot r with port 1 has { w } wheels"#]],
        );
    }

    #[test]
    fn only_declared_names_in_valid_code_are_renamed() {
        let check = |text: &str, expected: &Expect| check(&[("a.pyr", text)], "b", expected);
        check("wheel a with rad$0ius 4", &expect!["there is no name to rename here"]);
        check("robot r with port 1 has { a$0 } wheels", &expect!["no wheel called `a` is declared"]);
        check("wheel a with radius 4 a$0", &expect!["the code around this name is invalid; fix it first"]);
        check(
            "wheel a$0 with radius 4 /* robot r has { a",
            &expect!["`a` appears in invalid code in a.pyr; fix that first"],
        );
        check("wheel a$0 with radius 4 b", &expect!["`b` appears in invalid code in a.pyr; fix that first"]);
        // Errors elsewhere do not matter.
        check(
            "wheel a$0 with raduis 4\nrobot r has { a c\nmovement { turn",
            &expect![[r"
                wheel b with raduis 4
                robot r has { b c
                movement { turn"]],
        );
    }

    #[test]
    fn the_name_to_rename_comes_with_its_escape() {
        let (database, position) = at_cursor_in(&[("a.pyr", "robot ^robots$0 with port 1")]);
        let target = prepare_rename(&database, position).unwrap();
        assert_eq!(target, RenameTarget { span: Span::new(6, 13), text: "^robots".to_owned() });
        let (database, position) = at_cursor_in(&[("a.pyr", "robot r $0with port 1")]);
        assert_eq!(prepare_rename(&database, position), Err(no_name()));
    }

    #[test]
    fn a_movement_is_renamed_where_it_is_done() {
        let files = [(
            "a.pyr",
            "robot r\nmovement side of r { slam }\nmovement all of r { do si$0de\n  repeat 2 times { do side wait 2 seconds } }",
        )];
        check(
            &files,
            "wait",
            &expect![[r#"
            robot r
            movement wait of r { slam }
            movement all of r { do wait
              repeat 2 times { do wait wait 2 seconds } }"#]],
        );
        check(&files, "turn", &expect!["invalid: `turn` is a keyword; write `^turn` to use it as a name"]);
        check(&files, "all", &expect!["there is already a movement called `all` in a.pyr"]);
    }
}
