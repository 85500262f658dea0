//! Defaults for placeholders: existing names where names are used, the next name of a series where one is declared, and
//! the numbers written last. Only entities near the cursor are considered, so the cost does not depend on the file's
//! length.

use pydslrep_analysis::{Database, EntityId};
use pydslrep_syntax::ast::{
    Action, ActionKind, Direction, Drive, Entity, Move, Movement, Robot, Turn, Unit, Wheel, nested,
};
use pydslrep_syntax::{EntityKind, Span, TokenKind, escape};
use smol_str::SmolStr;

use super::context::CompletionContext;
use super::names::NEARBY_ENTITIES;
use crate::cursor::{is_mecanum, named_robot};

/// The maximum number of names in a suggested list.
const MAX_LISTED: usize = 40;

/// The declarations near the cursor.
pub(super) struct Defaults<'a> {
    context: &'a CompletionContext<'a>,
    /// In text order.
    near: Vec<Near<'a>>,
}

struct Near<'a> {
    id: EntityId,
    tree: &'a Entity,
    is_before: bool,
}

/// The wheels of a robot, and the drive type that they imply.
#[derive(Default)]
pub(super) struct Layout {
    pub(super) drive: &'static str,
    pub(super) names: Vec<String>,
}

/// The form of the last `move`.
pub(super) struct LastMove {
    pub(super) distance: Option<String>,
    pub(super) unit: Unit,
    pub(super) speed: Option<String>,
    /// True if it has a condition and no distance.
    pub(super) is_until: bool,
}

/// The form of the last `turn`.
pub(super) struct LastTurn {
    pub(super) direction: Direction,
    pub(super) angle: Option<String>,
    pub(super) is_until: bool,
    pub(super) is_on_circle: bool,
}

impl<'a> Defaults<'a> {
    /// For a new entity.
    pub(super) fn for_entity(context: &'a CompletionContext<'a>) -> Self {
        Self::around(context, None)
    }

    /// For a missing part of the entity at the cursor, which is not considered itself.
    pub(super) fn for_part(context: &'a CompletionContext<'a>) -> Self {
        Self::around(context, context.entity)
    }

    fn around(context: &'a CompletionContext<'a>, own: Option<EntityId>) -> Self {
        let around = context.database.entities_around(context.file, context.word.start, NEARBY_ENTITIES);
        let near = around.filter(|id| own != Some(*id)).filter_map(|id| {
            let entity = context.database.entity(id)?;
            let is_before = entity.span.start < context.word.start;
            Some(Near { id, tree: entity.parse.entity.as_ref()?, is_before })
        });
        Self { context, near: near.collect() }
    }

