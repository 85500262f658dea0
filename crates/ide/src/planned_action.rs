//! Actions of planned paths: the action and environments at the cursor, and the location of an action of a path.

use pydslrep_analysis::{Database, EntityId, EntityRef, FileId};
use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Span};
use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};

use crate::FilePosition;
use crate::cursor::entities_at;
use crate::users::environments_using;

/// The parts of planned paths at a position.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PlannedAt {
    /// The environments of the file in text order, each name once.
    pub environments: Vec<String>,
    /// The environments declared at the position, or using the declaration there, directly or indirectly.
    pub using: Vec<String>,
    /// The action. On its line it includes the space around it.
    pub action: Option<ActionAt>,
}

/// A statement at a position, with those in its blocks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ActionAt {
    /// The movement's name.
    pub movement: String,
    /// From 0, among the statements of its movement.
    pub index: usize,
    /// The index of the last statement in its blocks, if it has any there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last: Option<usize>,
}

/// An action by its index in its movement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct NumberedAction {
    /// The movement's name.
    pub movement: String,
    /// From 0, among the statements of its movement: this one, or the last that is done.
    pub index: usize,
    /// The statements that lead to it by `do`, the outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calls: Vec<PlannedCall>,
}

/// A statement that does another movement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedCall {
    /// The movement that it is in.
    pub movement: String,
    /// From 0, among the statements of that.
    pub index: usize,
}

/// The parts of planned paths at a position.
pub fn planned_at(database: &Database, position: FilePosition) -> PlannedAt {
    let mut environments: Vec<String> = Vec::new();
    for (_, name) in database.environments(position.file) {
        if !environments.iter().any(|known| *known == name.text) {
            environments.push(name.text.to_string());
        }
    }
    let entities = entities_at(database, position);
    let users = entities.first().map(|entity| environments_using(database, entity.id, &[entity.file]));
    let users = users.unwrap_or_default();
    let names: FxHashSet<&str> =
        users.iter().filter_map(|id| Some(database.tree(*id)?.name()?.text.as_str())).collect();
    let using = environments.iter().filter(|name| names.contains(name.as_str())).cloned().collect();
    let action = entities.iter().find_map(|entity| action_in(database, entity, position.offset));
    PlannedAt { environments, using, action }
}

/// The location of an action, given the movement's name as the environment uses it and the action's index.
pub fn action_place(
    database: &Database,
    environment: EntityId,
    NumberedAction { movement, index, calls }: &NumberedAction,
) -> Option<(FileId, Span)> {
    let home = database.file_of(environment)?;
    let mut declared = database.resolve(home, EntityKind::Movement, &movement.into()).entity()?;
    for call in calls {
        declared = done_by(database, declared, call.index)?;
    }
    let entity = database.entity(declared)?;
    let Entity::Movement(tree) = entity.parse.entity.as_ref()? else { return None };
    Some((entity.file, tree.statements().get(*index)?.shifted(entity.span.start)))
}

/// The movement that a statement does.
fn done_by(database: &Database, movement: EntityId, index: usize) -> Option<EntityId> {
    let entity = database.entity(movement)?;
    let Entity::Movement(tree) = entity.parse.entity.as_ref()? else { return None };
    let span = *tree.statements().get(index)?;
    let name = tree.all_actions().find(|action| action.span == span)?.done()?;
    database.resolve(entity.file, EntityKind::Movement, &name.text).entity()
}

