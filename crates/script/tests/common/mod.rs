//! Environments to generate scripts from.

use pydslrep_analysis::environment::{
    Environment, Movement, Objects, ResolvedAction, ResolvedActionKind, Robot, Ros2, Sensor, SensorKind,
    Source, Wheel,
};
use pydslrep_kinematics::Drive;

/// A line of the environment's own file.
pub(crate) fn line(line: u32) -> Source {
    Source { file: None, line }
}

/// A robot with wheels named as in the paper.
pub(crate) fn robot(name: &str, drive: Drive, port: u16) -> Robot {
    let wheels: &[&str] = match drive.wheel_count() {
        2 => &["wheelL", "wheelR"],
        _ => &["wheelL0", "wheelL1", "wheelR0", "wheelR1"],
    };
    Robot {
        name: name.to_owned(),
        drive,
        port,
        objects: Objects::new(),
        ros2: Ros2::new(),
        mounts: Vec::new(),
        wheels: wheels.iter().map(|&name| Wheel { name: name.to_owned(), radius: 0.045 }).collect(),
        sensors: Vec::new(),
        source: line(4),
    }
}

/// The same robot with distance sensors.
pub(crate) fn with_sensors(mut robot: Robot, names: &[&str]) -> Robot {
    robot.sensors =
        names.iter().map(|name| Sensor { name: (*name).to_owned(), kind: SensorKind::Distance }).collect();
    robot
}

/// An action; its movement numbers it.
pub(crate) fn action(kind: ResolvedActionKind, text: String, at: u32) -> ResolvedAction {
    ResolvedAction { number: 0, kind, text, source: line(at) }
}

/// `move D meters`, at the default speed.
pub(crate) fn move_by(distance: f64, at: u32) -> ResolvedAction {
    let kind = ResolvedActionKind::Move { distance: Some(distance), speed: 0.09, until: None };
    action(kind, format!("move {distance:?} meters"), at)
}

/// `move D meters at V`, V in cm/s.
pub(crate) fn move_at(distance: f64, speed: f64, at: u32) -> ResolvedAction {
    let kind = ResolvedActionKind::Move { distance: Some(distance), speed: speed / 100.0, until: None };
    action(kind, format!("move {distance:?} meters at {speed:?}"), at)
}

/// `turn left A` or `turn right A`, A in degrees.
pub(crate) fn turn(degrees: f64, at: u32) -> ResolvedAction {
    let side = if degrees < 0.0 { "right" } else { "left" };
    let text = format!("turn {side} {:?}", degrees.abs());
    let turn = ResolvedActionKind::Turn {
        left: degrees >= 0.0,
        degrees: Some(degrees.abs()),
        circle: None,
        speed: 0.09,
        until: None,
    };
    action(turn, text, at)
}

/// `turn right until { … }`; `sensors` are indices and `names` their text.
pub(crate) fn turn_until(sensors: &[usize], names: &str, at: u32) -> ResolvedAction {
    let kind = ResolvedActionKind::TurnUntil { left: false, sensors: sensors.to_vec() };
    action(kind, format!("turn right until {{{names}}}"), at)
}

/// A movement of the robot with that index.
pub(crate) fn movement(name: &str, robot: usize, mut actions: Vec<ResolvedAction>) -> Movement {
    for (action, number) in actions.iter_mut().zip(1..) {
        action.number = number;
    }
    Movement { name: name.to_owned(), robot, actions, source: line(6) }
}

/// An environment on this machine.
pub(crate) fn environment(
    name: &str,
    robots: Vec<Robot>,
    movements: Vec<Movement>,
    schedule: Vec<Vec<usize>>,
) -> Environment {
    let (name, script) = (name.to_owned(), name.to_owned());
    Environment { name, script, host: None, robots, movements, schedule, source: line(14) }
}

/// Table 2 of the paper: three sides of a square.
pub(crate) fn area_1(drive: Drive) -> Environment {
    let actions = vec![
        move_by(4.0, 7),
        turn(-90.0, 8),
        move_by(4.0, 9),
        turn(-90.0, 10),
        ResolvedAction { text: "move 400.0 centimeters".to_owned(), ..move_by(4.0, 11) },
    ];
    environment(
        "area_1",
        vec![robot("robot_1", drive, 19999)],
        vec![movement("mov_1", 0, actions)],
        vec![vec![0]],
    )
}

/// Table 6: turns until sensors are clear.
pub(crate) fn sensors() -> Environment {
    let robot = with_sensors(robot("robot_1", Drive::TwoWheel, 19999), &["fSensor", "lSensor", "rSensor"]);
    let actions = vec![
        move_by(4.0, 15),
        turn_until(&[0, 2], "fSensor, rSensor", 16),
        move_by(4.0, 17),
        turn_until(&[0, 2], "fSensor, rSensor", 18),
        move_by(4.0, 19),
    ];
    environment("sensors", vec![robot], vec![movement("mov_1", 0, actions)], vec![vec![0]])
}

/// Table 7: explores.
pub(crate) fn slam() -> Environment {
    let names = ["fSensor0", "fSensor1", "fSensor2", "lSensor", "rSensor"];
    let robot = with_sensors(robot("robot_1", Drive::TwoWheel, 19999), &names);
    let explore = action(ResolvedActionKind::Slam, "slam".to_owned(), 14);
    environment("rooms", vec![robot], vec![movement("mov_1", 0, vec![explore])], vec![vec![0]])
}

/// Four robots of all kinds that drive in parallel, then one alone.
pub(crate) fn four_robots() -> Environment {
    let robots = vec![
        robot("robot_1", Drive::TwoWheel, 19997),
        robot("robot_2", Drive::FourWheel, 19998),
        robot("robot_3", Drive::Mecanum, 19999),
        robot("robot_4", Drive::TwoWheel, 20000),
    ];
    let movements = vec![
        movement("mov_1", 0, vec![move_by(1.0, 20), turn(90.0, 21), move_at(0.5, 20.0, 22)]),
        movement("mov_2", 1, vec![turn(45.0, 26), move_by(0.7, 27)]),
        movement("mov_3", 2, vec![move_by(-0.8, 31), turn(-120.0, 32), move_by(0.3, 33)]),
        movement("mov_4", 3, vec![turn(-30.5, 37), move_by(0.6, 38)]),
        movement("back", 0, vec![turn(180.0, 42), move_by(0.5, 43)]),
    ];
    environment("factory", robots, movements, vec![vec![0, 1, 2, 3], vec![4]])
}
