//! What a completion list shows beside the name of an entity.

use pydslrep_analysis::{Database, FileId};
use pydslrep_syntax::EntityKind;
use smol_str::SmolStr;

use crate::cursor::body;
use crate::hover::facts;

/// More of a declaration is not shown.
const MOST_LINES: usize = 12;

/// What a file declares under a name as it is written, and what is most worth knowing of it; Markdown. `None` for what is
/// no longer there.
pub fn completion_documentation(
    database: &Database,
    home: FileId,
    kind: EntityKind,
    name: &SmolStr,
) -> Option<String> {
    let id = *database.definitions(home, kind, name).first()?;
    let entity = database.entity(id)?;
    let declaration = database.slice(entity.file, body(&entity));
    let mut lines: Vec<&str> = declaration.lines().take(MOST_LINES).collect();
    if declaration.lines().nth(MOST_LINES).is_some() {
        lines.push("…");
    }
    let facts = facts(database, id).unwrap_or_default();
    let first = facts.lines().next().unwrap_or_default();
    Some(format!("```pydslrep\n{}\n```\n{first}", lines.join("\n")).trim_end().to_owned())
}
