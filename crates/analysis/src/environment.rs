//! An environment with every name resolved and no errors left: what scripts, plans and simulators are made from.

use std::net::Ipv4Addr;

use pydslrep_kinematics::{ActionIndex, Drive, Place};

pub use pydslrep_scene::{Mount, Objects, Ros2, Ros2Value, SensorKind};

/// The allowed numbers of rounds of a block.
pub const COUNTS: std::ops::RangeInclusive<f64> = 1.0..=10_000.0;

/// One environment, ready to run. Indices refer to the vectors of this struct.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// The environment's name as declared (without `^`).
    pub name: String,
    /// The name of its script's file without `.py`: its own, with `_env` after it where that would hide a Python module
    /// or would not do as a file's name.
    pub script: String,
    /// Where the program says the simulator runs; `None` means this machine.
    pub host: Option<Ipv4Addr>,
    /// The robots in listed order, each once.
    pub robots: Vec<Robot>,
    /// The movements that are listed, each once, in order of first listing; before each of them those that it does and that
    /// are not there yet.
    pub movements: Vec<Movement>,
    /// The order of the movements: groups run one after the other; the members of a group (indices into `movements`)
    /// start together.
    pub schedule: Vec<Vec<usize>>,
    /// Where it is declared.
    pub source: Source,
}

/// Where an action of a plan is in the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ActionPlace<'a> {
    /// The movement that the environment lists.
    pub movement: &'a str,
    /// The number of its statement ([`ResolvedAction::number`]) in its own movement, which is the listed one or the last that is done.
    pub number: usize,
    /// The rounds of the repetitions that it is in, from 1, the outermost first.
    pub rounds: Vec<u32>,
    /// The number of rounds of each of these repetitions.
    pub counts: Vec<u32>,
    /// The statements that lead to it by `do`, the outermost first.
    pub calls: Vec<CallPlace<'a>>,
    /// The statement as the program writes it.
    pub text: &'a str,
    /// Where that is.
    pub source: &'a Source,
}

/// A statement that does another movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CallPlace<'a> {
    /// The movement that it is in.
    pub movement: &'a str,
    /// Its number there.
    pub number: usize,
}

impl Environment {
    /// Where an action of a plan is.
    pub fn place(&self, index: ActionIndex, place: &Place) -> Option<ActionPlace<'_>> {
        let listed = self.movements.get(*self.schedule.get(index.group)?.get(index.run)?)?;
        let mut inner = listed;
        let mut calls = Vec::with_capacity(place.calls().len());
        for call in place.calls() {
            calls.push(CallPlace { movement: &inner.name, number: call.action + 1 });
            inner = self.movements.get(call.movement)?;
        }
        let number = index.action + 1;
        let (text, source) = inner.statement(number)?;
        let (rounds, counts) = (place.rounds().to_vec(), place.counts().to_vec());
        Some(ActionPlace { movement: &listed.name, number, rounds, counts, calls, text, source })
    }
}

/// A robot with its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// The robot's name.
    pub name: String,
    /// Wheel layout, inferred from the wheels where the program leaves it out.
    pub drive: Drive,
    /// Port of the simulator's remote API.
    pub port: u16,
    /// As many as `drive` asks for, in its order.
    pub wheels: Vec<Wheel>,
    /// In listed order, each once.
    pub sensors: Vec<Sensor>,
    /// Where its scene file says that it and its parts are in the simulator's scene, if their objects have other names there.
    pub objects: Objects,
    /// The settings of its topics in ROS 2 that are not the usual ones; empty for other targets.
    pub ros2: Ros2,
    /// Where its sensors are, in their order; empty for targets that ask the simulator.
    pub mounts: Vec<Mount>,
    /// Where it is declared.
    pub source: Source,
}

/// A driven wheel of one robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// The wheel's name, which is also the name of its joint.
    pub name: String,
    /// Radius in metres.
    pub radius: f64,
}

/// A proximity sensor of one robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sensor {
    /// The sensor's name.
    pub name: String,
    /// The kind of its measurements.
    pub kind: SensorKind,
}

/// A movement of one robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// The movement's name.
    pub name: String,
    /// Index into [`Environment::robots`].
    pub robot: usize,
    /// The actions, in order.
    pub actions: Vec<ResolvedAction>,
    /// Where it is declared.
    pub source: Source,
}

/// One statement of a movement, its references and defaults resolved.
#[derive(Debug, Clone, PartialEq)]
pub struct ResolvedAction {
    /// Its place in its movement in the order of the text, from 1; statements in blocks count, too, and so do the blocks' own.
    pub number: usize,
    /// The action and its values.
    pub kind: ResolvedActionKind,
    /// The statement as the program writes it, on one line, white space folded, without comments; of one with blocks, what is
    /// before its first block.
    pub text: String,
    /// Its span.
    pub source: Source,
}

