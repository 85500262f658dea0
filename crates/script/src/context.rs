//! The template's context: an environment in terms of the script.

use std::{collections::HashSet, net::Ipv4Addr};

use pydslrep_analysis::environment::{Action, ActionKind, Environment, Movement, Robot, SensorKind, Source};
use pydslrep_kinematics::{Drive, motion::RIM_SPEED};
use serde::Serialize;

use crate::{ScriptError, Target};

/// Longer names would exceed the line length.
const LONGEST_NAME_IN_IDENTIFIER: usize = 40;

/// Everything the template `environment.py.j2` reads.
#[derive(Debug, Serialize)]
#[allow(clippy::struct_excessive_bools, reason = "each answers a question of the template")]
pub(crate) struct Script {
    name: String,
    simulator: &'static str,
    /// The oldest Python that runs the script: major and minor version.
    oldest_python: (u32, u32),
    /// Whether the target is V-REP.
    vrep: bool,
    host: String,
    /// The classes of the drives in use, each once.
    drives: Vec<&'static str>,
    two_wheel: bool,
    four_wheel: bool,
    four_mecanum: bool,
    /// Whether any movements run in parallel.
    parallel: bool,
    /// Whether any action reads sensors.
    until: bool,
    /// Whether any robot explores.
    slam: bool,
    /// Always false: the parts of a script do not stand alone.
    standalone: bool,
    robots: Vec<RobotModel>,
    movements: Vec<MovementFunction>,
    /// The functions of each group.
    schedule: Vec<Vec<String>>,
}

#[derive(Debug, Serialize)]
struct RobotModel {
    name: String,
    port: u16,
    drive: &'static str,
    wheels: Vec<WheelModel>,
    /// Only those that an action reads.
    // Written as a list: the formatter does not join its lines even if there is only one.
    sensors: Vec<String>,
    /// The sensors for exploring.
    slam_sensors: Vec<String>,
}

#[derive(Debug, Serialize)]
struct WheelModel {
    name: String,
    radius: String,
}

#[derive(Debug, Serialize)]
struct MovementFunction {
    function: String,
    name: String,
    robot: String,
    comment: String,
    actions: Vec<CommentedAction>,
}

#[derive(Debug, Serialize)]
struct CommentedAction {
    #[serde(flatten)]
    call: Call,
    comment: String,
}

/// Numbers are Python literals.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum Call {
    /// Metres, and metres per second unless that is the default.
    Move { distance: String, speed: Option<String> },
    /// Degrees.
    Turn { degrees: String },
    /// A side and the names of sensors.
    Until { side: &'static str, sensors: Vec<String> },
    /// No arguments.
    Slam,
}

impl Script {
    /// The context of an environment; an error if a robot lists a wheel twice.
    pub(crate) fn new(environment: &Environment, target: Target) -> Result<Self, ScriptError> {
        // Without robots the script still needs one drive class.
        let has = |drive| match environment.robots.as_slice() {
            [] => drive == Drive::TwoWheel,
            robots => robots.iter().any(|robot| robot.drive == drive),
        };
        let (two_wheel, four_wheel, four_mecanum) =
            (has(Drive::TwoWheel), has(Drive::FourWheel), has(Drive::FourMecanum));
        let drives = [Drive::TwoWheel, Drive::FourWheel, Drive::FourMecanum];
        let movements = &environment.movements;
        let functions: Vec<String> = movements
            .iter()
            .enumerate()
            .map(|(index, movement)| function_name(index, &movement.name))
            .collect();
        Ok(Self {
            name: plain(&environment.name),
            simulator: match target {
                Target::CoppeliaSim => "CoppeliaSim",
                Target::VRep => "V-REP",
            },
            oldest_python: crate::OLDEST_PYTHON,
            vrep: target == Target::VRep,
            host: environment.host.unwrap_or(Ipv4Addr::LOCALHOST).to_string(),
            drives: drives.into_iter().filter(|&drive| has(drive)).map(class).collect(),
            two_wheel,
            four_wheel,
            four_mecanum,
            parallel: environment.schedule.iter().any(|group| group.len() > 1),
            until: movements.iter().flat_map(|movement| &movement.actions).any(looks_at_sensors),
            slam: movements.iter().any(explores),
            standalone: false,
            robots: environment
                .robots
                .iter()
                .enumerate()
                .map(|(index, r)| robot(index, r, movements))
                .collect::<Result<_, _>>()?,
            movements: movements
                .iter()
                .zip(&functions)
                .map(|(m, function)| movement_function(m, function, &environment.robots[m.robot]))
                .collect(),
            schedule: environment
                .schedule
                .iter()
                .filter(|group| !group.is_empty())
                .map(|group| group.iter().map(|&index| functions[index].clone()).collect())
                .collect(),
        })
    }
}

