//! Names of entities: those of the expected kind that fit at the cursor, the likeliest first.
//!
//! Ranking a name has a cost, and a file can have very many. Beyond a limit only names declared near the cursor are
//! ranked; the others follow in alphabetical order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use pydslrep_analysis::{Database, EntityId, FileId};
use pydslrep_syntax::ast::{Action, Entity, Robot};
use pydslrep_syntax::{EntityKind, TextEdit, escape};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::context::CompletionContext;
use super::defaults::robot_of;
use super::filter::starts_with;
use super::{Completion, CompletionKind, Documentation, MAX_ITEMS, Rank, paths};
use crate::cursor::{is_mecanum, named_robot};

/// Up to this many names, all are ranked.
pub(super) const MAX_RANKED: usize = 1_000;

/// Beyond that, only those of this many entities on either side of the cursor.
pub(super) const NEARBY_ENTITIES: usize = 200;

/// The maximum number of names from files that are not imported.
const MAX_UNIMPORTED: usize = 50;

/// The names of a kind that fit at the cursor.
pub(super) fn names(context: &CompletionContext<'_>, kind: EntityKind) -> Vec<Completion> {
    let wanted = Wanted::at(context, kind);
    let chosen = wanted.only(context).unwrap_or_else(|| visible(context, &wanted));
    let mut found: Vec<Completion> =
        chosen.iter().filter_map(|name| reference(context, kind, name)).collect();
    if !matches!(wanted.for_, For::Condition(_) | For::Do) && !begins_a_name(context, &wanted) {
        found.extend(unimported(context, &wanted));
    }
    found
}

/// The requirements on a name at the cursor.
struct Wanted<'a> {
    kind: EntityKind,
    /// The names already in the list at the cursor.
    listed: Vec<SmolStr>,
    for_: For<'a>,
}

/// Where the name is used, if that restricts it.
enum For<'a> {
    /// The wheels of a robot: mecanum or not, and their radius.
    Robot(Option<bool>, Option<f64>),
    /// The condition of an action, on this robot.
    Condition(Option<&'a Robot>),
    /// `do`, in a movement.
    Do,
    /// The movements of an environment with these robots, if known.
    Environment(Option<Vec<EntityId>>),
    /// Anything else.
    Other,
}

impl<'a> Wanted<'a> {
    fn at(context: &CompletionContext<'a>, kind: EntityKind) -> Self {
        let listed = context.listed();
        let for_ = match (context.tree, kind) {
            (Some(Entity::Robot(robot)), EntityKind::Wheel) => wheels_of(context, robot, &listed),
            (Some(Entity::Movement(movement)), EntityKind::Sensor) => {
                For::Condition(robot_of(context, movement))
            }
            (Some(Entity::Movement(_)), EntityKind::Movement) => For::Do,
            (Some(Entity::Environment(environment)), EntityKind::Movement) => {
                let ids = |name: &pydslrep_syntax::ast::Name| {
                    context.database.resolve(context.file, EntityKind::Robot, &name.text).entity()
                };
                let robots = environment.robots.as_ref().filter(|list| !list.broken);
                For::Environment(robots.map(|list| list.names.iter().filter_map(ids).collect()))
            }
            _ => For::Other,
        };
        Self { kind, listed, for_ }
    }

    /// The only possible names, if a few entities determine them.
    fn only(&self, context: &CompletionContext<'_>) -> Option<Vec<SmolStr>> {
        let seen =
            |name: &&SmolStr| context.database.resolve(context.file, self.kind, name).entity().is_some();
        match &self.for_ {
            For::Condition(Some(robot)) => {
                let carried = robot.sensors.iter().flat_map(|list| &list.names).map(|name| &name.text);
                let mut names: Vec<SmolStr> =
                    carried.filter(seen).filter(|name| !self.listed.contains(name)).cloned().collect();
                let mut known = FxHashSet::default();
                names.retain(|name| known.insert(name.clone()));
                Some(names)
            }
            For::Do => Some(to_do(context)),
            For::Environment(Some(robots)) => Some(self.movements_of(context, robots)),
            _ => None,
        }
    }

