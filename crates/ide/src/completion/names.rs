//! Names of entities: those of the kind that is wanted, as far as they make sense at the cursor, the likeliest first.
//!
//! What is asked of a name costs something, and a file can have very many of them. Of so many only those that are
//! declared near the cursor are weighed; the others come in the order of the alphabet.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use pydslrep_analysis::{Database, EntityId, FileId};
use pydslrep_syntax::ast::{DriveWord, Entity, Robot};
use pydslrep_syntax::{EntityKind, TextEdit, as_written};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::defaults::robot_of;
use super::filter::starts_with;
use super::context::CursorContext;
use super::keywords::is_mecanum;
use super::{Completion, CompletionKind, Documentation, MOST, Rank, paths};

/// Of so many names each is weighed.
pub(super) const FEW: usize = 1_000;

/// Of more, those of so many entities on either side of the cursor are.
pub(super) const NEAR: usize = 200;

/// So many names of files that are not imported are offered.
const MOST_ELSEWHERE: usize = 50;

/// The names of a kind that fit.
pub(super) fn names(place: &CursorContext<'_>, kind: EntityKind) -> Vec<Completion> {
    let wanted = Wanted::at(place, kind);
    let chosen = wanted.only(place).unwrap_or_else(|| in_sight(place, &wanted));
    let mut found: Vec<Completion> = chosen.iter().filter_map(|name| reference(place, kind, name)).collect();
    if !matches!(wanted.for_, For::Turn(_)) {
        found.extend(elsewhere(place, &wanted));
    }
    found
}

/// What a name has to be like.
struct Wanted<'a> {
    kind: EntityKind,
    /// The names that the list at the cursor has already.
    listed: Vec<SmolStr>,
    for_: For<'a>,
}

/// What a name is wanted for, as far as that matters.
enum For<'a> {
    /// The wheels of a robot, mecanum wheels or not, of this radius.
    Robot(Option<bool>, Option<f64>),
    /// `turn … until`, on the robot that carries these.
    Turn(Option<&'a Robot>),
    /// The movements of an environment with these robots, if that can be said.
    Environment(Option<Vec<EntityId>>),
    /// Anything else.
    Other,
}

impl<'a> Wanted<'a> {
    fn at(place: &CursorContext<'a>, kind: EntityKind) -> Self {
        let listed = place.listed();
        let for_ = match (place.tree, kind) {
            (Some(Entity::Robot(robot)), EntityKind::Wheel) => wheels_of(place, robot, &listed),
            (Some(Entity::Movement(movement)), EntityKind::Sensor) => For::Turn(robot_of(place, movement)),
            (Some(Entity::Environment(environment)), EntityKind::Movement) => {
                let ids = |name: &pydslrep_syntax::ast::Name| {
                    place.database.resolve(place.file, EntityKind::Robot, &name.text).entity()
                };
                let robots = environment.robots.as_ref().filter(|list| !list.broken);
                For::Environment(robots.map(|list| list.names.iter().filter_map(ids).collect()))
            }
            _ => For::Other,
        };
        Self { kind, listed, for_ }
    }

    /// The only names that can be meant, where few entities say so.
    fn only(&self, place: &CursorContext<'_>) -> Option<Vec<SmolStr>> {
        let seen = |name: &&SmolStr| place.database.resolve(place.file, self.kind, name).entity().is_some();
        match &self.for_ {
            For::Turn(Some(robot)) => {
                let carried = robot.sensors.iter().flat_map(|list| &list.names).map(|name| &name.text);
                let mut names: Vec<SmolStr> =
                    carried.filter(seen).filter(|name| !self.listed.contains(name)).cloned().collect();
                let mut known = FxHashSet::default();
                names.retain(|name| known.insert(name.clone()));
                Some(names)
            }
            For::Environment(Some(robots)) => Some(self.movements_of(place, robots)),
            _ => None,
        }
    }

