//! From an environment's declaration to everything it runs, with every name resolved.

use std::hash::Hash;

use pydslrep_kinematics::Drive;
use pydslrep_scene::{Scene, SensorKind};
use pydslrep_syntax::ast::{self, ActionKind as Statement, Entity, Name};
use pydslrep_syntax::{EntityKind, Span, TokenKind};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::defaults::{DEFAULT_ANGLE, drive, speed};
use crate::environment::{
    Branch, COUNTS, Circle, Condition, Environment, Movement, Objects, ResolvedAction, ResolvedActionKind,
    Robot, Ros2, Sensor, Source, Wheel,
};
use crate::{EntityId, EntityRef, Facts, FileId, check_cancelled, plan};

impl Facts {
    /// The environments of a file in the order of the text: each with its name and where it is.
    pub fn environments(&self, file: FileId) -> Vec<(EntityId, Name)> {
        let environments = self.entities(file).filter_map(|entity| match &entity.parse.entity {
            Some(Entity::Environment(environment)) => {
                let name = environment.name.clone()?;
                Some((entity.id, Name { span: name.span.shifted(entity.span.start), ..name }))
            }
            _ => None,
        });
        environments.collect()
    }

    /// The entities that one is made of: itself, and all that it names, near or far.
    pub(crate) fn reached_from(&self, id: EntityId) -> Vec<EntityId> {
        let mut reached = vec![id];
        let mut seen = FxHashSet::from_iter([id]);
        let mut next = 0;
        while let Some(&id) = reached.get(next) {
            next += 1;
            let (Some(file), Some(tree)) = (self.file_of(id), self.tree(id)) else { continue };
            for (kind, name) in tree.references() {
                if let Some(id) = self.resolve(file, kind, &name.text).entity()
                    && seen.insert(id)
                {
                    reached.push(id);
                }
            }
        }
        reached
    }

    /// An environment with every name resolved; `None` where something that it needs is missing or broken.
    pub(crate) fn resolved_environment(&self, id: EntityId) -> Option<Environment> {
        Parts { facts: self, file: self.file_of(id) }.environment(id)
    }

    /// The entities of the movements of an environment, in its order.
    pub(crate) fn movements_of(&self, id: EntityId) -> Option<Vec<EntityId>> {
        let Entity::Environment(tree) = self.tree(id)? else { return None };
        let parts = Parts { facts: self, file: self.file_of(id) };
        let listed = tree.movements.as_ref().map_or(&[][..], |list| &list.names);
        parts.with_done(&without_repeats(&parts.resolve_all(id, EntityKind::Movement, listed)?))
    }

    /// The robots of an environment on an empty floor, whatever is wrong with its movements; `None` where a robot is
    /// missing or broken.
    pub fn floor(&self, id: EntityId) -> Option<Scene> {
        let parts = Parts { facts: self, file: self.file_of(id) };
        let Entity::Environment(tree) = self.tree(id)? else { return None };
        let robots = parts.resolve_all(id, EntityKind::Robot, &tree.robots.as_ref()?.names)?;
        let robots =
            without_repeats(&robots).into_iter().map(|id| parts.robot(id)).collect::<Option<Vec<_>>>()?;
        Some(plan::floor(&robots))
    }

    /// A robot with all its parts; `None` where one is missing or broken.
    pub fn robot(&self, id: EntityId) -> Option<Robot> {
        Parts { facts: self, file: self.file_of(id) }.robot(id)
    }

    /// A movement after those that it does, with its robot, whose index in all of them is 0; `None` where something is
    /// missing or broken.
    pub fn movement(&self, id: EntityId) -> Option<(Robot, Vec<Movement>)> {
        self.movement_start(id, usize::MAX).filter(|(_, movements)| {
            let Some(Entity::Movement(tree)) = self.tree(id) else { return false };
            movements.last().is_some_and(|movement| movement.actions.len() == tree.actions.len())
        })
    }