    fn database(&self) -> &'a Database {
        self.context.database
    }

    /// The nearby entities of a kind, in text order.
    fn of_kind(&self, kind: EntityKind) -> impl DoubleEndedIterator<Item = &Near<'a>> {
        self.near.iter().filter(move |near| near.tree.kind() == Some(kind))
    }

    /// The names of a kind in text order; if the file declares none, the imported ones.
    fn names(&self, kind: EntityKind) -> Vec<SmolStr> {
        let near = self.of_kind(kind).filter_map(|near| Some(near.tree.name()?.text.clone()));
        let mut names: Vec<SmolStr> = near.take(MAX_LISTED).collect();
        if names.is_empty() {
            names =
                self.database().names_in_sight(self.context.file, kind).take(MAX_LISTED).cloned().collect();
            names.sort_unstable();
        }
        names
    }

    fn last_of_kind(&self, kind: EntityKind) -> Option<&Near<'a>> {
        self.of_kind(kind).rfind(|near| near.is_before)
    }

    fn is_declared(&self, kind: EntityKind, name: &str) -> bool {
        !self.database().definitions(self.context.file, kind, &name.into()).is_empty()
    }

    fn is_used(&self, kind: EntityKind, name: &SmolStr) -> bool {
        !self.database().users(self.context.file, kind, name).is_empty()
    }

    /// The next name of a series: `wheelR` after `wheelL`, `mov_2` after `mov_1`.
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
            (number..number + MAX_NUMBERS).map(|number| format!("{stem}{number}")).find(is_free)
        };
        let first = || {
            let first = first_name(kind);
            let others = (2..MAX_NUMBERS).map(|number| format!("{first}{number}"));
            std::iter::once(first.to_owned()).chain(others).find(is_free)
        };
        other_side().or_else(next).or_else(first).unwrap_or_default()
    }

    pub(super) fn is_last_wheel_mecanum(&self) -> bool {
        let last = self.last_of_kind(EntityKind::Wheel);
        matches!(last.map(|near| near.tree), Some(Entity::Wheel(Wheel { mecanum: true, .. })))
    }

    /// The radius of the previous wheel as written, in centimetres.
    pub(super) fn radius(&self) -> String {
        let last = self.last_of_kind(EntityKind::Wheel);
        let written = last.and_then(|near| match near.tree {
            Entity::Wheel(Wheel { radius: Some(radius), .. }) => self.written(near.id, radius.span),
            _ => None,
        });
        written.unwrap_or_else(|| "4.5".to_owned())
    }

    /// The wheels that no robot uses yet, or those of the previous robot; only if they form a valid robot.
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
        unused
            .or_else(|| self.layout(&of_the_last()))
            .unwrap_or(Layout { drive: Drive::TwoWheel.word(), names: Vec::new() })
    }

    fn layout(&self, names: &[SmolStr]) -> Option<Layout> {
        let mecanum: Option<Vec<bool>> =
            names.iter().map(|name| is_mecanum(self.database(), self.context.file, name)).collect();
        let drive = Drive::from_wheels(&mecanum?)?;
        let names = names.iter().map(|name| escape(name)).collect();
        Some(Layout { drive: drive.word(), names })
    }

    /// The sensors that no robot uses yet.
    pub(super) fn sensors(&self) -> Vec<String> {
        let names = self.names(EntityKind::Sensor);
        let unused = names.iter().filter(|name| !self.is_used(EntityKind::Sensor, name));
        unused.map(|name| escape(name)).collect()
    }

    /// The first robot without a movement, or the one of the last movement.
    pub(super) fn robot_to_move(&self) -> Option<String> {
        let names = self.names(EntityKind::Robot);
        let is_idle = |name: &&SmolStr| !self.is_used(EntityKind::Robot, name);
        let last = self.last_of_kind(EntityKind::Movement).and_then(|near| match near.tree {
            Entity::Movement(Movement { robot: Some(robot), .. }) => Some(&robot.text),
            _ => None,
        });
        names.iter().find(is_idle).or(last).or(names.last()).map(|name| escape(name))
    }

    /// The robots that have movements, or all.
    pub(super) fn robots_to_run(&self) -> Vec<String> {
        let names = self.names(EntityKind::Robot);
        let moved = |name: &&SmolStr| self.is_used(EntityKind::Robot, name);
        let mut found: Vec<&SmolStr> = names.iter().filter(moved).collect();
        if found.is_empty() {
            found = names.iter().collect();
        }
        found.into_iter().map(|name| escape(name)).collect()
    }

    /// The movements of these robots in text order.
    pub(super) fn moves_of(&self, robots: &[String]) -> Vec<String> {
        let names = self.of_kind(EntityKind::Movement).filter_map(|near| match near.tree {
            Entity::Movement(Movement { name: Some(name), robot: Some(robot), .. }) => {
                robots.contains(&escape(&robot.text)).then(|| escape(&name.text))
            }
            _ => None,
        });
        names.take(MAX_LISTED).collect()
    }

    /// Returns whether the action before the cursor is a `move`.
    pub(super) fn follows_a_move(&self) -> bool {
        let actions = self.context.movement().map_or(&[][..], |movement| &movement.actions);
        let before = nested(actions).filter(|action| self.is_before(action)).last();
        matches!(before.map(|action| &action.kind), Some(ActionKind::Move(_)))
    }

    fn is_before(&self, action: &Action) -> bool {
        action.span.end <= self.context.word.start.saturating_sub(self.context.start)
    }

    /// The last result of `find` among the actions before the cursor, in this movement and the ones before it.
    fn last_action<T>(
        &self,
        find: impl Fn(&Action, &dyn Fn(Span) -> Option<String>) -> Option<T>,
    ) -> Option<T> {
        let last = |id, actions: Vec<&Action>| {
            actions.into_iter().rev().find_map(|action| find(action, &|span| self.written(id, span)))
        };
        let own = self.context.movement().zip(self.context.entity).and_then(|(movement, id)| {
            last(id, movement.all_actions().filter(|action| self.is_before(action)).collect())
        });
        own.or_else(|| {
            let mut before = self.of_kind(EntityKind::Movement).rev().filter(|near| near.is_before);
            before.find_map(|near| match near.tree {
                Entity::Movement(movement) => last(near.id, movement.all_actions().collect()),
                _ => None,
            })
        })
    }

    pub(super) fn last_move(&self) -> LastMove {
        let last = self.last_action(|action, written| {
            let ActionKind::Move(move_) = &action.kind else { return None };
            let is_until = move_.distance.is_none() && move_.until.is_some();
            if !is_until && (move_.distance.is_none() || move_.unit.is_none()) {
                return None;
            }
            Some(LastMove {
                distance: move_.distance.as_ref().and_then(|distance| written(distance.span)),
                unit: move_.unit.map_or(Unit::Meters, |(unit, _)| unit),
                is_until,
                speed: move_.speed.as_ref().and_then(|speed| written(speed.value.as_ref()?.span)),
            })
        });
        last.unwrap_or(LastMove { distance: None, unit: Unit::Meters, speed: None, is_until: false })
    }

    /// The last written speed, or the default; in centimetres per second.
    pub(super) fn speed(&self) -> String {
        let last = self.last_action(|action, written| match &action.kind {
            ActionKind::Move(Move { speed, .. }) | ActionKind::Turn(Turn { speed, .. }) => {
                written(speed.as_ref()?.value.as_ref()?.span)
            }
            _ => None,
        });
        last.unwrap_or_else(|| format!("{:?}", self.context.speed))
    }

    pub(super) fn last_turn(&self) -> LastTurn {
        let last = self.last_action(|action, written| {
            let ActionKind::Turn(turn) = &action.kind else { return None };
            let Turn { direction: Some((direction, _)), angle, circle, .. } = turn else { return None };
            let is_until = turn.until.is_some() && turn.is_of_article();
            let is_on_circle = circle.is_some();
            let angle = angle.as_ref().and_then(|angle| written(angle.span));
            Some(LastTurn { direction: *direction, angle, is_until, is_on_circle })
        });
        last.unwrap_or(LastTurn {
            direction: Direction::Left,
            angle: None,
            is_until: false,
            is_on_circle: false,
        })
    }

    /// The radius of the last circle as written, and its unit.
    pub(super) fn last_radius(&self) -> (String, &'static str) {
        let last = self.last_action(|action, written| {
            let ActionKind::Turn(Turn { circle: Some(circle), .. }) = &action.kind else { return None };
            let unit = match circle.unit?.0 {
                Unit::Meters => TokenKind::Meters,
                Unit::Centimeters => TokenKind::Centimeters,
            };
            Some((written(circle.radius.as_ref()?.span)?, unit.spelling()?))
        });
        last.unwrap_or_else(|| ("1.0".to_owned(), TokenKind::Meters.spelling().unwrap_or_default()))
    }

    /// Returns the number of the last action that begins with a keyword, as written.
    pub(super) fn last_number(&self, keyword: TokenKind) -> Option<String> {
        self.last_action(|action, written| {
            let number = (action.keyword() == keyword).then(|| action.numbers().next())??;
            written(number.span)
        })
    }

    /// The sensors of the last `until` if the robot has all of them, or all sensors of the robot.
    pub(super) fn sensors_to_wait_for(&self) -> Vec<String> {
        let robot = self.context.movement().and_then(|movement| robot_of(self.context, movement));
        let carried: Vec<&SmolStr> = robot
            .and_then(|robot| robot.sensors.as_ref())
            .map_or_else(Vec::new, |list| list.names.iter().map(|name| &name.text).collect());
        let last = self.last_action(|action, _| {
            let names: Vec<SmolStr> =
                action.conditions().next()?.sensors.names.iter().map(|name| name.text.clone()).collect();
            names.iter().all(|name| carried.contains(&name)).then_some(names)
        });
        match last.filter(|names| !names.is_empty()) {
            Some(names) => names.iter().map(|name| escape(name)).collect(),
            None => carried.into_iter().map(|name| escape(name)).collect(),
        }
    }

    fn written(&self, id: EntityId, span: Span) -> Option<String> {
        let entity = self.database().entity(id)?;
        Some(self.database().slice(entity.file, span.shifted(entity.span.start)))
    }
}

