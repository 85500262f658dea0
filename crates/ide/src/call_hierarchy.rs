//! Call hierarchy: the movements an environment runs, those that they do, and the robot each of them drives; and back, from a
//! robot to its movements and from those to the movements and environments that run them.

use pydslrep_analysis::{Database, EntityId, EntityRef, FileId, FileSpan};
use pydslrep_syntax::ast::{Action, Entity, Name};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

use crate::FilePosition;
use crate::cursor::{body, name_at};
use crate::symbols::detail;

/// An environment, a movement or a robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CallItem {
    /// The entity.
    pub id: EntityId,
    /// The file that declares it.
    pub file: FileId,
    /// Its kind.
    pub kind: EntityKind,
    /// Its name.
    pub name: String,
    /// A one-line summary.
    pub detail: String,
    /// The range of the declaration.
    pub full: Span,
    /// The range of its name.
    pub focus: Span,
}

/// The item at the other end of a call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Call {
    /// The caller or the callee.
    pub item: CallItem,
    /// The references to the callee, in the caller's file.
    pub ranges: Vec<Span>,
}

/// The declarations of the name at a position; several if it is declared twice.
pub fn call_items(database: &Database, position: FilePosition) -> Vec<CallItem> {
    let Some(at) = name_at(database, position) else { return Vec::new() };
    let candidates = database.candidates(position.file, at.kind, &at.name.text).into_iter();
    candidates.filter_map(|id| item(&database.entity(id)?)).collect()
}

/// Finds an item again by its name and the range of its name; the first of that name if the range has changed.
pub fn call_item(
    database: &Database,
    file: FileId,
    kind: EntityKind,
    name: &str,
    focus: Span,
) -> Option<CallItem> {
    let declared = database.definitions(file, kind, &SmolStr::new(name)).iter();
    let mut items: Vec<CallItem> = declared.filter_map(|id| item(&database.entity(*id)?)).collect();
    let place = items.iter().position(|item| item.focus == focus).unwrap_or(0);
    (place < items.len()).then(|| items.swap_remove(place))
}

/// The movements of a robot, or the movements and environments that run a movement, in all files.
pub fn incoming_calls(database: &Database, called: &CallItem) -> Vec<Call> {
    let caller_kinds: &[EntityKind] = match called.kind {
        EntityKind::Robot => &[EntityKind::Movement],
        EntityKind::Movement => &[EntityKind::Movement, EntityKind::Environment],
        _ => return Vec::new(),
    };
    let places = database.references(called.file, called.kind, &SmolStr::new(&called.name));
    let mut calls = Vec::new();
    for uses in places.chunk_by(|a, b| a.file == b.file) {
        calls.extend(
            callers(database, uses).into_iter().filter(|call| caller_kinds.contains(&call.item.kind)),
        );
    }
    calls
}

/// The named entities that contain these references, all in one file.
fn callers(database: &Database, mut places: &[FileSpan]) -> Vec<Call> {
    let Some(first) = places.first() else { return Vec::new() };
    let mut calls = Vec::new();
    for entity in database.entities(first.file) {
        let count = places.partition_point(|place| place.span.start < entity.span.end);
        let (inside, after) = places.split_at(count);
        places = after;
        if let (false, Some(item)) = (inside.is_empty(), item(&entity)) {
            calls.push(Call { item, ranges: inside.iter().map(|place| place.span).collect() });
        }
        if places.is_empty() {
            break;
        }
    }
    calls
}

/// The movements an environment runs or a movement does, each once, and the robot it drives.
pub fn outgoing_calls(database: &Database, caller: &CallItem) -> Vec<Call> {
    let Some(entity) = database.entity(caller.id) else { return Vec::new() };
    let movements = |name| (EntityKind::Movement, name);
    let names: Vec<(EntityKind, &Name)> = match &entity.parse.entity {
        Some(Entity::Environment(environment)) => {
            environment.movements.iter().flat_map(|list| &list.names).map(movements).collect()
        }
        Some(Entity::Movement(movement)) => {
            let robot = movement.robot.iter().map(|name| (EntityKind::Robot, name));
            robot.chain(movement.all_actions().filter_map(Action::done).map(movements)).collect()
        }
        _ => return Vec::new(),
    };
    let mut calls: Vec<Call> = Vec::new();
    for (kind, name) in names {
        let Some(id) = database.resolve(entity.file, kind, &name.text).entity() else { continue };
        let range = name.span.shifted(entity.span.start);
        if let Some(known) = calls.iter_mut().find(|call| call.item.id == id) {
            known.ranges.push(range);
        } else if let Some(item) = database.entity(id).as_ref().and_then(item) {
            calls.push(Call { item, ranges: vec![range] });
        }
    }
    calls
}