    /// The same with the first `count` actions at most, and of those only the ones before the first that is broken: what
    /// is known of a movement while it is being written.
    pub fn movement_start(&self, id: EntityId, count: usize) -> Option<(Robot, Vec<Movement>)> {
        let parts = Parts { facts: self, file: self.file_of(id) };
        let Entity::Movement(tree) = self.tree(id)? else { return None };
        let robot = parts.robot(parts.resolve(id, EntityKind::Robot, tree.robot.as_ref()?)?)?;
        let entity = self.entity(id)?;
        let mut ids = parts.with_done(&[id])?;
        ids.pop();
        let places = indices_of(&ids);
        let done = ids.iter().map(|done| parts.movement(*done, |_| Some((0, &robot)), &places));
        let mut movements: Vec<Movement> = done.collect::<Option<_>>()?;
        let mut statements =
            Statements { parts: &parts, entity, sensors: &robot.sensors, places: &places, number: 0 };
        let actions = tree.actions.iter().take(count).map_while(|action| statements.action(action)).collect();
        let name = tree.name.as_ref().map_or_else(String::new, |name| name.text.to_string());
        let source = parts.source(&self.entity(id)?, 0)?;
        movements.push(Movement { name, robot: 0, actions, source });
        Some((robot, movements))
    }

    /// The robot that a movement names; `None` where it is missing or broken.
    pub fn robot_of(&self, movement: EntityId) -> Option<Robot> {
        let parts = Parts { facts: self, file: self.file_of(movement) };
        let Entity::Movement(tree) = self.tree(movement)? else { return None };
        parts.robot(parts.resolve(movement, EntityKind::Robot, tree.robot.as_ref()?)?)
    }

    /// Returns the statements of a movement known so far, driven by this robot, while it is being written.
    pub fn known_statements(&self, movement: EntityId, robot: Option<&Robot>) -> Option<KnownStatements<'_>> {
        let parts = Parts { facts: self, file: self.file_of(movement) };
        let Entity::Movement(tree) = self.tree(movement)? else { return None };
        let entity = self.entity(movement)?;
        let done = robot.map(|robot| parts.known_done(movement, tree, robot)).unwrap_or_default();
        let places = indices_of(&done);
        let sensors = robot.map(|robot| robot.sensors.clone()).unwrap_or_default();
        let done = robot.and_then(|robot| self.done_movements(&done, robot)).unwrap_or_default();
        Some(KnownStatements { parts, entity, sensors, places, done })
    }

    /// Movements of one robot, each after those that it does; `None` where something is missing or broken.
    fn done_movements(&self, ids: &[EntityId], robot: &Robot) -> Option<Vec<Movement>> {
        let places = indices_of(ids);
        let movement = |id: &EntityId| {
            let parts = Parts { facts: self, file: self.file_of(*id) };
            parts.movement(*id, |_| Some((0, robot)), &places)
        };
        ids.iter().map(movement).collect()
    }

    /// An action as the program writes it, on one line, without comments; its place counts from its entity's start.
    pub fn action_text(&self, entity: &EntityRef<'_>, action: Span) -> String {
        let tokens = &entity.parse.tokens;
        let first = tokens.partition_point(|(_, place)| place.start < action.start);
        let within = tokens.iter().skip(first).take_while(|(_, place)| place.end <= action.end);
        let mut text = String::new();
        for (token, place) in within.filter(|(token, _)| !token.is_comment()) {
            if !text.is_empty() && *token != TokenKind::Comma {
                text.push(' ');
            }
            text += &self.slice(entity.file, place.shifted(entity.span.start));
        }
        text
    }

    /// The same of an action without its blocks: [`ResolvedAction::text`].
    pub fn action_head(&self, entity: &EntityRef<'_>, action: &ast::Action) -> String {
        self.action_text(entity, head(action.span, action.blocks().next()))
    }

    /// The wheel layout of a robot: its type, else what its wheels make it. Four mecanum wheels are never `fw`.
    pub fn drive(&self, robot: EntityId) -> Option<Drive> {
        let file = self.file_of(robot)?;
        let Entity::Robot(tree) = self.tree(robot)? else { return None };
        drive(tree, |name| match self.tree(self.resolve(file, EntityKind::Wheel, &name.text).entity()?)? {
            Entity::Wheel(wheel) => Some(wheel),
            _ => None,
        })
    }
}

