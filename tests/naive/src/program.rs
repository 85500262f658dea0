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
                let until = movement.actions.iter().flat_map(|action| all("sensor", action.until()));
                std::iter::once(("robot", &movement.robot)).chain(until).collect()
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
    /// `tw`, `fw` or `fwh` with its range, if present.
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

pub(crate) struct Action {
    pub(crate) range: Range<usize>,
    pub(crate) kind: ActionKind,
}

impl Action {
    pub(crate) fn until(&self) -> &[Name] {
        match &self.kind {
            ActionKind::TurnUntil { sensors } => sensors,
            _ => &[],
        }
    }
}

pub(crate) enum ActionKind {
    Move { distance: Number, meters: bool, speed: Option<Number> },
    Turn { angle: Option<Number> },
    TurnUntil { sensors: Vec<Name> },
    Slam,
}

pub(crate) struct Environment {
    pub(crate) ip: Option<Name>,
    pub(crate) robots: Vec<Name>,
    /// From brace to brace.
    pub(crate) robot_list: Range<usize>,
    pub(crate) movements: Vec<Name>,
}