    /// The movements of these robots in sight, first those not listed yet.
    fn movements_of(&self, place: &CursorContext<'_>, robots: &[EntityId]) -> Vec<SmolStr> {
        let files: Vec<FileId> =
            std::iter::once(place.file).chain(place.database.imported_files(place.file)).collect();
        let mut names: Vec<(bool, SmolStr)> = Vec::new();
        for robot in robots {
            let Some(robot) = place.database.tree(*robot).and_then(Entity::name) else { continue };
            let users =
                files.iter().flat_map(|file| place.database.users(*file, EntityKind::Robot, &robot.text));
            let movements = users.filter_map(|id| match place.database.tree(*id) {
                Some(Entity::Movement(movement)) => Some((*id, &movement.name.as_ref()?.text)),
                _ => None,
            });
            let fitting = movements.filter(|(id, name)| {
                let seen = place.database.resolve(place.file, EntityKind::Movement, name).entity();
                seen == Some(*id) && self.fits(place.database, *id)
            });
            names.extend(fitting.map(|(_, name)| (self.listed.contains(name), name.clone())));
        }
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(|(_, name)| name).collect()
    }

    /// Whether an entity makes sense at the cursor.
    fn fits(&self, database: &Database, id: EntityId) -> bool {
        match (&self.for_, database.tree(id)) {
            (For::Robot(Some(mecanum), _), Some(Entity::Wheel(wheel))) => wheel.mecanum == *mecanum,
            (For::Environment(Some(robots)), Some(Entity::Movement(movement))) => {
                let robot =
                    movement.robot.as_ref().zip(database.file_of(id)).and_then(|(name, file)| {
                        database.resolve(file, EntityKind::Robot, &name.text).entity()
                    });
                robot.is_none_or(|robot| robots.contains(&robot))
            }
            _ => true,
        }
    }

    /// How unlikely an entity is: the radius of the others in the list is likely, and what is in use already is not.
    fn weight(&self, place: &CursorContext<'_>, name: &SmolStr, id: EntityId) -> u8 {
        let tree = place.database.tree(id);
        let other_radius = match (&self.for_, tree) {
            (For::Robot(_, Some(wanted)), Some(Entity::Wheel(wheel))) => {
                wheel.radius.as_ref().and_then(|radius| radius.value) != Some(*wanted)
            }
            _ => false,
        };
        // A robot without a movement is the one that gets the next.
        let is_used_once = matches!(self.kind, EntityKind::Wheel | EntityKind::Sensor | EntityKind::Robot);
        let is_used = is_used_once
            && !matches!(place.tree, Some(Entity::Environment(_)))
            && !place.database.users(place.file, self.kind, name).is_empty();
        let is_listed = self.kind == EntityKind::Movement && self.listed.contains(name);
        let is_imported = place.database.file_of(id) != Some(place.file);
        4 * u8::from(other_radius) + 2 * u8::from(is_used || is_listed) + u8::from(is_imported)
    }

    /// Whether the list at the cursor may have a name once more: a movement may run again.
    fn is_taken(&self, name: &SmolStr) -> bool {
        self.kind != EntityKind::Movement && self.listed.contains(name)
    }
}

/// All wheels of a robot are of one kind: that of those that are listed, else that of its type.
fn wheels_of<'a>(place: &CursorContext<'a>, robot: &Robot, listed: &[SmolStr]) -> For<'a> {
    let first = listed.iter().find_map(|name| Some((name, is_mecanum(place, name)?)));
    let radius = first.and_then(|(name, _)| {
        let id = place.database.resolve(place.file, EntityKind::Wheel, name).entity()?;
        match place.database.tree(id)? {
            Entity::Wheel(wheel) => wheel.radius.as_ref()?.value,
            _ => None,
        }
    });
    let by_type = match robot.drive.and_then(|clause| clause.word) {
        Some(DriveWord::Tw) => Some(false),
        Some(DriveWord::Fwh) => Some(true),
        // The article's robots of this type have mecanum wheels.
        Some(DriveWord::Fw) | None => None,
    };
    For::Robot(first.map(|(_, mecanum)| mecanum).or(by_type), radius)
}