    /// The visible movements of these robots, first those not listed yet.
    fn movements_of(&self, context: &CompletionContext<'_>, robots: &[EntityId]) -> Vec<SmolStr> {
        let files: Vec<FileId> =
            std::iter::once(context.file).chain(context.database.imported_files(context.file)).collect();
        let mut names: Vec<(bool, SmolStr)> = Vec::new();
        for robot in robots {
            let Some(robot) = context.database.tree(*robot).and_then(Entity::name) else { continue };
            let users =
                files.iter().flat_map(|file| context.database.users(*file, EntityKind::Robot, &robot.text));
            let movements = users.filter_map(|id| match context.database.tree(*id) {
                Some(Entity::Movement(movement)) => Some((*id, &movement.name.as_ref()?.text)),
                _ => None,
            });
            let fitting = movements.filter(|(id, name)| {
                let seen = context.database.resolve(context.file, EntityKind::Movement, name).entity();
                seen == Some(*id) && self.fits(context.database, *id)
            });
            names.extend(fitting.map(|(_, name)| (self.listed.contains(name), name.clone())));
        }
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(|(_, name)| name).collect()
    }

    /// Returns whether an entity fits at the cursor.
    fn fits(&self, database: &Database, id: EntityId) -> bool {
        match (&self.for_, database.tree(id)) {
            (For::Robot(Some(mecanum), _), Some(Entity::Wheel(wheel))) => wheel.mecanum == *mecanum,
            (For::Environment(Some(robots)), Some(Entity::Movement(movement))) => {
                let robot = database.file_of(id).and_then(|file| named_robot(database, file, movement));
                robot.is_none_or(|robot| robots.contains(&robot))
            }
            _ => true,
        }
    }

    /// Returns the rank of an entity, lowest first: wheels of another radius, names in use and imported names come
    /// later.
    fn cost(&self, context: &CompletionContext<'_>, name: &SmolStr, id: EntityId) -> u8 {
        let tree = context.database.tree(id);
        let other_radius = match (&self.for_, tree) {
            (For::Robot(_, Some(wanted)), Some(Entity::Wheel(wheel))) => {
                wheel.radius.as_ref().and_then(|radius| radius.value) != Some(*wanted)
            }
            _ => false,
        };
        // The next movement is likely for a robot without one.
        let is_used_once = matches!(self.kind, EntityKind::Wheel | EntityKind::Sensor | EntityKind::Robot);
        let is_used = is_used_once
            && !matches!(context.tree, Some(Entity::Environment(_)))
            && !context.database.users(context.file, self.kind, name).is_empty();
        let is_listed = self.kind == EntityKind::Movement && self.listed.contains(name);
        let is_imported = context.database.file_of(id) != Some(context.file);
        4 * u8::from(other_radius) + 2 * u8::from(is_used || is_listed) + u8::from(is_imported)
    }

    /// Returns whether the list at the cursor already has a name; movements may be listed again.
    fn is_taken(&self, name: &SmolStr) -> bool {
        self.kind != EntityKind::Movement && self.listed.contains(name)
    }
}

/// The movements that the movement at the cursor can do: visible ones of the same robot that do not do it in turn, those
/// that nothing does first.
pub(super) fn to_do(context: &CompletionContext<'_>) -> Vec<SmolStr> {
    let movement = context.movement();
    let robot = movement.and_then(|movement| named_robot(context.database, context.file, movement));
    let Some(robot) = robot else { return Vec::new() };
    let wanted =
        Wanted { kind: EntityKind::Movement, listed: Vec::new(), for_: For::Environment(Some(vec![robot])) };
    let names = wanted.movements_of(context, &[robot]);
    let id = |name: &SmolStr| context.database.resolve(context.file, EntityKind::Movement, name).entity();
    let ids: Vec<Option<EntityId>> = names.iter().map(id).collect();
    let excluded = context.entity.map(|own| doing(context.database, own, ids.iter().flatten().copied()));
    let is_excluded =
        |id: &Option<EntityId>| id.is_none_or(|id| excluded.iter().any(|all| all.contains(&id)));
    let mut fitting: Vec<(bool, SmolStr)> = names
        .into_iter()
        .zip(&ids)
        .filter(|(_, id)| !is_excluded(id))
        .map(|(name, _)| {
            (!context.database.users(context.file, EntityKind::Movement, &name).is_empty(), name)
        })
        .collect();
    fitting.sort();
    fitting.into_iter().map(|(_, name)| name).collect()
}

/// A movement, and those among others that do it, directly or by each other.
fn doing(database: &Database, own: EntityId, others: impl Iterator<Item = EntityId>) -> FxHashSet<EntityId> {
    let mut callers: FxHashMap<EntityId, Vec<EntityId>> = FxHashMap::default();
    for id in others {
        let (Some(Entity::Movement(movement)), Some(file)) = (database.tree(id), database.file_of(id)) else {
            continue;
        };
        for done in movement.all_actions().filter_map(Action::done) {
            if let Some(done) = database.resolve(file, EntityKind::Movement, &done.text).entity() {
                callers.entry(done).or_default().push(id);
            }
        }
    }
    let mut found = FxHashSet::from_iter([own]);
    let mut open = vec![own];
    while let Some(done) = open.pop() {
        let more = callers.get(&done).into_iter().flatten().filter(|caller| found.insert(**caller));
        open.extend(more);
    }
    found
}

