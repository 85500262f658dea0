//! What patterns are filled with: names that exist where names are used, the next name of a series where one is declared,
//! and the numbers written last. All of it is looked for near the cursor, however long the file is.

use pydslrep_analysis::{Database, EntityId};
use pydslrep_syntax::ast::{
    Action, ActionKind, Direction, DriveWord, Entity, Movement, Robot, Turn, TurnExtent, Unit, Wheel,
};
use pydslrep_syntax::{EntityKind, Span, as_written};
use smol_str::SmolStr;

use super::names::NEAR;
use super::context::CursorContext;

/// At most so many names are put into a list for the person.
const MOST_LISTED: usize = 40;

/// What is declared near a place, and what is written there.
pub(super) struct Defaults<'a> {
    place: &'a CursorContext<'a>,
    /// Near the cursor, in the order of the text.
    near: Vec<Near<'a>>,
}

struct Near<'a> {
    id: EntityId,
    tree: &'a Entity,
    is_before: bool,
}

/// The wheels of a robot, and the type they make.
#[derive(Default)]
pub(super) struct Layout {
    pub(super) drive: &'static str,
    pub(super) names: Vec<String>,
}

/// How the last move was written.
pub(super) struct LastMove {
    pub(super) distance: Option<String>,
    pub(super) unit: Unit,
    pub(super) speed: Option<String>,
}

/// How the last turn was written.
pub(super) struct LastTurn {
    pub(super) direction: Direction,
    pub(super) angle: Option<String>,
    pub(super) is_until: bool,
}

impl<'a> Defaults<'a> {
    /// For a new entity.
    pub(super) fn for_entity(place: &'a CursorContext<'a>) -> Self {
        Self::around(place, None)
    }

    /// For what is missing of the entity at the cursor, which says nothing about itself.
    pub(super) fn for_part(place: &'a CursorContext<'a>) -> Self {
        Self::around(place, place.entity)
    }

    fn around(place: &'a CursorContext<'a>, own: Option<EntityId>) -> Self {
        let around = place.database.entities_around(place.file, place.word.start, NEAR);
        let near = around.filter(|id| own != Some(*id)).filter_map(|id| {
            let entity = place.database.entity(id)?;
            let is_before = entity.span.start < place.word.start;
            Some(Near { id, tree: entity.parse.entity.as_ref()?, is_before })
        });
        Self { place, near: near.collect() }
    }