/// Builds the parts of an environment; `None` wherever one is missing or broken.
struct Parts<'a> {
    facts: &'a Facts,
    /// The environment's own file.
    file: Option<FileId>,
}

impl<'a> Parts<'a> {
    fn environment(&self, id: EntityId) -> Option<Environment> {
        let Entity::Environment(tree) = self.facts.tree(id)? else { return None };
        let name = tree.name.as_ref()?;
        let host = optional(tree.ip.as_ref(), |clause| self.host(id, clause.name.as_ref()?))?;
        let robot_ids = self.resolve_all(id, EntityKind::Robot, &tree.robots.as_ref()?.names)?;
        let robot_ids = without_repeats(&robot_ids);
        let listed = tree.movements.as_ref().map_or(&[][..], |list| &list.names);
        let runs = self.resolve_all(id, EntityKind::Movement, listed)?;
        let movement_ids = self.with_done(&without_repeats(&runs))?;
        let places = indices_of(&movement_ids);
        let robots = robot_ids.iter().map(|id| self.robot(*id)).collect::<Option<Vec<_>>>()?;
        let robot_places = indices_of(&robot_ids);
        let robot = |id| robot_places.get(&id).map(|&index| (index, &robots[index]));
        Some(Environment {
            name: name.text.to_string(),
            script: self.facts.script_name(self.file?, &name.text)?.0.stem,
            host,
            movements: movement_ids
                .iter()
                .map(|id| self.movement(*id, robot, &places))
                .collect::<Option<_>>()?,
            schedule: self.schedule(&runs, &places),
            source: self.source(&self.facts.entity(id)?, 0)?,
            robots,
        })
    }

    /// Movements, each after those that it does; `None` where one is unknown, or does itself.
    fn with_done(&self, movements: &[EntityId]) -> Option<Vec<EntityId>> {
        let mut ended: FxHashSet<EntityId> = FxHashSet::default();
        let mut order = Vec::new();
        for &movement in movements {
            // The movements that are being looked at, each with what is left of those that it does.
            let mut open = Vec::new();
            if !ended.contains(&movement) {
                open.push((movement, self.done_by(movement)?));
            }
            while let Some((id, left)) = open.last_mut() {
                let (id, Some(next)) = (*id, left.pop()) else {
                    ended.insert(*id);
                    order.push(*id);
                    open.pop();
                    continue;
                };
                if id == next || open.iter().any(|(other, _)| *other == next) {
                    return None;
                }
                if !ended.contains(&next) {
                    open.push((next, self.done_by(next)?));
                }
            }
        }
        Some(order)
    }

    /// Returns the movements that a movement does, of those that are complete and sound: each after those that it does
    /// itself.
    fn known_done(&self, movement: EntityId, tree: &ast::Movement, robot: &Robot) -> Vec<EntityId> {
        let names = tree.all_actions().filter_map(ast::Action::done);
        let named: Vec<EntityId> =
            names.filter_map(|name| self.resolve(movement, EntityKind::Movement, name)).collect();
        let is_known = |id: &EntityId| {
            let done = self.with_done(&[*id]).filter(|done| !done.contains(&movement));
            done.and_then(|done| self.facts.done_movements(&done, robot)).is_some()
        };
        let known: Vec<EntityId> = without_repeats(&named).into_iter().filter(is_known).collect();
        self.with_done(&known).unwrap_or_default()
    }

    /// The movements that one does, the first one last.
    fn done_by(&self, movement: EntityId) -> Option<Vec<EntityId>> {
        let Entity::Movement(tree) = self.facts.tree(movement)? else { return None };
        let names = tree.all_actions().filter_map(ast::Action::done);
        let mut done: Vec<EntityId> =
            names.map(|name| self.resolve(movement, EntityKind::Movement, name)).collect::<Option<_>>()?;
        done.reverse();
        Some(done)
    }

    fn host(&self, environment: EntityId, name: &Name) -> Option<std::net::Ipv4Addr> {
        let id = self.resolve(environment, EntityKind::Ip, name)?;
        let Entity::Ip(ip) = self.facts.tree(id)? else { return None };
        let octets: Option<Vec<u8>> =
            ip.address.as_ref()?.0.split('.').map(|octet| octet.parse().ok()).collect();
        let octets: [u8; 4] = octets?.try_into().ok()?;
        Some(octets.into())
    }