/// The robot of a movement, unless its parts are unknown.
pub(super) fn robot_of<'a>(context: &CompletionContext<'a>, movement: &Movement) -> Option<&'a Robot> {
    let id = named_robot(context.database, context.file, movement)?;
    match context.database.tree(id)? {
        Entity::Robot(robot) if robot.sensors.is_some() || robot.wheels.is_some() => Some(robot),
        _ => None,
    }
}

/// The largest number tried for a free name.
const MAX_NUMBERS: u32 = 1_000;

/// The suggested name for the first entity of a kind.
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

/// A name without its trailing number, and the next number.
fn numbered(name: &str) -> Option<(&str, u32)> {
    let stem = name.trim_end_matches(|character: char| character.is_ascii_digit());
    Some((stem, name[stem.len()..].parse::<u32>().ok()?.checked_add(1)?))
}

const SIDES: [(&str, &str); 3] = [("left", "right"), ("Left", "Right"), ("L", "R")];

/// The names with one occurrence of `from` replaced by `to`, the last occurrence first.
fn replace_each(name: &str, from: &str, to: &str) -> Vec<String> {
    let places = name.rmatch_indices(from);
    places.map(|(at, _)| format!("{}{to}{}", &name[..at], &name[at + from.len()..])).collect()
}

/// The candidate names for the other side, such as `wheelR0` for `wheelL0`.
fn mirrored(name: &str) -> Vec<String> {
    let both = |(left, right)| [replace_each(name, left, right), replace_each(name, right, left)];
    SIDES.into_iter().flat_map(both).flatten().collect()
}

