//! Code lenses: above an environment what can be done with it, above a declaration how often it is used.
//!
//! A lens is a line of its own, which moves all that is below it. So there is none for a name that is being typed, and
//! none yet for a declaration that is new or not complete; one that is there stays while its declaration is edited.

use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::{EntityKind, Span};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::cursor::body;
use crate::inlay_hints::lines;

/// A line above a declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeLens {
    /// The declared name's place.
    pub span: Span,
    /// What is declared.
    pub kind: EntityKind,
    /// Its name.
    pub name: SmolStr,
}

/// The declarations of one file that had a lens when lenses were last asked for. Whoever keeps it beside a text that is
/// edited and hands it over again gets lenses that stay.
#[derive(Debug, Default)]
pub struct ShownLenses(FxHashSet<(EntityKind, SmolStr)>);

/// The lenses of a file in the order of the text, at most one for each declaration; `typed` is where somebody is typing.
/// Environments, which nothing refers to, can be run; of all others the uses can be counted by [`Database::references`],
/// which is worth doing only for what is seen.
pub fn code_lenses(
    database: &Database,
    file: FileId,
    typed: &[u32],
    shown: &mut ShownLenses,
) -> Vec<CodeLens> {
    let lenses: Vec<CodeLens> = database
        .entities(file)
        .filter_map(|entity| {
            let tree = entity.parse.entity.as_ref()?;
            let name = tree.name()?;
            let span = name.span.shifted(entity.span.start);
            let lens = CodeLens { span, kind: tree.kind()?, name: name.text.clone() };
            let is_typed = typed.iter().any(|place| span.touches(*place));
            let was_shown = || shown.0.contains(&(lens.kind, lens.name.clone()));
            (!is_typed && (was_shown() || is_done(database, &entity, typed))).then_some(lens)
        })
        .collect();
    shown.0 = lenses.iter().map(|lens| (lens.kind, lens.name.clone())).collect();
    lenses
}

/// Whether a declaration is complete and nobody is typing in its lines.
fn is_done(database: &Database, entity: &EntityRef<'_>, typed: &[u32]) -> bool {
    let lines = || lines(database, entity.file, body(entity));
    entity.parse.errors.is_empty() && (typed.is_empty() || !typed.iter().any(|place| lines().touches(*place)))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;

    fn shown(database: &Database, file: FileId, typed: &[u32], before: &mut ShownLenses) -> Vec<String> {
        let text = database.text(file).unwrap().to_string();
        let lenses = code_lenses(database, file, typed, before).into_iter();
        lenses.map(|lens| format!("{} {} {:?}", lens.kind.noun(), lens.name, lens.span.text(&text))).collect()
    }

    #[test]
    fn every_declaration_that_is_complete_has_one() {
        let mut database = Database::new();
        let text = "import \"b.pyr\"\nwheel ^robots with radius 3\nsensor\nmovement m of\nenvironment e has { r } robots";
        let file = database.open("a.pyr", text);
        let found = shown(&database, file, &[], &mut ShownLenses::default());
        assert_eq!(found, ["wheel robots \"^robots\"", "environment e \"e\""]);
    }

    /// What has a lens after each key, where that changes.
    fn typing(text: &str, place: &str, typed: &str) -> String {
        let mut database = Database::new();
        let file = database.open("a.pyr", text);
        let mut before = ShownLenses::default();
        shown(&database, file, &[], &mut before);
        let mut at = u32::try_from(text.find(place).unwrap() + place.len()).unwrap();
        let mut seen = String::new();
        let mut last = String::new();
        for (index, key) in typed.char_indices() {
            database.edit(file, Span::at(at), &key.to_string());
            at += 1;
            let names = code_lenses(&database, file, &[at], &mut before).into_iter().map(|lens| lens.name);
            let names = names.collect::<Vec<_>>().join(" ");
            if index == 0 || names != last {
                seen += &format!("{:?}: {names}\n", &typed[..=index]);
                last = names;
            }
        }
        seen
    }

    const PROGRAM: &str = "robot rover with port 1 has { a b } wheels\n\nmovement m of rover {\n  slam\n}\n";

    #[test]
    fn a_declaration_being_typed_has_none() {
        let declaration = "environment yard has { rover } robots with { m } moves\nwheel";
        expect![[r#"
            "e": rover m
            "environment yard has { rover } robots with { m } moves\n": rover m yard
        "#]]
        .assert_eq(&typing(PROGRAM, "}\n", declaration));
    }

    #[test]
    fn a_name_being_typed_has_none_and_one_that_is_there_stays() {
        expect![[r#"
            "_": m
        "#]]
        .assert_eq(&typing(PROGRAM, "robot rover", "_2 "));
        expect![[r#"
            " ": rover m
            " . /*": rover
            " . /* no port */": rover m
        "#]]
        .assert_eq(&typing(PROGRAM, "with port 1", " . /* no port */"));
        expect![[r#"
            "\n": rover m
        "#]]
        .assert_eq(&typing(PROGRAM, "  slam", "\n  move 1 "));
    }
}