    fn database(&self) -> &'a Database {
        self.place.database
    }

    /// Those of a kind, in the order of the text.
    fn of_kind(&self, kind: EntityKind) -> impl DoubleEndedIterator<Item = &Near<'a>> {
        self.near.iter().filter(move |near| near.tree.kind() == Some(kind))
    }

    /// The names of a kind, in the order of the text; where the file declares none, those that it imports.
    fn names(&self, kind: EntityKind) -> Vec<SmolStr> {
        let near = self.of_kind(kind).filter_map(|near| Some(near.tree.name()?.text.clone()));
        let mut names: Vec<SmolStr> = near.take(MOST_LISTED).collect();
        if names.is_empty() {
            names =
                self.database().names_in_sight(self.place.file, kind).take(MOST_LISTED).cloned().collect();
            names.sort_unstable();
        }
        names
    }

    fn last_of_kind(&self, kind: EntityKind) -> Option<&Near<'a>> {
        self.of_kind(kind).rfind(|near| near.is_before)
    }

    fn is_declared(&self, kind: EntityKind, name: &str) -> bool {
        !self.database().definitions(self.place.file, kind, &name.into()).is_empty()
    }

    fn is_used(&self, kind: EntityKind, name: &SmolStr) -> bool {
        !self.database().users(self.place.file, kind, name).is_empty()
    }

    /// A name that continues the series: `wheelR` after `wheelL`, `mov_2` after `mov_1`.
    pub(super) fn next_name(&self, kind: EntityKind) -> String {
        let last = self.last_of_kind(kind).and_then(|near| near.tree.name()).map(|name| name.text.clone());
        let is_free = |name: &String| !self.is_declared(kind, name);
        let other_side = || match kind {
            EntityKind::Wheel | EntityKind::Sensor => {
                last.iter().flat_map(|last| mirrored(last)).find(is_free)
            }
            _ => None,
        };
        let next = || {
            let (stem, number) = numbered(last.as_ref()?)?;
            (number..number + NUMBERS).map(|number| format!("{stem}{number}")).find(is_free)
        };
        let first = || {
            let first = first_name(kind);
            let others = (2..NUMBERS).map(|number| format!("{first}{number}"));
            std::iter::once(first.to_owned()).chain(others).find(is_free)
        };
        other_side().or_else(next).or_else(first).unwrap_or_default()
    }

    pub(super) fn is_last_wheel_mecanum(&self) -> bool {
        let last = self.last_of_kind(EntityKind::Wheel);
        matches!(last.map(|near| near.tree), Some(Entity::Wheel(Wheel { mecanum: true, .. })))
    }

    /// The radius of the wheel before, as written, in centimetres.
    pub(super) fn radius(&self) -> String {
        let last = self.last_of_kind(EntityKind::Wheel);
        let written = last.and_then(|near| match near.tree {
            Entity::Wheel(Wheel { radius: Some(radius), .. }) => self.written(near.id, radius.span),
            _ => None,
        });
        written.unwrap_or_else(|| "4.5".to_owned())
    }

    /// The wheels that no robot has yet, else those of the robot before, if they make a robot.
    pub(super) fn wheels(&self) -> Layout {
        let names = self.names(EntityKind::Wheel);
        let unused = names.into_iter().filter(|name| !self.is_used(EntityKind::Wheel, name)).collect();
        let of_the_last = || {
            let Some(Entity::Robot(robot)) = self.last_of_kind(EntityKind::Robot).map(|near| near.tree)
            else {
                return Vec::new();
            };
            robot.wheels.iter().flat_map(|list| &list.names).map(|name| name.text.clone()).collect()
        };
        let unused = self.layout(&left_first(unused));
        unused.or_else(|| self.layout(&of_the_last())).unwrap_or(Layout { drive: "tw", names: Vec::new() })
    }

    fn layout(&self, names: &[SmolStr]) -> Option<Layout> {
        let mecanum: Option<Vec<bool>> =
            names.iter().map(|name| super::keywords::is_mecanum(self.place, name)).collect();
        let drive = match mecanum?[..] {
            [false, false] => DriveWord::Tw,
            [false, false, false, false] => DriveWord::Fw,
            [true, true, true, true] => DriveWord::Fwh,
            _ => return None,
        };
        let names = names.iter().map(|name| as_written(name)).collect();
        Some(Layout { drive: drive.spelling(), names })
    }

    /// The sensors that no robot has yet.
    pub(super) fn sensors(&self) -> Vec<String> {
        let names = self.names(EntityKind::Sensor);
        let unused = names.iter().filter(|name| !self.is_used(EntityKind::Sensor, name));
        unused.map(|name| as_written(name)).collect()
    }

    /// The first robot that nothing moves yet, else the one that was moved last.
    pub(super) fn robot_to_move(&self) -> Option<String> {
        let names = self.names(EntityKind::Robot);
        let is_idle = |name: &&SmolStr| !self.is_used(EntityKind::Robot, name);
        let last = self.last_of_kind(EntityKind::Movement).and_then(|near| match near.tree {
            Entity::Movement(Movement { robot: Some(robot), .. }) => Some(&robot.text),
            _ => None,
        });
        names.iter().find(is_idle).or(last).or(names.last()).map(|name| as_written(name))
    }

    /// The robots that have movements, else all.
    pub(super) fn robots_to_run(&self) -> Vec<String> {
        let names = self.names(EntityKind::Robot);
        let moved = |name: &&SmolStr| self.is_used(EntityKind::Robot, name);
        let mut found: Vec<&SmolStr> = names.iter().filter(moved).collect();
        if found.is_empty() {
            found = names.iter().collect();
        }
        found.into_iter().map(|name| as_written(name)).collect()
    }

    /// The movements of these robots, in the order of the text.
    pub(super) fn moves_of(&self, robots: &[String]) -> Vec<String> {
        let names = self.of_kind(EntityKind::Movement).filter_map(|near| match near.tree {
            Entity::Movement(Movement { name: Some(name), robot: Some(robot), .. }) => {
                robots.contains(&as_written(&robot.text)).then(|| as_written(&name.text))
            }
            _ => None,
        });
        names.take(MOST_LISTED).collect()
    }

    /// Whether the action before the cursor is a move.
    pub(super) fn follows_a_move(&self) -> bool {
        let actions = self.place.movement().map_or(&[][..], |movement| &movement.actions);
        let before = actions.iter().rfind(|action| self.is_before(action));
        matches!(before.map(|action| &action.kind), Some(ActionKind::Move(_)))
    }

    fn is_before(&self, action: &Action) -> bool {
        action.span.end <= self.place.word.start.saturating_sub(self.place.start)
    }

    /// The last thing that `find` finds in an action before the cursor, in this movement or in one before it.
    fn last_action<T>(
        &self,
        find: impl Fn(&Action, &dyn Fn(Span) -> Option<String>) -> Option<T>,
    ) -> Option<T> {
        let own = self.place.movement().zip(self.place.entity);
        let own = own.and_then(|(movement, id)| {
            let mut before = movement.actions.iter().rev().filter(|action| self.is_before(action));
            before.find_map(|action| find(action, &|span| self.written(id, span)))
        });
        own.or_else(|| {
            let mut before = self.of_kind(EntityKind::Movement).rev().filter(|near| near.is_before);
            before.find_map(|near| match near.tree {
                Entity::Movement(movement) => {
                    let mut actions = movement.actions.iter().rev();
                    actions.find_map(|action| find(action, &|span| self.written(near.id, span)))
                }
                _ => None,
            })
        })
    }

    pub(super) fn last_move(&self) -> LastMove {
        let last = self.last_action(|action, written| {
            let ActionKind::Move(move_) = &action.kind else { return None };
            Some(LastMove {
                distance: Some(written(move_.distance.as_ref()?.span)?),
                unit: move_.unit?.0,
                speed: move_.speed.as_ref().and_then(|speed| written(speed.value.as_ref()?.span)),
            })
        });
        last.unwrap_or(LastMove { distance: None, unit: Unit::Meters, speed: None })
    }

    /// The speed written last, else the one where none is written; in centimetres per second.
    pub(super) fn speed(&self) -> String {
        let last = self.last_action(|action, written| match &action.kind {
            ActionKind::Move(move_) => written(move_.speed.as_ref()?.value.as_ref()?.span),
            _ => None,
        });
        last.unwrap_or_else(|| format!("{:?}", self.place.speed))
    }

    pub(super) fn last_turn(&self) -> LastTurn {
        let last = self.last_action(|action, written| {
            let ActionKind::Turn(Turn { direction: Some((direction, _)), extent }) = &action.kind else {
                return None;
            };
            let angle = match extent {
                Some(TurnExtent::Angle(angle)) => written(angle.span),
                _ => None,
            };
            let is_until = matches!(extent, Some(TurnExtent::Until(_)));
            Some(LastTurn { direction: *direction, angle, is_until })
        });
        last.unwrap_or(LastTurn { direction: Direction::Left, angle: None, is_until: false })
    }

    /// The sensors of the last `until`, as far as the robot carries them, else all that it carries.
    pub(super) fn sensors_to_wait_for(&self) -> Vec<String> {
        let robot = self.place.movement().and_then(|movement| robot_of(self.place, movement));
        let carried: Vec<&SmolStr> = robot
            .and_then(|robot| robot.sensors.as_ref())
            .map_or_else(Vec::new, |list| list.names.iter().map(|name| &name.text).collect());
        let last = self.last_action(|action, _| {
            let names: Vec<SmolStr> = action.until()?.names.iter().map(|name| name.text.clone()).collect();
            names.iter().all(|name| carried.contains(&name)).then_some(names)
        });
        match last.filter(|names| !names.is_empty()) {
            Some(names) => names.iter().map(|name| as_written(name)).collect(),
            None => carried.into_iter().map(|name| as_written(name)).collect(),
        }
    }

    fn written(&self, id: EntityId, span: Span) -> Option<String> {
        let entity = self.database().entity(id)?;
        Some(self.database().slice(entity.file, span.shifted(entity.span.start)))
    }
}