/// Wheels in the order of the language: the left ones first, then those with a left counterpart.
fn left_first(names: Vec<SmolStr>) -> Vec<SmolStr> {
    let has_left = |name: &SmolStr| {
        let mut left = SIDES.into_iter().flat_map(|(left, right)| replace_each(name, right, left));
        left.any(|left| names.iter().any(|other| *other == left))
    };
    let is_right: Vec<bool> = names.iter().map(has_left).collect();
    let mut sides: Vec<(bool, SmolStr)> = is_right.into_iter().zip(names).collect();
    sides.sort_by_key(|(is_right, _)| *is_right);
    sides.into_iter().map(|(_, name)| name).collect()
}

/// The likely content of a list of this kind in the entity at the cursor.
pub(super) fn likely_list(context: &CompletionContext<'_>, kind: EntityKind) -> String {
    let defaults = Defaults::for_part(context);
    match (context.tree, kind) {
        (Some(Entity::Robot(_)), EntityKind::Wheel) => defaults.wheels().names.join(" "),
        (Some(Entity::Robot(_)), EntityKind::Sensor) => defaults.sensors().join(", "),
        (Some(Entity::Movement(_)), EntityKind::Sensor) => defaults.sensors_to_wait_for().join(", "),
        (Some(Entity::Environment(_)), EntityKind::Robot) => defaults.robots_to_run().join(" "),
        (Some(Entity::Environment(environment)), EntityKind::Movement) => {
            let robots = environment.robots.iter().flat_map(|list| &list.names);
            let robots: Vec<String> = robots.map(|name| escape(&name.text)).collect();
            defaults.moves_of(&robots).join(" ")
        }
        _ => String::new(),
    }
}