    /// Maximal runs of parallel movements, each a group; any other movement is a group by itself.
    fn schedule(&self, runs: &[EntityId], movements: &FxHashMap<EntityId, usize>) -> Vec<Vec<usize>> {
        let parallel = |id: &EntityId| matches!(self.facts.tree(*id), Some(Entity::Movement(movement)) if movement.parallel.is_some());
        let groups = runs.chunk_by(|before, after| parallel(before) && parallel(after));
        groups.map(|group| group.iter().filter_map(|id| movements.get(id).copied()).collect()).collect()
    }

    fn robot(&self, id: EntityId) -> Option<Robot> {
        let Entity::Robot(tree) = self.facts.tree(id)? else { return None };
        let drive = self.facts.drive(id)?;
        let wheels = self.resolve_all(id, EntityKind::Wheel, &tree.wheels.as_ref()?.names)?;
        let sensors = tree.sensors.as_ref().map_or(&[][..], |list| &list.names);
        let sensors = without_repeats(&self.resolve_all(id, EntityKind::Sensor, sensors)?);
        (wheels.len() == drive.wheel_count()).then_some(())?;
        Some(Robot {
            name: tree.name.as_ref()?.text.to_string(),
            drive,
            port: tree.port.as_ref()?.value?,
            wheels: wheels.iter().map(|id| self.wheel(*id)).collect::<Option<_>>()?,
            sensors: sensors.iter().map(|id| self.sensor(*id)).collect::<Option<_>>()?,
            objects: Objects::new(),
            ros2: Ros2::new(),
            mounts: Vec::new(),
            source: self.source(&self.facts.entity(id)?, 0)?,
        })
    }

    fn wheel(&self, id: EntityId) -> Option<Wheel> {
        let Entity::Wheel(wheel) = self.facts.tree(id)? else { return None };
        let radius = wheel.radius.as_ref()?.value? / 100.0;
        Some(Wheel { name: wheel.name.as_ref()?.text.to_string(), radius })
    }

    fn sensor(&self, id: EntityId) -> Option<Sensor> {
        let Entity::Sensor(sensor) = self.facts.tree(id)? else { return None };
        let kind = match sensor.kind {
            Some((ast::SensorKeyword::Bumper, _)) => SensorKind::Bumper,
            Some((ast::SensorKeyword::Distance, _)) | None => SensorKind::Distance,
        };
        Some(Sensor { name: sensor.name.as_ref()?.text.to_string(), kind })
    }

    /// A movement of a robot that is found by its id, with its index.
    fn movement<'r>(
        &self,
        id: EntityId,
        robot: impl Fn(EntityId) -> Option<(usize, &'r Robot)>,
        places: &FxHashMap<EntityId, usize>,
    ) -> Option<Movement> {
        let Entity::Movement(tree) = self.facts.tree(id)? else { return None };
        let (robot, Robot { sensors, .. }) =
            robot(self.resolve(id, EntityKind::Robot, tree.robot.as_ref()?)?)?;
        let entity = self.facts.entity(id)?;
        let mut statements = Statements { parts: self, entity, sensors, places, number: 0 };
        Some(Movement {
            name: tree.name.as_ref()?.text.to_string(),
            robot,
            actions: statements.actions(&tree.actions)?,
            source: self.source(&self.facts.entity(id)?, 0)?,
        })
    }

    fn resolve(&self, from: EntityId, kind: EntityKind, name: &Name) -> Option<EntityId> {
        self.facts.resolve(self.facts.file_of(from)?, kind, &name.text).entity()
    }

    fn resolve_all(&self, from: EntityId, kind: EntityKind, names: &'a [Name]) -> Option<Vec<EntityId>> {
        names.iter().map(|name| self.resolve(from, kind, name)).collect()
    }

    fn source(&self, entity: &EntityRef<'_>, offset: u32) -> Option<Source> {
        let line = self.facts.text(entity.file)?.byte_to_line((entity.span.start + offset) as usize) + 1;
        let path = self.facts.path(entity.file);
        let file =
            (Some(entity.file) != self.file).then(|| path.rsplit('/').next().unwrap_or(path).to_owned());
        Some(Source { file, line: u32::try_from(line).ok()? })
    }
}