/// The kind of an action, with its values.
#[derive(Debug, Clone, PartialEq)]
pub enum ResolvedActionKind {
    /// Straight ahead along the heading.
    Move {
        /// Metres; negative is backwards. `None`: as far as it takes until the condition holds.
        distance: Option<f64>,
        /// Metres per second at the rim, above zero.
        speed: f64,
        /// The condition that ends it before that.
        until: Option<Condition>,
    },
    /// In place, or on a circle.
    Turn {
        /// Counter-clockwise when true.
        left: bool,
        /// Degrees to that side, negative to the other one. `None`: as far as it takes until the condition holds.
        degrees: Option<f64>,
        /// The circle; `None` in place.
        circle: Option<Circle>,
        /// Metres per second at the rim, above zero.
        speed: f64,
        /// The condition that ends it before that.
        until: Option<Condition>,
    },
    /// In place until none of the sensors detects anything, as the article has it.
    TurnUntil {
        /// Counter-clockwise when true.
        left: bool,
        /// Indices into [`Robot::sensors`] of the movement's robot, in listed order, each once.
        sensors: Vec<usize>,
    },
    /// Stays where it is.
    Wait {
        /// Seconds. `None`: as long as it takes until the condition holds.
        seconds: Option<f64>,
        /// The condition that ends it before that.
        until: Option<Condition>,
    },
    /// A block, so many times.
    Repeat {
        /// From 1 to 10 000.
        count: u32,
        /// The actions of each round.
        body: Vec<ResolvedAction>,
    },
    /// A block, until a condition holds before a round.
    RepeatUntil {
        /// When to end.
        until: Condition,
        /// The actions of each round.
        body: Vec<ResolvedAction>,
    },
    /// The block of the first branch whose condition holds.
    If {
        /// In the order of the text; the first is that of the action itself.
        branches: Vec<Branch>,
        /// The actions if no condition holds.
        otherwise: Vec<ResolvedAction>,
    },
    /// Another movement of the same robot.
    Do {
        /// Index into [`Environment::movements`].
        movement: usize,
    },
    /// Explores a closed environment and maps it.
    Slam,
}

/// An `if`, or an `else if` after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// As [`ResolvedAction::number`].
    pub number: usize,
    /// When its block is done.
    pub condition: Condition,
    /// The actions.
    pub body: Vec<ResolvedAction>,
    /// As [`ResolvedAction::text`].
    pub text: String,
    /// Its span.
    pub source: Source,
}

/// A circle that a robot drives on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Metres, above zero: that of the robot's reference point.
    pub radius: f64,
    /// True if it drives backwards.
    pub reverse: bool,
}

/// A condition on the sensors of the movement's robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Indices into [`Robot::sensors`], in listed order, each once.
    pub sensors: Vec<usize>,
    /// At least one of them detects something; else none of them does.
    pub detect: bool,
    /// Only what is nearer counts, metres.
    pub within: Option<f64>,
}

/// What the kind of an action is made of.
#[derive(Default)]
struct Parts<'a> {
    until: Option<&'a Condition>,
    branches: &'a [Branch],
    /// The block that is after those of the branches.
    body: Option<&'a [ResolvedAction]>,
    /// The sensors that it asks without a condition.
    sensors: &'a [usize],
}

impl ResolvedActionKind {
    fn parts(&self) -> Parts<'_> {
        match self {
            Self::Move { until, .. } | Self::Turn { until, .. } | Self::Wait { until, .. } => {
                Parts { until: until.as_ref(), ..Parts::default() }
            }
            Self::TurnUntil { sensors, .. } => Parts { sensors, ..Parts::default() },
            Self::Repeat { body, .. } => Parts { body: Some(body), ..Parts::default() },
            Self::RepeatUntil { until, body } => {
                Parts { until: Some(until), body: Some(body), ..Parts::default() }
            }
            Self::If { branches, otherwise } => Parts { branches, body: Some(otherwise), ..Parts::default() },
            Self::Do { .. } | Self::Slam => Parts::default(),
        }
    }

    /// The actions in its blocks, block by block.
    pub fn blocks(&self) -> impl DoubleEndedIterator<Item = &[ResolvedAction]> {
        let Parts { branches, body, .. } = self.parts();
        branches.iter().map(|branch| branch.body.as_slice()).chain(body)
    }

    /// The conditions that it asks itself.
    pub fn conditions(&self) -> impl Iterator<Item = &Condition> {
        let Parts { until, branches, .. } = self.parts();
        until.into_iter().chain(branches.iter().map(|branch| &branch.condition))
    }

    /// Indices into [`Robot::sensors`]: those that it asks itself. To explore, it may ask others as well.
    pub fn sensors(&self) -> impl Iterator<Item = usize> {
        let of_conditions = self.conditions().flat_map(|condition| &condition.sensors);
        of_conditions.chain(self.parts().sensors).copied()
    }
}

/// All actions of a row and of their blocks, in the order of the text.
pub fn nested(actions: &[ResolvedAction]) -> Vec<&ResolvedAction> {
    let mut all = Vec::new();
    let mut open = vec![actions.iter()];
    while let Some(row) = open.last_mut() {
        let Some(action) = row.next() else {
            open.pop();
            continue;
        };
        all.push(action);
        open.extend(action.kind.blocks().rev().map(<[ResolvedAction]>::iter));
    }
    all
}

impl Movement {
    /// Returns the text and the location of the statement with a number.
    pub fn statement(&self, number: usize) -> Option<(&str, &Source)> {
        nested(&self.actions).into_iter().find_map(|action| {
            if let ResolvedActionKind::If { branches, .. } = &action.kind {
                let branch = branches.iter().find(|branch| branch.number == number)?;
                return Some((branch.text.as_str(), &branch.source));
            }
            (action.number == number).then_some((action.text.as_str(), &action.source))
        })
    }
}

/// A place in a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The file's name where it is another file than the environment's.
    pub file: Option<String>,
    /// 1-based.
    pub line: u32,
}
