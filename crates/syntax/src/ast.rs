//! The syntax tree of one entity. Every clause is optional, because any of them may be missing or broken while the
//! rest is fine; an error says so wherever one is absent that must be there.

pub use pydslrep_robots::Drive;
use smol_str::SmolStr;

use crate::{EntityKind, Span};

/// One top-level piece of a program.
#[derive(Debug, Clone, PartialEq)]
pub enum Entity {
    /// `import "file.pyr"`
    Import(Import),
    /// `wheel name with radius 4.5`
    Wheel(Wheel),
    /// `sensor name : distance`
    Sensor(Sensor),
    /// `ip name 127.0.0.1`
    Ip(Ip),
    /// `robot name type tw with port 23000 has { … } wheels`
    Robot(Robot),
    /// `movement name of robot { … }`
    Movement(Movement),
    /// `environment name has { … } robots with { … } moves`
    Environment(Environment),
}

impl Entity {
    /// Its namespace; `None` for an import.
    pub fn kind(&self) -> Option<EntityKind> {
        Some(match self {
            Self::Import(_) => return None,
            Self::Wheel(_) => EntityKind::Wheel,
            Self::Sensor(_) => EntityKind::Sensor,
            Self::Ip(_) => EntityKind::Ip,
            Self::Robot(_) => EntityKind::Robot,
            Self::Movement(_) => EntityKind::Movement,
            Self::Environment(_) => EntityKind::Environment,
        })
    }

    /// The name it declares.
    pub fn name(&self) -> Option<&Name> {
        match self {
            Self::Import(_) => None,
            Self::Wheel(wheel) => wheel.name.as_ref(),
            Self::Sensor(sensor) => sensor.name.as_ref(),
            Self::Ip(ip) => ip.name.as_ref(),
            Self::Robot(robot) => robot.name.as_ref(),
            Self::Movement(movement) => movement.name.as_ref(),
            Self::Environment(environment) => environment.name.as_ref(),
        }
    }

    /// Every name it refers to, with the kind that is wanted, in the order of the text.
    pub fn references(&self) -> Vec<(EntityKind, &Name)> {
        let mut found = Vec::new();
        match self {
            Self::Robot(robot) => {
                extend(&mut found, EntityKind::Wheel, robot.wheels.as_ref());
                extend(&mut found, EntityKind::Sensor, robot.sensors.as_ref());
            }
            Self::Movement(movement) => {
                found.extend(movement.robot.iter().map(|name| (EntityKind::Robot, name)));
                for action in &movement.actions {
                    extend(&mut found, EntityKind::Sensor, action.until());
                }
            }
            Self::Environment(environment) => {
                let ip = environment.ip.as_ref().and_then(|clause| clause.name.as_ref());
                found.extend(ip.map(|name| (EntityKind::Ip, name)));
                extend(&mut found, EntityKind::Robot, environment.robots.as_ref());
                extend(&mut found, EntityKind::Movement, environment.movements.as_ref());
            }
            Self::Import(_) | Self::Wheel(_) | Self::Sensor(_) | Self::Ip(_) => {}
        }
        found
    }
}

fn extend<'a>(found: &mut Vec<(EntityKind, &'a Name)>, kind: EntityKind, refs: Option<&'a References>) {
    found.extend(refs.into_iter().flat_map(|refs| &refs.names).map(|name| (kind, name)));
}

/// A name, declared or referred to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// Without `^`.
    pub text: SmolStr,
    /// With `^`.
    pub span: Span,
}

/// A number as written.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// `None` where the text is no number (an error has been reported).
    pub value: Option<f64>,
    /// Its span.
    pub span: Span,
}

/// A port as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortNumber {
    /// `None` where it is out of range, however far.
    pub value: Option<u16>,
    /// Its span.
    pub span: Span,
    /// Whether it is a whole number at all; where it is not, an error has been reported.
    pub whole: bool,
}

/// A list of references in braces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct References {
    /// In the order of the text.
    pub names: Vec<Name>,
    /// From brace to brace.
    pub span: Span,
    /// Whether something in it could not be understood, so that nothing may be concluded from its length.
    pub broken: bool,
}

/// `import "file.pyr"`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// The path between the quotes.
    pub path: Option<SmolStr>,
    /// Where the path is, with its quotes.
    pub path_span: Option<Span>,
}

/// `wheel` or `wheelH`
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Where the keyword is.
    pub keyword: Span,
    /// `wheelH`: 45° rollers.
    pub mecanum: bool,
    /// Its name.
    pub name: Option<Name>,
    /// In centimetres.
    pub radius: Option<Number>,
}