/// The statements of a movement of which some may be broken.
pub struct KnownStatements<'a> {
    parts: Parts<'a>,
    entity: EntityRef<'a>,
    sensors: Vec<Sensor>,
    places: FxHashMap<EntityId, usize>,
    done: Vec<Movement>,
}

impl KnownStatements<'_> {
    /// Returns the action's kind; `None` where it, or a movement that it does, is broken. The movements that it does
    /// are indices into [`Self::done`].
    pub fn kind(&self, action: &ast::Action) -> Option<ResolvedActionKind> {
        let Self { parts, sensors, places, .. } = self;
        let entity = self.entity;
        Statements { parts, entity, sensors, places, number: 0 }.kind(&action.kind)
    }

    /// The movements that it does, each after those that it does itself.
    pub fn done(&self) -> &[Movement] {
        &self.done
    }
}

/// Turns the statements of one movement into actions, in the order of the text.
struct Statements<'p, 'a> {
    parts: &'p Parts<'a>,
    entity: EntityRef<'a>,
    sensors: &'p [Sensor],
    /// Where the movements that it may do are.
    places: &'p FxHashMap<EntityId, usize>,
    /// The number of statements so far.
    number: usize,
}

impl Statements<'_, '_> {
    fn actions(&mut self, actions: &[ast::Action]) -> Option<Vec<ResolvedAction>> {
        actions.iter().map(|action| self.action(action)).collect()
    }

    fn action(&mut self, action: &ast::Action) -> Option<ResolvedAction> {
        check_cancelled();
        self.number += 1;
        let number = self.number;
        Some(ResolvedAction {
            number,
            text: self.parts.facts.action_head(&self.entity, action),
            source: self.parts.source(&self.entity, action.span.start)?,
            kind: self.kind(&action.kind)?,
        })
    }

    fn kind(&mut self, statement: &Statement) -> Option<ResolvedActionKind> {
        match statement {
            Statement::Repeat(repeat) => {
                let rounds = repeat.rounds.as_ref()?;
                let body = &repeat.block.as_ref()?.actions;
                Some(match rounds {
                    ast::Rounds::Times(number) => {
                        ResolvedActionKind::Repeat { count: count(number)?, body: self.actions(body)? }
                    }
                    ast::Rounds::Until(clause) => ResolvedActionKind::RepeatUntil {
                        until: condition(&clause.condition, self.sensors)?,
                        body: self.actions(body)?,
                    },
                })
            }
            Statement::If(choice) => self.choice(choice),
            Statement::Do(call) => {
                let (parts, id) = (self.parts, self.entity.id);
                let done = parts.resolve(id, EntityKind::Movement, call.movement.as_ref()?)?;
                self.places.get(&done).map(|&movement| ResolvedActionKind::Do { movement })
            }
            _ => simple_kind(statement, self.sensors),
        }
    }

    /// The first branch has the number of the statement.
    fn choice(&mut self, choice: &ast::If) -> Option<ResolvedActionKind> {
        let mut branches = Vec::with_capacity(choice.branches.len());
        for (index, branch) in choice.branches.iter().enumerate() {
            self.number += usize::from(index > 0);
            let block = branch.block.as_ref()?;
            branches.push(Branch {
                number: self.number,
                condition: condition(branch.condition.as_ref()?, self.sensors)?,
                text: self.parts.facts.action_text(&self.entity, head(branch.span, Some(block))),
                source: self.parts.source(&self.entity, branch.span.start)?,
                body: self.actions(&block.actions)?,
            });
        }
        let otherwise =
            choice.otherwise.as_ref().map_or(Some(Vec::new()), |block| self.actions(&block.actions))?;
        Some(ResolvedActionKind::If { branches, otherwise })
    }
}

/// Returns the span of a statement before its block.
fn head(statement: Span, block: Option<&ast::Block>) -> Span {
    Span::new(statement.start, block.map_or(statement.end, |block| block.span.start))
}

/// Returns the number of rounds of a block.
fn count(number: &ast::Number) -> Option<u32> {
    let value = number.value.filter(|value| value.fract() == 0.0 && COUNTS.contains(value))?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is whole and in range")]
    Some(value as u32)
}