/// The best names of a kind that the file sees.
fn in_sight(place: &CursorContext<'_>, wanted: &Wanted<'_>) -> Vec<SmolStr> {
    let mut all: Vec<&SmolStr> = place
        .database
        .names_in_sight(place.file, wanted.kind)
        .filter(|name| !wanted.is_taken(name))
        .collect();
    if all.len() > MOST {
        all.retain(|name| is_like(name, &place.typed));
    }
    let fitting = |name: &SmolStr| {
        let id = place.database.resolve(place.file, wanted.kind, name).entity()?;
        wanted.fits(place.database, id).then_some(id)
    };
    let near: FxHashSet<&SmolStr> =
        if all.len() > FEW { near(place, wanted.kind) } else { FxHashSet::default() };
    let is_weighed = |name: &&SmolStr| all.len() <= FEW || near.contains(name);
    let mut weighed: Vec<_> = all
        .iter()
        .copied()
        .filter(is_weighed)
        .filter_map(|name| Some((order(place, name), wanted.weight(place, name, fitting(name)?), name)))
        .collect();
    weighed.sort_unstable();
    weighed.dedup();
    let mut chosen: Vec<SmolStr> = weighed.iter().take(MOST).map(|(_, _, name)| (*name).clone()).collect();
    if all.len() > FEW {
        let others = all.iter().copied().filter(|name| !near.contains(name));
        let mut others: BinaryHeap<_> = others.map(|name| Reverse((order(place, name), name))).collect();
        while let Some(Reverse((_, name))) = others.pop() {
            if chosen.len() == MOST {
                break;
            }
            // An imported file may declare it as well.
            if chosen.last() != Some(name) && fitting(name).is_some() {
                chosen.push(name.clone());
            }
        }
    }
    chosen
}

/// What begins as it is typed comes before what only has the letters.
fn order(place: &CursorContext<'_>, name: &str) -> bool {
    !starts_with(name, &place.typed)
}

/// Whether a name has the typed letters in this order, small or capital: so much any editor's own filter asks.
fn is_like(name: &str, typed: &str) -> bool {
    let mut letters = name.bytes();
    typed.bytes().all(|wanted| letters.any(|letter| letter.eq_ignore_ascii_case(&wanted)))
}

/// The names of a kind that are declared near the cursor.
fn near<'a>(place: &CursorContext<'a>, kind: EntityKind) -> FxHashSet<&'a SmolStr> {
    let around = place.database.entities_around(place.file, place.word.start, NEAR);
    let trees = around.filter_map(|id| place.database.tree(id));
    trees.filter(|tree| tree.kind() == Some(kind)).filter_map(|tree| Some(&tree.name()?.text)).collect()
}

fn reference(place: &CursorContext<'_>, kind: EntityKind, name: &SmolStr) -> Option<Completion> {
    let id = place.database.resolve(place.file, kind, name).entity()?;
    let home = place.database.file_of(id)?;
    let detail = match place.database.path_for_import(place.file, home) {
        Some(path) if home != place.file => format!("{} from {path}", kind.noun()),
        _ => kind.noun().to_owned(),
    };
    Some(Completion {
        detail,
        documentation: Documentation::Of(home, kind),
        insert: as_written(name),
        ..place.item(name, CompletionKind::Reference(kind), Rank::Fitting)
    })
}

/// Names of files that are not imported yet, each with what imports its file.
fn elsewhere(place: &CursorContext<'_>, wanted: &Wanted<'_>) -> Vec<Completion> {
    let mut items = Vec::new();
    for (path, file) in paths::not_imported(place.database, place.file) {
        let names = place.database.names(file, wanted.kind).filter(|name| is_like(name, &place.typed));
        let mut names: Vec<(&SmolStr, EntityId)> = names
            .filter(|name| !wanted.is_taken(name))
            .filter_map(|name| Some((name, *place.database.definitions(file, wanted.kind, name).first()?)))
            .filter(|(_, id)| wanted.fits(place.database, *id))
            .filter(|(name, _)| place.database.resolve(place.file, wanted.kind, name).entity().is_none())
            .collect();
        if names.is_empty() {
            continue;
        }
        names.sort_unstable();
        let (span, text) = paths::import_line(place.database, place.file, &path);
        for (name, _) in names {
            if items.len() == MOST_ELSEWHERE {
                return items;
            }
            items.push(Completion {
                detail: format!("{} from {path}, adds the import", wanted.kind.noun()),
                documentation: Documentation::Of(file, wanted.kind),
                insert: as_written(name),
                imports: Some(file),
                import_edit: Some(TextEdit { span, text: text.clone() }),
                ..place.item(name, CompletionKind::Reference(wanted.kind), Rank::Elsewhere)
            });
        }
    }
    items
}
