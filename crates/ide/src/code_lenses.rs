//! Code lenses: above an environment what can be done with it, above a declaration how often it is used.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

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

/// The lenses of a file in the order of the text: one for each declaration. Environments, which nothing refers to, can be
/// run; of all others the uses can be counted by [`Database::references`], which is worth doing only for what is seen.
pub fn code_lenses(database: &Database, file: FileId) -> Vec<CodeLens> {
    database
        .entities(file)
        .filter_map(|entity| {
            let tree = entity.parse.entity.as_ref()?;
            let name = tree.name()?;
            let span = name.span.shifted(entity.span.start);
            Some(CodeLens { span, kind: tree.kind()?, name: name.text.clone() })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_declaration_has_one() {
        let mut database = Database::new();
        let text = "import \"b.pyr\"\nwheel ^robots with radius 3\nsensor\nmovement m of\nenvironment e";
        let file = database.open("a.pyr", text);
        let found: Vec<_> = code_lenses(&database, file)
            .into_iter()
            .map(|lens| format!("{} {} {:?}", lens.kind.noun(), lens.name, lens.span.text(text)))
            .collect();
        assert_eq!(found, ["wheel robots \"^robots\"", "movement m \"m\"", "environment e \"e\""]);
    }
}