fn item(entity: &EntityRef<'_>) -> Option<CallItem> {
    let tree = entity.parse.entity.as_ref()?;
    let kind = tree.kind()?;
    if !matches!(kind, EntityKind::Robot | EntityKind::Movement | EntityKind::Environment) {
        return None;
    }
    let name = tree.name()?;
    Some(CallItem {
        id: entity.id,
        file: entity.file,
        kind,
        name: name.text.to_string(),
        detail: detail(tree),
        full: body(entity),
        focus: name.span.shifted(entity.span.start),
    })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::at_cursor_in;

    fn shown(database: &Database, caller: Option<FileId>, calls: &[Call]) -> String {
        let line = |call: &Call| {
            let item = &call.item;
            let texts = call.ranges.iter().map(|span| {
                format!("{} {:?}", span.start, database.slice(caller.unwrap_or(item.file), *span))
            });
            let texts: Vec<String> = texts.collect();
            let kind = item.kind.noun();
            format!(
                "  {kind} {} ({}) in {}: {}\n",
                item.name,
                item.detail,
                database.path(item.file),
                texts.join(", ")
            )
        };
        calls.iter().map(line).collect()
    }

    fn check(files: &[(&str, &str)], expected: &Expect) {
        let (database, position) = at_cursor_in(files);
        let mut all = String::new();
        for item in call_items(&database, position) {
            let again = call_item(&database, item.file, item.kind, &item.name, item.focus);
            assert_eq!(again.as_ref(), Some(&item));
            all += &format!("{} {} at {}\n", item.kind.noun(), item.name, item.focus.start);
            all += &format!(" incoming\n{}", shown(&database, None, &incoming_calls(&database, &item)));
            all += &format!(
                " outgoing\n{}",
                shown(&database, Some(item.file), &outgoing_calls(&database, &item))
            );
        }
        expected.assert_eq(&all);
    }

    const PARTS: (&str, &str) =
        ("parts.pyr", "robot ^robots type tw with port 1\nmovement far of ^robots { move 1 meters }");

    #[test]
    fn environments_run_movements_that_drive_robots() {
        let main = "import \"parts.pyr\"\nmovement near of ^robots { }\nmovement lost of nobody { }\n\
                    environment e has { ^robots } robots with { far near far gone } moves";
        let at = |name: &str| {
            [PARTS, ("main.pyr", &*main.replacen(name, &format!("$0{name}"), 1))]
                .map(|(path, text)| (path.to_owned(), text.to_owned()))
        };
        let check = |name: &str, expected: &Expect| {
            let files = at(name);
            check(&files.each_ref().map(|(path, text)| (path.as_str(), text.as_str())), expected);
        };
        check(
            "^robots",
            &expect![[r#"
            robot robots at 6
             incoming
              movement far (of robots, 1 action) in parts.pyr: 50 "^robots"
              movement near (of robots, 0 actions) in main.pyr: 36 "^robots"
             outgoing
        "#]],
        );
        check(
            "e has",
            &expect![[r#"
            environment e at 88
             incoming
             outgoing
              movement far (of robots, 1 action) in parts.pyr: 120 "far", 129 "far"
              movement near (of robots, 0 actions) in main.pyr: 124 "near"
        "#]],
        );
        check(
            "far",
            &expect![[r#"
            movement far at 43
             incoming
              environment e (1 robot, 4 movements) in main.pyr: 120 "far", 129 "far"
             outgoing
              robot robots (tw, port 1) in parts.pyr: 50 "^robots"
        "#]],
        );
        check(
            "lost",
            &expect![[r#"
            movement lost at 57
             incoming
             outgoing
        "#]],
        );
        check("gone", &expect![[""]]);
    }

    #[test]
    fn twins_and_broken_text() {
        check(
            &[(
                "a.pyr",
                "robot r\nmovement m of r {\nmovement m of { }\nenvironment e has { r } robots with { m$0 m",
            )],
            &expect![[r#"
                movement m at 17
                 incoming
                  environment e (1 robot, 2 movements) in a.pyr: 82 "m", 84 "m"
                 outgoing
                  robot r () in a.pyr: 22 "r"
                movement m at 35
                 incoming
                  environment e (1 robot, 2 movements) in a.pyr: 82 "m", 84 "m"
                 outgoing
            "#]],
        );
    }

    #[test]
    fn parts_call_nobody() {
        check(&[("a.pyr", "wheel $0w with radius 4 robot r with port 1 has { w } wheels")], &expect![[""]]);
    }

    #[test]
    fn movements_do_movements() {
        check(
            &[(
                "a.pyr",
                "robot r type tw with port 1\nmovement all of r { repeat 2 times { do side do side } }\n\
                 movement si$0de of r { if { s } clear { do leg } else { do all } }\nmovement leg of r { slam }\n\
                 environment e has { r } robots with { side } moves",
            )],
            &expect![[r#"
                movement side at 94
                 incoming
                  movement all (of r, 3 actions) in a.pyr: 68 "side", 76 "side"
                  environment e (1 robot, 1 movement) in a.pyr: 215 "side"
                 outgoing
                  robot r (tw, port 1) in a.pyr: 102 "r"
                  movement leg (of r, 1 action) in a.pyr: 126 "leg"
                  movement all (of r, 3 actions) in a.pyr: 142 "all"
            "#]],
        );
    }
}