/// All wheels of a robot are of one kind: that of the listed ones, or that of its type.
fn wheels_of<'a>(context: &CompletionContext<'a>, robot: &Robot, listed: &[SmolStr]) -> For<'a> {
    let first =
        listed.iter().find_map(|name| Some((name, is_mecanum(context.database, context.file, name)?)));
    let radius = first.and_then(|(name, _)| {
        let id = context.database.resolve(context.file, EntityKind::Wheel, name).entity()?;
        match context.database.tree(id)? {
            Entity::Wheel(wheel) => wheel.radius.as_ref()?.value,
            _ => None,
        }
    });
    // A robot of a type that may be another one with mecanum wheels can have either.
    let drive = robot.drive.and_then(|clause| clause.word).filter(|drive| drive.row().on_mecanum.is_none());
    let by_type = drive.map(|drive| drive.row().mecanum);
    For::Robot(first.map(|(_, mecanum)| mecanum).or(by_type), radius)
}

/// The best visible names of a kind.
fn visible(context: &CompletionContext<'_>, wanted: &Wanted<'_>) -> Vec<SmolStr> {
    let mut all: Vec<&SmolStr> = context
        .database
        .names_in_sight(context.file, wanted.kind)
        .filter(|name| !wanted.is_taken(name))
        .collect();
    if all.len() > MAX_ITEMS {
        all.retain(|name| is_subsequence(&context.typed, name));
    }
    let fitting = |name: &SmolStr| {
        let id = context.database.resolve(context.file, wanted.kind, name).entity()?;
        wanted.fits(context.database, id).then_some(id)
    };
    let near: FxHashSet<&SmolStr> =
        if all.len() > MAX_RANKED { near(context, wanted.kind) } else { FxHashSet::default() };
    let is_ranked = |name: &&SmolStr| all.len() <= MAX_RANKED || near.contains(name);
    let mut ranked: Vec<_> = all
        .iter()
        .copied()
        .filter(is_ranked)
        .filter_map(|name| Some((order(context, name), wanted.cost(context, name, fitting(name)?), name)))
        .collect();
    ranked.sort_unstable();
    ranked.dedup();
    let mut chosen: Vec<SmolStr> =
        ranked.iter().take(MAX_ITEMS).map(|(_, _, name)| (*name).clone()).collect();
    if all.len() > MAX_RANKED {
        let others = all.iter().copied().filter(|name| !near.contains(name));
        let mut others: BinaryHeap<_> = others.map(|name| Reverse((order(context, name), name))).collect();
        while let Some(Reverse((_, name))) = others.pop() {
            if chosen.len() == MAX_ITEMS {
                break;
            }
            // An imported file may declare it, too.
            if chosen.last() != Some(name) && fitting(name).is_some() {
                chosen.push(name.clone());
            }
        }
    }
    chosen
}

/// Sorts the name that is typed already first, and names with the typed prefix before those that only contain the letters.
fn order(context: &CompletionContext<'_>, name: &str) -> (bool, bool) {
    (name != context.written, !starts_with(name, &context.typed))
}

/// Returns whether a name contains the typed letters in this order, ignoring case: every editor's own filter requires
/// this.
fn is_subsequence(typed: &str, name: &str) -> bool {
    let mut letters = name.bytes();
    typed.bytes().all(|wanted| letters.any(|letter| letter.eq_ignore_ascii_case(&wanted)))
}

/// The names of a kind declared near the cursor.
fn near<'a>(context: &CompletionContext<'a>, kind: EntityKind) -> FxHashSet<&'a SmolStr> {
    let around = context.database.entities_around(context.file, context.word.start, NEARBY_ENTITIES);
    let trees = around.filter_map(|id| context.database.tree(id));
    trees.filter(|tree| tree.kind() == Some(kind)).filter_map(|tree| Some(&tree.name()?.text)).collect()
}

fn reference(context: &CompletionContext<'_>, kind: EntityKind, name: &SmolStr) -> Option<Completion> {
    let id = context.database.resolve(context.file, kind, name).entity()?;
    let home = context.database.file_of(id)?;
    let detail = match context.database.path_for_import(context.file, home) {
        Some(path) if home != context.file => format!("{} from {path}", kind.noun()),
        _ => kind.noun().to_owned(),
    };
    Some(Completion {
        detail,
        documentation: Documentation::Of(home, kind),
        insert: escape(name),
        ..context.item(name, CompletionKind::Reference(kind), Rank::Fitting)
    })
}

