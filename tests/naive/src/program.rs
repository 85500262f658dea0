//! The syntax tree of a program.

use std::ops::Range;

use crate::Finding;

pub(crate) struct Program {
    /// The paths of its imports, without quotes.
    pub(crate) imports: Vec<Name>,
    pub(crate) entities: Vec<Entity>,
    /// Deprecated spellings found by the parser.
    pub(crate) older_spellings: Vec<Finding>,
}

impl Program {
    pub(crate) fn environments(&self) -> impl Iterator<Item = (&Entity, &Environment)> {
        self.entities.iter().filter_map(|entity| match &entity.body {
            Body::Environment(environment) => Some((entity, environment)),
            _ => None,
        })
    }

    pub(crate) fn has_any(&self, kind: &str) -> bool {
        self.entities.iter().any(|entity| entity.kind() == kind)
    }

    /// Every reference of the program with its kind.
    pub(crate) fn references(&self) -> Vec<(&'static str, &Name)> {
        self.entities.iter().flat_map(Entity::references).collect()
    }

    /// The first declaration with that kind and name in this file.
    pub(crate) fn declaration(&self, kind: &str, name: &str) -> Option<&Entity> {
        self.entities.iter().find(|entity| entity.kind() == kind && entity.name.text == name)
    }
}

pub(crate) struct Entity {
    pub(crate) range: Range<usize>,
    pub(crate) name: Name,
    pub(crate) body: Body,
}

impl Entity {
    /// Each kind has its own namespace; `wheel` and `wheelH` are one kind.
    pub(crate) fn kind(&self) -> &'static str {
        match &self.body {
            Body::Wheel(_) => "wheel",
            Body::Sensor(_) => "sensor",
            Body::Ip(_) => "ip",
            Body::Robot(_) => "robot",
            Body::Movement(_) => "movement",
            Body::Environment(_) => "environment",
        }
    }

    pub(crate) fn references(&self) -> Vec<(&'static str, &Name)> {
        match &self.body {
            Body::Robot(robot) => [all("wheel", &robot.wheels), all("sensor", &robot.sensors)].concat(),
            Body::Movement(movement) => {
                let used = movement.statements().into_iter().flat_map(Action::references);
                std::iter::once(("robot", &movement.robot)).chain(used).collect()
            }
            Body::Environment(environment) => {
                let ip = environment.ip.iter().map(|name| ("ip", name)).collect();
                [ip, all("robot", &environment.robots), all("movement", &environment.movements)].concat()
            }
            Body::Wheel(_) | Body::Sensor(_) | Body::Ip(_) => Vec::new(),
        }
    }
}

fn all<'a>(kind: &'static str, names: &'a [Name]) -> Vec<(&'static str, &'a Name)> {
    names.iter().map(|name| (kind, name)).collect()
}

pub(crate) enum Body {
    Wheel(Wheel),
    Sensor(Sensor),
    Ip(Ip),
    Robot(Robot),
    Movement(Movement),
    Environment(Environment),
}

#[derive(Clone)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) range: Range<usize>,
}

pub(crate) struct Number {
    pub(crate) text: String,
    pub(crate) range: Range<usize>,
}

impl Number {
    pub(crate) fn value(&self) -> f64 {
        self.text.parse().unwrap_or(f64::NAN)
    }
}

pub(crate) struct Wheel {
    pub(crate) mecanum: bool,
    pub(crate) radius: Number,
}

pub(crate) struct Sensor {
    pub(crate) bumper: bool,
}

pub(crate) struct Ip {
    pub(crate) address: Name,
}

pub(crate) struct Robot {
    /// The word after `type` with its range, if present.
    pub(crate) drive: Option<Name>,
    pub(crate) port: Number,
    pub(crate) wheels: Vec<Name>,
    /// From brace to brace.
    pub(crate) wheel_list: Range<usize>,
    pub(crate) sensors: Vec<Name>,
}

pub(crate) struct Movement {
    /// The range of `parallel`.
    pub(crate) parallel: Option<Range<usize>>,
    pub(crate) robot: Name,
    pub(crate) actions: Vec<Action>,
    /// From brace to brace.
    pub(crate) body: Range<usize>,
}

impl Movement {
    /// Every statement, also those in blocks, in text order.
    pub(crate) fn statements(&self) -> Vec<&Action> {
        flattened(&self.actions)
    }

    /// The movements that it does, in text order.
    pub(crate) fn done(&self) -> Vec<&Name> {
        self.statements().into_iter().filter_map(Action::done).collect()
    }
}

/// Statements and all that they contain, in text order.
pub(crate) fn flattened(actions: &[Action]) -> Vec<&Action> {
    actions.iter().flat_map(|action| [vec![action], action.inner()].concat()).collect()
}

