//! Code lenses: commands above each environment, and the number of references above every other declaration.
//!
//! A lens takes up a line and so moves the text below it. It appears only when its declaration is complete and not
//! being typed; once shown, it stays while the declaration is edited. A name that is being typed has none.

use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::{EntityKind, Span};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::cursor::body;
use crate::inlay_hints::lines;

/// A lens above a declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeLens {
    /// The range of the declared name.
    pub span: Span,
    /// The kind of the declaration.
    pub kind: EntityKind,
    /// Its name.
    pub name: SmolStr,
}

/// The declarations of one file that had a lens at the last request. Keep it with the open document and pass it to each
/// request, so that lenses stay while the text is edited.
#[derive(Debug, Default)]
pub struct ShownLenses(FxHashSet<(EntityKind, SmolStr)>);

/// The lenses of a file in text order, at most one per declaration; `typed` holds the offsets being edited. References
/// are not counted here: [`Database::references`] does it for the lenses that are visible.
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
            (!is_typed && (was_shown() || is_complete(database, &entity, typed))).then_some(lens)
        })
        .collect();
    shown.0 = lenses.iter().map(|lens| (lens.kind, lens.name.clone())).collect();
    lenses
}

/// Returns whether a declaration has no errors and none of its lines is being edited.
fn is_complete(database: &Database, entity: &EntityRef<'_>, typed: &[u32]) -> bool {
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

    /// The declarations with a lens after each key, whenever that changes.
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