/// The robot of a movement, unless it cannot be said what it carries.
pub(super) fn robot_of<'a>(place: &CursorContext<'a>, movement: &Movement) -> Option<&'a Robot> {
    let name = &movement.robot.as_ref()?.text;
    let id = place.database.resolve(place.file, EntityKind::Robot, name).entity()?;
    match place.database.tree(id)? {
        Entity::Robot(robot) if robot.sensors.is_some() || robot.wheels.is_some() => Some(robot),
        _ => None,
    }
}

/// Of more numbers, whoever is typing is better at thinking of a name.
const NUMBERS: u32 = 1_000;

/// What the first of its kind is called.
fn first_name(kind: EntityKind) -> &'static str {
    match kind {
        EntityKind::Wheel => "wheelL",
        EntityKind::Sensor => "front",
        EntityKind::Ip => "lab",
        EntityKind::Robot => "rover",
        EntityKind::Movement => "patrol",
        EntityKind::Environment => "area",
    }
}

/// What a name begins with, and the number after that at its end.
fn numbered(name: &str) -> Option<(&str, u32)> {
    let stem = name.trim_end_matches(|character: char| character.is_ascii_digit());
    Some((stem, name[stem.len()..].parse::<u32>().ok()?.checked_add(1)?))
}

const SIDES: [(&str, &str); 3] = [("left", "right"), ("Left", "Right"), ("L", "R")];