pub(crate) struct Action {
    pub(crate) range: Range<usize>,
    /// Its first word.
    pub(crate) keyword: Range<usize>,
    pub(crate) kind: ActionKind,
}

impl Action {
    /// The statements in its blocks.
    fn inner(&self) -> Vec<&Self> {
        let mut inner: Vec<&Self> =
            self.blocks().iter().flat_map(|block| flattened(&block.actions)).collect();
        if let Some(other) = self.else_if() {
            inner.push(other);
            inner.extend(other.inner());
        }
        inner
    }

    /// Its own blocks, without those of an `else if`.
    pub(crate) fn blocks(&self) -> Vec<&Block> {
        match &self.kind {
            ActionKind::Repeat { body, .. } => vec![body],
            ActionKind::If { then, otherwise: Some(Else::Block(block)), .. } => vec![then, block],
            ActionKind::If { then, .. } => vec![then],
            _ => Vec::new(),
        }
    }

    /// The `if` after its `else`.
    pub(crate) fn else_if(&self) -> Option<&Self> {
        match &self.kind {
            ActionKind::If { otherwise: Some(Else::If(other)), .. } => Some(other),
            _ => None,
        }
    }

    /// The condition that it stops at or asks.
    pub(crate) fn condition(&self) -> Option<&Condition> {
        match &self.kind {
            ActionKind::Move { until, .. } | ActionKind::Wait { until, .. } => {
                until.as_ref().map(|stop| &stop.value)
            }
            ActionKind::Turn(turn) => turn.until.as_ref().map(|stop| &stop.value),
            ActionKind::Repeat { rounds: Rounds::Until(condition), .. }
            | ActionKind::If { condition, .. } => Some(condition),
            ActionKind::Repeat { .. } | ActionKind::Do { .. } | ActionKind::Slam => None,
        }
    }

    /// The movement that it does.
    pub(crate) fn done(&self) -> Option<&Name> {
        match &self.kind {
            ActionKind::Do { movement } => Some(movement),
            _ => None,
        }
    }

    /// Its own references, without those in blocks.
    fn references(&self) -> Vec<(&'static str, &Name)> {
        let sensors = self.condition().map_or(Vec::new(), |condition| all("sensor", &condition.sensors));
        sensors.into_iter().chain(self.done().map(|name| ("movement", name))).collect()
    }
}

pub(crate) enum ActionKind {
    Move { distance: Option<Length>, speed: Option<Number>, until: Option<Stop> },
    Turn(Turn),
    Wait { seconds: Option<Number>, until: Option<Stop> },
    Repeat { rounds: Rounds, body: Block },
    If { condition: Condition, then: Block, otherwise: Option<Else> },
    Do { movement: Name },
    Slam,
}

pub(crate) struct Length {
    pub(crate) number: Number,
    pub(crate) meters: bool,
}

impl Length {
    /// Metres.
    pub(crate) fn value(&self) -> f64 {
        if self.meters { self.number.value() } else { self.number.value() / 100.0 }
    }
}

/// A part of a statement, with the words that begin it.
pub(crate) struct Clause<T> {
    pub(crate) range: Range<usize>,
    pub(crate) value: T,
}

pub(crate) struct Turn {
    pub(crate) angle: Option<Number>,
    /// `with radius …`
    pub(crate) circle: Option<Clause<Length>>,
    /// `at …`
    pub(crate) speed: Option<Clause<Number>>,
    /// The range of `in reverse`.
    pub(crate) reverse: Option<Range<usize>>,
    pub(crate) until: Option<Stop>,
}

impl Turn {
    /// Whether it is `turn SIDE until {…}`, which has no other parts in the article.
    pub(crate) fn is_until_free(&self) -> bool {
        let alone =
            self.angle.is_none() && self.circle.is_none() && self.speed.is_none() && self.reverse.is_none();
        alone && self.until.is_some()
    }
}

/// `until …`
pub(crate) type Stop = Clause<Condition>;

pub(crate) struct Condition {
    pub(crate) sensors: Vec<Name>,
    /// From brace to brace.
    pub(crate) list: Range<usize>,
    /// The range of `clear` or `detect`.
    pub(crate) word: Option<Range<usize>>,
    pub(crate) within: Option<Clause<Length>>,
}

pub(crate) enum Rounds {
    Times(Number),
    Until(Condition),
}

pub(crate) struct Block {
    pub(crate) actions: Vec<Action>,
    /// From brace to brace.
    pub(crate) range: Range<usize>,
}

pub(crate) enum Else {
    If(Box<Action>),
    Block(Block),
}

pub(crate) struct Environment {
    pub(crate) ip: Option<Name>,
    pub(crate) robots: Vec<Name>,
    /// From brace to brace.
    pub(crate) robot_list: Range<usize>,
    pub(crate) movements: Vec<Name>,
}