/// The Python class of a drive.
fn class(drive: Drive) -> &'static str {
    match drive {
        Drive::TwoWheel => "TwoWheelDrive",
        Drive::FourWheel => "FourWheelDrive",
        Drive::FourMecanum => "FourMecanumDrive",
    }
}

/// `movement_` and the name, so that it is neither a keyword nor another name in the script; or a number instead of the
/// name if that is not a short identifier.
fn function_name(index: usize, name: &str) -> String {
    let is_identifier = name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric())
        && !name.starts_with(|c: char| c.is_ascii_digit());
    if is_identifier && (1..=LONGEST_NAME_IN_IDENTIFIER).contains(&name.len()) {
        format!("movement_{name}")
    } else {
        format!("movement_{}", index + 1)
    }
}

fn looks_at_sensors(action: &Action) -> bool {
    matches!(action.kind, ActionKind::TurnUntil { .. })
}

fn explores(movement: &Movement) -> bool {
    movement.actions.iter().any(|action| action.kind == ActionKind::Slam)
}

fn robot(index: usize, robot: &Robot, movements: &[Movement]) -> Result<RobotModel, ScriptError> {
    let mut names = HashSet::new();
    if let Some(repeated) = robot.wheels.iter().find(|wheel| !names.insert(&wheel.name)) {
        return Err(ScriptError::RepeatedWheel { robot: robot.name.clone(), wheel: repeated.name.clone() });
    }
    Ok(RobotModel {
        name: robot.name.clone(),
        port: robot.port,
        drive: class(robot.drive),
        wheels: robot
            .wheels
            .iter()
            .map(|wheel| WheelModel { name: wheel.name.clone(), radius: float(wheel.radius) })
            .collect(),
        sensors: sensors_looked_at(index, robot, movements),
        slam_sensors: slam_sensors(index, robot, movements),
    })
}

fn sensors_looked_at(index: usize, robot: &Robot, movements: &[Movement]) -> Vec<String> {
    let mut looked_at = vec![false; robot.sensors.len()];
    for action in movements.iter().filter(|movement| movement.robot == index).flat_map(|m| &m.actions) {
        if let ActionKind::TurnUntil { sensors, .. } = &action.kind {
            for &sensor in sensors {
                looked_at[sensor] = true;
            }
        }
    }
    let slam_sensors = slam_sensors(index, robot, movements);
    let sensors = robot
        .sensors
        .iter()
        .zip(looked_at)
        .filter(|(sensor, looked_at)| *looked_at || slam_sensors.contains(&sensor.name));
    sensors.map(|(sensor, _)| sensor.name.clone()).collect()
}

/// The sensors for exploring; empty if the robot does not explore.
fn slam_sensors(index: usize, robot: &Robot, movements: &[Movement]) -> Vec<String> {
    if !movements.iter().any(|movement| movement.robot == index && explores(movement)) {
        return Vec::new();
    }
    let distances = robot.sensors.iter().filter(|sensor| sensor.kind == SensorKind::Distance);
    distances.map(|sensor| sensor.name.clone()).collect()
}

fn movement_function(movement: &Movement, function: &str, robot: &Robot) -> MovementFunction {
    MovementFunction {
        function: function.to_owned(),
        name: movement.name.clone(),
        robot: robot.name.clone(),
        comment: place(&movement.source),
        actions: movement.actions.iter().map(|action| commented_action(action, robot)).collect(),
    }
}

fn commented_action(action: &Action, robot: &Robot) -> CommentedAction {
    let call = match &action.kind {
        ActionKind::Move { distance, speed } => Call::Move {
            distance: float(*distance),
            // Converting from cm/s may round.
            speed: ((speed - RIM_SPEED).abs() > 1e-12).then(|| float(*speed)),
        },
        ActionKind::Turn { degrees } => Call::Turn { degrees: float(*degrees) },
        ActionKind::TurnUntil { left, sensors } => Call::Until {
            side: if *left { "left" } else { "right" },
            sensors: sensors.iter().map(|&sensor| robot.sensors[sensor].name.clone()).collect(),
        },
        ActionKind::Slam => Call::Slam,
    };
    CommentedAction { call, comment: format!("{}: {}", place(&action.source), comment(&action.text)) }
}

/// The location in the program, for a comment.
fn place(source: &Source) -> String {
    match &source.file {
        Some(file) => format!("{}, line {}", comment(file), source.line),
        None => format!("line {}", source.line),
    }
}

/// A text for a comment: replaces all characters that could end it or change its appearance.
fn comment(text: &str) -> String {
    text.chars()
        .map(|c| if c == ' ' || c.is_ascii_graphic() || c.is_alphanumeric() { c } else { '?' })
        .collect()
}

/// A name for a docstring: replaces all characters that could end it.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c == '_' || c.is_ascii_alphanumeric() { c } else { '?' }).collect()
}

/// A Python float literal.
fn float(value: f64) -> String {
    format!("{value:?}")
}