/// `sensor`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sensor {
    /// Its name.
    pub name: Option<Name>,
    /// What is written after `:`.
    pub kind: Option<(SensorKind, Span)>,
}

/// Kinds of proximity sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorKind {
    /// `distance`, also where no kind is written.
    Distance,
    /// `bumper`
    Bumper,
}

/// `ip`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ip {
    /// Its name.
    pub name: Option<Name>,
    /// The address as written.
    pub address: Option<(SmolStr, Span)>,
}

/// `robot`
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Its name.
    pub name: Option<Name>,
    /// `type tw`
    pub drive: Option<DriveClause>,
    /// `with port 23000`
    pub port: Option<PortNumber>,
    /// `has { … } wheels`
    pub wheels: Option<References>,
    /// `with sensors { … }`
    pub sensors: Option<References>,
}

/// `type tw`
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DriveClause {
    /// Which one; `None` where the word is missing or unknown.
    pub word: Option<Drive>,
    /// From `type` to the word.
    pub span: Span,
    /// Whether it is before the name, as the article's grammar prints it.
    pub before_name: bool,
}

/// `movement`
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// Where `parallel` is, if it is there.
    pub parallel: Option<Span>,
    /// Its name.
    pub name: Option<Name>,
    /// Whose movement it is.
    pub robot: Option<Name>,
    /// From brace to brace.
    pub body: Option<Span>,
    /// In order.
    pub actions: Vec<Action>,
}

/// One action and the text it covers.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// What to do.
    pub kind: ActionKind,
    /// From its keyword to its last word.
    pub span: Span,
}

impl Action {
    /// The sensors of a `turn … until`.
    pub fn until(&self) -> Option<&References> {
        match &self.kind {
            ActionKind::Turn(Turn { extent: Some(TurnExtent::Until(sensors)), .. }) => Some(sensors),
            _ => None,
        }
    }

    /// The numbers in it.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        let [one, other] = match &self.kind {
            ActionKind::Move(step) => {
                [step.distance.as_ref(), step.speed.as_ref().and_then(|clause| clause.value.as_ref())]
            }
            ActionKind::Turn(Turn { extent: Some(TurnExtent::Angle(angle)), .. }) => [Some(angle), None],
            ActionKind::Turn(_) | ActionKind::Slam => [None, None],
        };
        one.into_iter().chain(other)
    }
}

/// The three actions.
#[derive(Debug, Clone, PartialEq)]
pub enum ActionKind {
    /// `move 4.0 meters at 9.0`
    Move(Move),
    /// `turn left 90`
    Turn(Turn),
    /// `slam`
    Slam,
}

/// `move`
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// How far, in `unit`.
    pub distance: Option<Number>,
    /// `meters` or `centimeters`.
    pub unit: Option<(Unit, Span)>,
    /// `at 9.0`, in centimetres per second.
    pub speed: Option<SpeedClause>,
}

/// `at 9.0`
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedClause {
    /// In centimetres per second.
    pub value: Option<Number>,
    /// From `at` to the number.
    pub span: Span,
}

/// Units of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// `meters`
    Meters,
    /// `centimeters`
    Centimeters,
}

impl Unit {
    /// How many metres one of it is.
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Meters => 1.0,
            Self::Centimeters => 0.01,
        }
    }
}

/// `turn`
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// `left` or `right`.
    pub direction: Option<(Direction, Span)>,
    /// How far; 90° where nothing is written.
    pub extent: Option<TurnExtent>,
}

/// Ways to turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Counter-clockwise seen from above.
    Left,
    /// Clockwise seen from above.
    Right,
}

/// How far to turn.
#[derive(Debug, Clone, PartialEq)]
pub enum TurnExtent {
    /// In degrees.
    Angle(Number),
    /// Until none of these sensors detects an obstacle.
    Until(References),
}

/// `environment`
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Its name.
    pub name: Option<Name>,
    /// `with ip …`
    pub ip: Option<IpClause>,
    /// `has { … } robots`
    pub robots: Option<References>,
    /// `with { … } moves`
    pub movements: Option<References>,
}

/// `with ip ip1`, or `, ip1` in the older spelling.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IpClause {
    /// Which ip.
    pub name: Option<Name>,
    /// From its first word or comma to its last.
    pub span: Span,
    /// Whether it is the older spelling.
    pub with_comma: bool,
}