/// The names with one `from` in them replaced by `to`, the last one first.
fn exchanged(name: &str, from: &str, to: &str) -> Vec<String> {
    let places = name.rmatch_indices(from);
    places.map(|(at, _)| format!("{}{to}{}", &name[..at], &name[at + from.len()..])).collect()
}

/// The names for the other side, such as `wheelR0` for `wheelL0`.
fn mirrored(name: &str) -> Vec<String> {
    let both = |(left, right)| [exchanged(name, left, right), exchanged(name, right, left)];
    SIDES.into_iter().flat_map(both).flatten().collect()
}

/// Wheels in the order of the language: those whose counterpart on the left is among them come last.
fn left_first(names: Vec<SmolStr>) -> Vec<SmolStr> {
    let has_left = |name: &SmolStr| {
        let mut left = SIDES.into_iter().flat_map(|(left, right)| exchanged(name, right, left));
        left.any(|left| names.iter().any(|other| *other == left))
    };
    let is_right: Vec<bool> = names.iter().map(has_left).collect();
    let mut sides: Vec<(bool, SmolStr)> = is_right.into_iter().zip(names).collect();
    sides.sort_by_key(|(is_right, _)| *is_right);
    sides.into_iter().map(|(_, name)| name).collect()
}

/// The wheels, robots or movements that a list of this kind in the entity at the cursor probably has.
pub(super) fn likely_list(place: &CursorContext<'_>, kind: EntityKind) -> String {
    let defaults = Defaults::for_part(place);
    match (place.tree, kind) {
        (Some(Entity::Robot(_)), EntityKind::Wheel) => defaults.wheels().names.join(" "),
        (Some(Entity::Robot(_)), EntityKind::Sensor) => defaults.sensors().join(", "),
        (Some(Entity::Movement(_)), EntityKind::Sensor) => defaults.sensors_to_wait_for().join(", "),
        (Some(Entity::Environment(_)), EntityKind::Robot) => defaults.robots_to_run().join(" "),
        (Some(Entity::Environment(environment)), EntityKind::Movement) => {
            let robots = environment.robots.iter().flat_map(|list| &list.names);
            let robots: Vec<String> = robots.map(|name| as_written(&name.text)).collect();
            defaults.moves_of(&robots).join(" ")
        }
        _ => String::new(),
    }
}
