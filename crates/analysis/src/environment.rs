//! An environment with every name resolved and no errors left: what scripts, plans and simulators are made from.

use std::net::Ipv4Addr;

use pydslrep_kinematics::Drive;
pub use pydslrep_scene::{Objects, SensorKind};

/// One environment, ready to run. Indices refer to the vectors of this struct.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// The environment's name as declared (without `^`).
    pub name: String,
    /// What its script's file is called, without `.py`: its name, with `_env` after it where that would hide a Python
    /// module or would not do as a file's name.
    pub script: String,
    /// Where the program says the simulator runs; `None` means this machine.
    pub host: Option<Ipv4Addr>,
    /// The robots in listed order, each once.
    pub robots: Vec<Robot>,
    /// The movements that are listed, each once, in order of first listing.
    pub movements: Vec<Movement>,
    /// What runs when: groups one after the other; the members of a group (indices into `movements`) start together.
    pub schedule: Vec<Vec<usize>>,
    /// Where it is declared.
    pub source: Source,
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
    /// What it measures.
    pub kind: SensorKind,
}

/// A movement of one robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// The movement's name.
    pub name: String,
    /// Index into [`Environment::robots`].
    pub robot: usize,
    /// What to do, in order.
    pub actions: Vec<Action>,
    /// Where it is declared.
    pub source: Source,
}

/// One step of a movement.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// What to do.
    pub kind: ActionKind,
    /// The statement as the program writes it, on one line, white space folded, without comments.
    pub text: String,
    /// Its span.
    pub source: Source,
}

/// What an action does.
#[derive(Debug, Clone, PartialEq)]
pub enum ActionKind {
    /// Straight ahead along the heading.
    Move {
        /// Metres; negative is backwards.
        distance: f64,
        /// Metres per second at the rim, above zero.
        speed: f64,
    },
    /// In place.
    Turn {
        /// Degrees; positive is left (counter-clockwise).
        degrees: f64,
    },
    /// In place until none of the sensors detects anything.
    TurnUntil {
        /// Counter-clockwise when true.
        left: bool,
        /// Indices into [`Robot::sensors`] of the movement's robot, in listed order, each once.
        sensors: Vec<usize>,
    },
    /// Explores a closed environment and maps it.
    Slam,
}

/// A place in a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The file's name where it is another file than the environment's.
    pub file: Option<String>,
    /// 1-based.
    pub line: u32,
}