/// Returns the kind of a statement that has no blocks and does no movement, of a robot with some sensors.
pub(crate) fn simple_kind(statement: &Statement, sensors: &[Sensor]) -> Option<ResolvedActionKind> {
    Some(match statement {
        Statement::Move(step) => ResolvedActionKind::Move {
            distance: match &step.distance {
                Some(number) => Some(length(number, step.unit)?),
                None if step.until.is_some() && step.unit.is_none() => None,
                None => return None,
            },
            speed: speed(step.speed.as_ref())?,
            until: until(step.until.as_ref(), sensors)?,
        },
        Statement::Turn(turn) => turn_kind(turn, sensors)?,
        Statement::Wait(wait) => ResolvedActionKind::Wait {
            seconds: match &wait.seconds {
                Some(number) => Some(number.value?),
                None => wait.until.as_ref().map(|_| None)?,
            },
            until: until(wait.until.as_ref(), sensors)?,
        },
        Statement::Slam => ResolvedActionKind::Slam,
        Statement::Repeat(_) | Statement::If(_) | Statement::Do(_) => return None,
    })
}

fn turn_kind(turn: &ast::Turn, sensors: &[Sensor]) -> Option<ResolvedActionKind> {
    let left = turn.direction?.0 == ast::Direction::Left;
    if let Some(clause) = turn.until.as_ref().filter(|_| turn.is_of_article()) {
        return Some(ResolvedActionKind::TurnUntil {
            left,
            sensors: indices(&clause.condition.sensors.names, sensors)?,
        });
    }
    let circle = |circle: &ast::Circle| {
        let radius = length(circle.radius.as_ref()?, circle.unit)?;
        Some(Circle { radius, reverse: turn.reverse.is_some() })
    };
    Some(ResolvedActionKind::Turn {
        left,
        degrees: match &turn.angle {
            Some(angle) => Some(angle.value?),
            None => turn.until.is_none().then_some(DEFAULT_ANGLE),
        },
        circle: optional(turn.circle.as_ref(), circle)?,
        speed: speed(turn.speed.as_ref())?,
        until: until(turn.until.as_ref(), sensors)?,
    })
}

fn condition(condition: &ast::Condition, sensors: &[Sensor]) -> Option<Condition> {
    Some(Condition {
        sensors: indices(&condition.sensors.names, sensors)?,
        detect: condition.state?.0 == ast::SensorState::Detect,
        within: optional(condition.within.as_ref(), |within| length(within.distance.as_ref()?, within.unit))?,
    })
}

#[expect(clippy::option_option, reason = "a clause that is left out is not broken")]
fn until(clause: Option<&ast::Until>, sensors: &[Sensor]) -> Option<Option<Condition>> {
    optional(clause, |clause| condition(&clause.condition, sensors))
}

/// Returns what a clause means that need not be there; `None` where it is broken.
#[expect(clippy::option_option, reason = "a clause that is left out is not broken")]
fn optional<T, M>(clause: Option<&T>, meaning: impl FnOnce(&T) -> Option<M>) -> Option<Option<M>> {
    clause.map_or(Some(None), |clause| meaning(clause).map(Some))
}

/// Metres. Centimetres are divided, not multiplied, so that `400 centimeters` is exactly 4.
fn length(number: &ast::Number, unit: Option<(ast::Unit, Span)>) -> Option<f64> {
    let value = number.value?;
    Some(match unit?.0 {
        ast::Unit::Meters => value,
        ast::Unit::Centimeters => value / 100.0,
    })
}

fn indices(names: &[Name], sensors: &[Sensor]) -> Option<Vec<usize>> {
    let index = |name: &Name| sensors.iter().position(|sensor| sensor.name == name.text);
    let all: Vec<usize> = names.iter().map(index).collect::<Option<_>>()?;
    Some(without_repeats(&all))
}

fn without_repeats<T: Copy + Eq + Hash>(all: &[T]) -> Vec<T> {
    let mut seen = FxHashSet::default();
    all.iter().copied().filter(|item| seen.insert(*item)).collect()
}