fn action_in(database: &Database, entity: &EntityRef<'_>, offset: u32) -> Option<ActionAt> {
    let Entity::Movement(tree) = entity.parse.entity.as_ref()? else { return None };
    let statements: Vec<Span> =
        tree.statements().into_iter().map(|span| span.shifted(entity.span.start)).collect();
    let is_one_line = |span: Span| !database.slice(entity.file, span).contains(['\n', '\r']);
    let begun = statements.partition_point(|span| span.start <= offset);
    // Of those that contain the position, the innermost begins last.
    let before = (0..begun).rev().find(|&index| {
        offset <= statements[index].end || is_one_line(Span::new(statements[index].end, offset))
    });
    let after =
        || statements.get(begun).filter(|next| is_one_line(Span::new(offset, next.start))).map(|_| begun);
    let body = tree.body?.shifted(entity.span.start);
    let index = before.or_else(after).filter(|_| body.touches(offset))?;
    let last = statements.partition_point(|span| span.start < statements[index].end) - 1;
    let movement = tree.name.as_ref()?.text.to_string();
    Some(ActionAt { movement, index, last: Some(last).filter(|last| *last > index) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::PARTS;

    const PROGRAM: &str = "movement go of rover {\n  move 1 meters // far\n\n  turn left move 2 meters\n}
movement stay of rover { }
environment first has { rover } robots with { stay } moves
environment second has { rover } robots with { go } moves
";

    fn at(marked: &str) -> PlannedAt {
        let text = format!("{PARTS}{marked}");
        let offset = text.find('|').unwrap();
        let mut database = Database::new();
        let file = database.open("a.pyr", &text.replace('|', ""));
        planned_at(&database, FilePosition { file, offset: u32::try_from(offset).unwrap() })
    }

    fn action(marked: &str) -> Option<usize> {
        at(marked).action.map(|action| {
            assert_eq!(action.movement, "go");
            action.index
        })
    }

    #[test]
    fn an_action_includes_the_space_around_it() {
        for (place, expected) in [
            ("|  move 1 meters", Some(0)),
            ("  mo|ve 1 meters", Some(0)),
            ("// far|", Some(0)),
            ("far\n|\n", None),
            ("\n|  turn left", Some(1)),
            ("turn left| move", Some(1)),
            ("turn left m|ove", Some(2)),
            ("\n}|", None),
            ("movement g|o", None),
        ] {
            let plain = place.replace('|', "");
            assert_eq!(action(&PROGRAM.replacen(&plain, place, 1)), expected, "{place:?}");
        }
    }

    #[test]
    fn a_statement_includes_those_in_its_blocks() {
        let program = "movement go of rover {
  repeat 2 times {
    if { front } detect { turn left } else if { front } clear {
      repeat 3 times { move 1 meters }
    } else { }
  }
  turn left
}";
        for (place, expected) in [
            ("  re|peat 2", (0, Some(5))),
            ("    if {| front } detect", (1, Some(5))),
            ("{ turn l|eft", (2, None)),
            ("else i|f", (3, Some(5))),
            ("re|peat 3", (4, Some(5))),
            ("else {| }", (3, Some(5))),
            ("  tur|n left\n}", (6, None)),
        ] {
            let plain = place.replace('|', "");
            let found = at(&program.replacen(&plain, place, 1)).action.unwrap();
            assert_eq!((found.index, found.last), expected, "{place:?}");
        }
    }

    #[test]
    fn environments_use_their_lists_and_dependencies() {
        let using = |text: &str, place: &str| {
            let plain = place.replace('|', "");
            at(&text.replacen(&plain, place, 1)).using.join(" ")
        };
        assert_eq!(using(PROGRAM, "go of ro|ver"), "second");
        assert_eq!(using(PROGRAM, "stay o|f"), "first");
        assert_eq!(using(PROGRAM, "environment se|cond"), "second");
        let own = format!("wheel spare with radius 4\nsensor rear\n{PROGRAM}");
        assert_eq!(using(&own, "wheel sp|are"), "");
        assert_eq!(at(&own.replacen("sensor", "sens|or", 1)).environments, ["first", "second"]);
        let mut database = Database::new();
        let file = database.open("a.pyr", &format!("{PARTS}{PROGRAM}"));
        assert_eq!(planned_at(&database, FilePosition { file, offset: 3 }).using, ["first", "second"]);
    }

    #[test]
    fn actions_are_located_in_their_declaring_file() {
        let mut database = Database::new();
        let parts = database.open("parts.pyr", &format!("{PARTS}{PROGRAM}"));
        let text = "import \"parts.pyr\"\nenvironment third has { rover } robots with { go } moves";
        let file = database.open("a.pyr", text);
        let id = database.environments(file)[0].0;
        let place = |movement: &str, index| {
            action_place(
                &database,
                id,
                &NumberedAction { movement: movement.to_owned(), index, calls: Vec::new() },
            )
        };
        let (home, span) = place("go", 2).unwrap();
        assert_eq!((home, database.slice(home, span).as_str()), (parts, "move 2 meters"));
        assert_eq!((place("go", 3), place("gone", 0)), (None, None));
    }
}
