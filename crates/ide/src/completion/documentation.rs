//! Documentation for the names in a completion list.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::EntityKind;
use smol_str::SmolStr;

use crate::cursor::body;
use crate::hover::describe;

/// The maximum number of lines shown of a declaration.
const MAX_LINES: usize = 12;

/// The declaration of a name in a file and its key figures, as Markdown. `None` if it no longer exists.
pub fn completion_documentation(
    database: &Database,
    home: FileId,
    kind: EntityKind,
    name: &SmolStr,
) -> Option<String> {
    let id = *database.definitions(home, kind, name).first()?;
    let entity = database.entity(id)?;
    let declaration = database.slice(entity.file, body(&entity));
    let mut lines: Vec<&str> = declaration.lines().take(MAX_LINES).collect();
    if declaration.lines().nth(MAX_LINES).is_some() {
        lines.push("…");
    }
    let facts = describe(database, id).unwrap_or_default();
    let first = facts.lines().next().unwrap_or_default();
    Some(format!("```pydslrep\n{}\n```\n{first}", lines.join("\n")).trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::completion::{CompletionTrigger, Documentation, completion_documentation, completions};
    use crate::fixture::{PARTS, at_cursor};

    #[test]
    fn a_name_is_documented_on_request() {
        let (database, position) = at_cursor(&format!("{PARTS}movement m of $0"));
        let item = completions(&database, position, CompletionTrigger::Invoked, 9.0).remove(0);
        let Documentation::Of(home, kind) = item.documentation else { panic!("{item:?}") };
        expect![[r#"
            ```pydslrep
            robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }
            ```
            Two-wheel differential drive (`tw`), port 23000."#]]
        .assert_eq(&completion_documentation(&database, home, kind, &item.label.into()).unwrap_or_default());
    }
}