/// Returns whether a visible name begins with the typed letters: then no others are offered.
fn begins_a_name(context: &CompletionContext<'_>, wanted: &Wanted<'_>) -> bool {
    let may_stand_here = |name: &&SmolStr| {
        let seen = context.database.resolve(context.file, wanted.kind, name).entity();
        wanted.is_taken(name) || seen.is_some_and(|id| wanted.fits(context.database, id))
    };
    let names = context.database.names_in_sight(context.file, wanted.kind);
    names.filter(|name| starts_with(name, &context.typed)).any(|name| may_stand_here(&name))
}

/// Names from files that are not imported yet, each with the edit that imports its file.
fn unimported(context: &CompletionContext<'_>, wanted: &Wanted<'_>) -> Vec<Completion> {
    let mut items = Vec::new();
    for (path, file) in paths::not_imported(context.database, context.file) {
        let names =
            context.database.names(file, wanted.kind).filter(|name| is_subsequence(&context.typed, name));
        let mut names: Vec<(&SmolStr, EntityId)> = names
            .filter(|name| !wanted.is_taken(name))
            .filter_map(|name| Some((name, *context.database.definitions(file, wanted.kind, name).first()?)))
            .filter(|(_, id)| wanted.fits(context.database, *id))
            .filter(|(name, _)| context.database.resolve(context.file, wanted.kind, name).entity().is_none())
            .collect();
        if names.is_empty() {
            continue;
        }
        names.sort_unstable();
        let (span, text) = paths::import_line(context.database, context.file, &path);
        for (name, _) in names {
            if items.len() == MAX_UNIMPORTED {
                return items;
            }
            items.push(Completion {
                detail: format!("{} from {path}, adds the import", wanted.kind.noun()),
                documentation: Documentation::Of(file, wanted.kind),
                insert: escape(name),
                imports: Some(file),
                import_edit: Some(TextEdit { span, text: text.clone() }),
                ..context.item(name, CompletionKind::Reference(wanted.kind), Rank::Elsewhere)
            });
        }
    }
    items
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::completion::testing::{asked, check, check_in, opens};
    use crate::completion::{CompletionTrigger, MAX_ITEMS, completions};
    use crate::fixture::{PARTS, at_cursor};

    #[test]
    fn a_list_offers_names_it_does_not_have_yet() {
        check(
            &format!("{PARTS}robot r type tw with port 1 has {{ wheelL $0 }} wheels"),
            &expect![[r#"
                wheelR [wheel] "" -> "wheelR"
                } [] "" -> "}"
            "#]],
        );
        check(
            &format!("{PARTS}robot r type fwh with port 1 has {{ $0 }} wheels"),
            &expect![[r#"
                } [] "" -> "}"
            "#]],
        );
        check(
            &format!("{PARTS}robot r type tw with port 1 has {{ wheelL whe$0 }} wheels"),
            &expect![[r#"
                wheelR [wheel] "whe" -> "wheelR"
            "#]],
        );
    }

    #[test]
    fn a_turn_offers_its_robots_sensors() {
        check(
            &format!("{PARTS}movement m of rover {{ turn left until {{ $0"),
            &expect![[r#"
                front [sensor] "" -> "front"
            "#]],
        );
    }

    #[test]
    fn an_environment_offers_its_robots_movements() {
        check(
            &format!(
                "{PARTS}robot other with port 2 has {{ wheelL wheelR }} wheels movement m of rover {{ slam }} movement n of other {{ slam }}\nenvironment e has {{ rover }} robots with {{ $0"
            ),
            &expect![[r#"
                m [movement] "" -> "m"
                } moves [with { MOVEMENTS } moves] "" -> "} moves"
            "#]],
        );
    }

    #[test]
    fn do_offers_movements_of_the_same_robot_that_do_not_lead_back() {
        let movements = format!(
            "{PARTS}robot other type tw with port 1 has {{ wheelL wheelR }} wheels\n\
             movement leg of rover {{ slam }}\nmovement back of rover {{ repeat 2 times {{ do m }} }}\n\
             movement far of rover {{ do back }}\nmovement foreign of other {{ slam }}\n\
             movement done of rover {{ do leg }}\n"
        );
        let inside = |actions: &str| format!("{movements}movement m of rover {{ {actions}");
        assert_eq!(asked(&inside("do $0")), ["done", "leg"]);
        assert_eq!(asked(&inside("do d$0 wait 1 seconds }")), ["done"]);
        assert_eq!(opens(&inside("repeat 2 times { do $0 } }")), ["done", "leg"]);
        assert_eq!(asked(&inside("if { front } clear { slam } else { do $0")), ["done", "leg"]);
        // Names, not actions.
        assert_eq!(opens(&inside("turn left until { do $0 }")), [""; 0]);
        assert_eq!(opens(&inside("do leg $0 }")), [""; 0]);
    }

    #[test]
    fn names_of_other_files_bring_their_import() {
        let wheels = ("lib/wheels.pyr", "wheel big with radius 9 wheelH round with radius 9");
        let more = ("more.pyr", "wheel ^type with radius 1 wheel big with radius 2");
        check_in(
            &[wheels, more, ("a.pyr", "import \"more.pyr\"\nrobot r type tw with port 1 has { $0 } wheels")],
            &expect![[r#"
                big [wheel from more.pyr] "" -> "big"
                type [wheel from more.pyr] "" -> "^type"
                } [] "" -> "}"
            "#]],
        );
        check_in(
            &[wheels, more, ("a.pyr", "// head\nimport \"more.pyr\"\nrobot r with port 1 has { r$0")],
            &expect![[r#"
                round [wheel from lib/wheels.pyr, adds the import] "r" -> "round" and "import \"lib/wheels.pyr\"\n" at 8
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "wheel rear with radius 1\nrobot r with port 1 has { r$0")],
            &expect![[r#"
                rear [wheel] "r" -> "rear"
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "wheelH rear with radius 1\nrobot r type tw with port 1 has { $0")],
            &expect![[r#"
                } wheels [has { WHEELS } wheels] "" -> "} wheels"
                big [wheel from lib/wheels.pyr, adds the import] "" -> "big" and "import \"lib/wheels.pyr\"\n\n" at 0
            "#]],
        );
        check_in(
            &[wheels, ("a.pyr", "\u{feff}robot r type fwh with port 1 has { $0 } wheels")],
            &expect![[r#"
            } [] "" -> "}"
            round [wheel from lib/wheels.pyr, adds the import] "" -> "round" and "import \"lib/wheels.pyr\"\n\n" at 3
        "#]],
        );
    }

    #[test]
    fn keywords_as_names_are_escaped() {
        check(
            "sensor ^robots robot r with port 1 has { } wheels with sensors { ro$0",
            &expect![[r#"
            robots [sensor] "ro" -> "^robots"
        "#]],
        );
        check(
            "sensor ^robots sensor s robot r with port 1 has { } wheels with sensors { ^$0 }",
            &expect![[r#"
            robots [sensor] "^" -> "^robots"
            s [sensor] "^" -> "s"
        "#]],
        );
    }

    #[test]
    fn the_likeliest_wheels_come_first() {
        check(
            "wheel a with radius 9 wheel b with radius 4 wheel c with radius 4 wheel d with radius 4 wheelH e with radius 4\n\
             robot q with port 1 has { b } wheels robot r with port 1 has { c $0 } wheels",
            &expect![[r#"
                d [wheel] "" -> "d"
                b [wheel] "" -> "b"
                a [wheel] "" -> "a"
                } [] "" -> "}"
            "#]],
        );
        check(
            "wheelH a with radius 4 wheelH b with radius 4 wheelH c with radius 4 wheelH d with radius 4\n\
             robot r type $0 with port 1 has { a b c d } wheels",
            &expect![[r#"
                fwh [Mecanum drive] "" -> "fwh"
                tw [Two-wheel differential drive] "" -> "tw"
                fw [Four-wheel skid-steer drive] "" -> "fw"
            "#]],
        );
    }

    #[test]
    fn lists_have_a_maximum_length() {
        let many: Vec<String> = (0..5_000).map(|number| format!("sensor s{number:04}end")).collect();
        let many = many.join("\n");
        let found = |typed: &str| {
            let (database, position) = at_cursor(&format!(
                "sensor zigzag\n{many}\nsensor near robot r with port 1 has {{ }} wheels with sensors {{ {typed}$0"
            ));
            let found = completions(&database, position, CompletionTrigger::Invoked, 9.0);
            found.into_iter().map(|item| item.label).collect::<Vec<String>>()
        };
        let labels = found("");
        assert_eq!(labels.len(), MAX_ITEMS);
        assert!(labels.contains(&"near".to_owned()), "the nearest declaration");
        assert_eq!(found("s4321end"), ["s4321end"]);
        assert_eq!(found("s432").iter().filter(|label| label.starts_with("s432")).count(), 10);
        assert_eq!(found("Z"), ["zigzag"]);
    }
}