/// Where each entity of a list without repeats is in it.
fn indices_of(ids: &[EntityId]) -> FxHashMap<EntityId, usize> {
    ids.iter().enumerate().map(|(index, id)| (*id, index)).collect()
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::motion;

    use super::*;
    use crate::{Blocked, Database};

    fn only(program: &str) -> Result<Environment, Blocked> {
        let mut database = Database::new();
        let file = database.open("test.pyr", program);
        let environments = database.environments(file);
        assert_eq!(environments.len(), 1);
        database.environment(environments[0].0)
    }

    const PROGRAM: &str = "\
ip here 10.0.0.7
wheelH a with radius 5 wheelH b with radius 5 wheelH c with radius 5 wheelH d with radius 5
sensor s sensor t : bumper
robot ^left type fw with port 23000 has { a b c d } wheels with sensors { s t s }
robot q with port 20000 has { a b } wheels
parallel movement m of ^left { move -40 centimeters at 18 turn right // far
  turn left until { t , /* and */ s t } }
parallel movement n of q { move 1 meters }
movement o of q { turn left 30 }
environment e with ip here has { ^left q q } robots with { m n o m } moves";

    #[test]
    fn everything_is_resolved() {
        let program = PROGRAM.replace("has { a b } wheels", "has { x y } wheels")
            + "\nwheel x with radius 4 wheel y with radius 4";
        let environment = only(&program).unwrap();
        assert_eq!(environment.host, Some([10, 0, 0, 7].into()));
        assert_eq!(environment.robots.len(), 2);
        assert_eq!(environment.robots[0].drive, Drive::Mecanum);
        assert_eq!(environment.robots[0].name, "left");
        assert_eq!(environment.robots[0].sensors.len(), 2);
        assert_eq!(environment.robots[1].drive, Drive::TwoWheel);
        assert_eq!(environment.schedule, [vec![0, 1], vec![2], vec![0]]);
        let actions = &environment.movements[0].actions;
        assert_eq!(
            actions[0].kind,
            ResolvedActionKind::Move { distance: Some(-0.4), speed: 0.18, until: None }
        );
        let right = ResolvedActionKind::Turn {
            left: false,
            degrees: Some(90.0),
            circle: None,
            speed: motion::RIM_SPEED,
            until: None,
        };
        assert_eq!(actions[1].kind, right);
        assert_eq!(actions[2].kind, ResolvedActionKind::TurnUntil { left: true, sensors: vec![1, 0] });
        assert_eq!(actions[2].text, "turn left until { t, s t }");
        assert_eq!(actions[2].source, Source { file: None, line: 7 });
    }

    #[test]
    fn what_is_done_comes_before_what_does_it_and_what_nobody_runs_is_left_out() {
        let environment = only(
            "wheel a with radius 4 wheel b with radius 4 robot r with port 1 has { a b } wheels\n\
             movement trip of r { do side repeat 2 times { do corner } } movement nobody of r { do side }\n\
             parallel movement corner of r { turn left do step } movement step of r { move 1 meters }\n\
             movement side of r { do step } parallel movement last of r { turn right }\n\
             environment e has { r } robots with { last trip trip } moves",
        )
        .unwrap();
        let names: Vec<&str> = environment.movements.iter().map(|movement| movement.name.as_str()).collect();
        assert_eq!(names, ["last", "step", "side", "corner", "trip"]);
        assert_eq!(
            environment.schedule,
            [vec![0], vec![4], vec![4]],
            "`parallel` counts where it is listed only"
        );
    }

    #[test]
    fn errors_anywhere_below_block_it() {
        let blocked = only(PROGRAM).unwrap_err();
        assert_eq!(blocked.errors.len(), 1, "{blocked:#?}");
        assert_eq!(blocked.errors[0].code(), "wheel-kind-mismatch");
        assert!(blocked.reason().starts_with("`e` has errors: "));
    }

    #[test]
    fn a_declaration_hidden_by_a_mistake_blocks_it() {
        let program = "weel a with radius 4 wheel b with radius 4 robot r with port 1 has { a b } wheels environment e has { r } robots";
        assert_eq!(only(program).unwrap_err().errors[0].code(), "syntax-error");
    }
}
