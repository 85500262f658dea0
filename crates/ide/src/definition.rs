//! Go to definition: from a name to its declarations, from an import to its file.

use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Entity;

use crate::FilePosition;
use crate::cursor::{body, entities_at, name_at};

/// The targets of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Definition {
    /// The name (or path) at the cursor.
    pub origin: Span,
    /// The declarations; several if the name is declared twice, in this file or in two imported ones.
    pub targets: Vec<Target>,
}

/// A declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// The file that contains it.
    pub file: FileId,
    /// The range of the declaration.
    pub full: Span,
    /// The range of its name.
    pub focus: Span,
}

/// The declarations of the name at a position.
pub fn goto_definition(database: &Database, position: FilePosition) -> Option<Definition> {
    import_at(database, position).or_else(|| declarations(database, position))
}

fn declarations(database: &Database, position: FilePosition) -> Option<Definition> {
    let at = name_at(database, position)?;
    let all = database.candidates(position.file, at.kind, &at.name.text);
    let targets: Vec<Target> = all.iter().filter_map(|id| target(&database.entity(*id)?)).collect();
    (!targets.is_empty()).then_some(Definition { origin: at.span, targets })
}

/// A named entity as a target.
pub(crate) fn target(entity: &EntityRef<'_>) -> Option<Target> {
    let name = entity.parse.entity.as_ref()?.name()?;
    Some(Target { file: entity.file, full: body(entity), focus: name.span.shifted(entity.span.start) })
}

fn import_at(database: &Database, position: FilePosition) -> Option<Definition> {
    let entity = entities_at(database, position).into_iter().find(|entity| {
        matches!(&entity.parse.entity, Some(Entity::Import(import))
            if import.path_span.is_some_and(|span| span.shifted(entity.span.start).touches(position.offset)))
    })?;
    let Some(Entity::Import(import)) = &entity.parse.entity else { return None };
    let origin = import.path_span?.shifted(entity.span.start);
    let path = database.import_path(entity.id)?;
    let file = database.imported_files(position.file).find(|file| database.path(*file) == path)?;
    let start = Span::at(0);
    Some(Definition { origin, targets: vec![Target { file, full: start, focus: start }] })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor};

    fn check(fixture: &str, expected: &Expect) {
        let (database, position) = at_cursor(fixture);
        let found = goto_definition(&database, position).map(|definition| {
            let targets = definition.targets.iter().map(|target| {
                let text = |span| database.slice(target.file, span);
                format!(
                    "{}..{} {:?} in {:?}",
                    target.focus.start,
                    target.focus.end,
                    text(target.focus),
                    text(target.full)
                )
            });
            targets.collect::<Vec<_>>().join("\n")
        });
        expected.assert_eq(&found.unwrap_or_else(|| "nothing".to_owned()));
    }

    #[test]
    fn a_reference_leads_to_its_declaration() {
        check(
            "robot r with port 1 has { a$0 b } wheels\nwheel a with radius 4 // mine\nsensor a",
            &expect![[r#"45..46 "a" in "wheel a with radius 4""#]],
        );
        check(
            &format!("{PARTS}movement m of $0rover {{ turn left until {{ front }} }}"),
            &expect![[
                r#"98..103 "rover" in "robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }""#
            ]],
        );
        check(
            &format!("{PARTS}movement m of rover {{ turn left until {{ front$0 }} }}"),
            &expect![[r#"65..70 "front" in "sensor front""#]],
        );
    }

    #[test]
    fn a_declaration_leads_to_itself_and_its_twins() {
        check(
            "wheel $0a with radius 4\nwheel a with radius 5",
            &expect![[r#"
            6..7 "a" in "wheel a with radius 4"
            28..29 "a" in "wheel a with radius 5""#]],
        );
    }

    #[test]
    fn other_places_lead_nowhere() {
        check("wh$0eel a with radius 4", &expect!["nothing"]);
        check("robot r with port 1 has { nobody$0 } wheels", &expect!["nothing"]);
    }

    #[test]
    fn an_import_leads_to_its_file() {
        let mut database = Database::new();
        let parts = database.open("d/parts.pyr", "wheel a with radius 4\n");
        let file = database.open("d/main.pyr", "import \"parts.pyr\"\nrobot r with port 1 has { a } wheels");
        let to = |offset| goto_definition(&database, FilePosition { file, offset }).unwrap().targets[0];
        assert_eq!(to(10), Target { file: parts, full: Span::at(0), focus: Span::at(0) });
        assert_eq!(to(45).file, parts);
    }

    #[test]
    fn a_name_of_two_imported_files_leads_to_both() {
        let mut database = Database::new();
        let a = database.open("a.pyr", "wheel w with radius 4");
        let b = database.open("b.pyr", "wheel v with radius 4 wheel w with radius 4");
        let text = "import \"b.pyr\" import \"a.pyr\" robot r with port 1 has { w } wheels";
        let file = database.open("main.pyr", text);
        let offset = u32::try_from(text.find("w }").unwrap()).unwrap();
        let definition = goto_definition(&database, FilePosition { file, offset }).unwrap();
        let focus: Vec<_> =
            definition.targets.iter().map(|target| (target.file, target.focus.start)).collect();
        assert_eq!(focus, [(b, 28), (a, 6)]);
    }

    #[test]
    fn do_leads_to_its_movement() {
        check(
            &format!(
                "{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{ repeat 2 times {{ do side$0 }} }}"
            ),
            &expect![[r#"189..193 "side" in "movement side of rover { slam }""#]],
        );
    }
}
