//! Writes scripts for many kinds of environments into a folder; `python/check_scripts.py` runs ruff and mypy on them.

#[path = "../tests/common/mod.rs"]
mod common;

use std::{env, error::Error, fs, path::Path};

use common::{
    area_1, environment, four_robots, move_at, move_by, movement, robot, sensors, slam, turn, turn_until,
    with_sensors,
};
use pydslrep_analysis::environment::{Environment, ResolvedAction, SensorKind, Source};
use pydslrep_kinematics::Drive;
use pydslrep_script::{Target, file_name, generate};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args().nth(1).ok_or("usage: variants FOLDER")?;
    for environment in variants() {
        for target in Target::ALL {
            let script = generate(&environment, target, &format!("{}.pyr", environment.name))?;
            // Both are in one folder, where each needs a name of its own.
            let name = format!("{}_{}", target.word(), file_name(&environment));
            fs::write(Path::new(&folder).join(name), script)?;
        }
    }
    Ok(())
}

fn variants() -> Vec<Environment> {
    let named = |name: &str, environment: Environment| Environment {
        name: name.to_owned(),
        script: format!("{name}_env"),
        ..environment
    };
    let mut variants = vec![
        named("two_wheel", area_1(Drive::TwoWheel)),
        named("four_wheel", area_1(Drive::FourWheel)),
        named("mecanum", area_1(Drive::Mecanum)),
        sensors(),
        slam(),
        slam_and_more(),
        four_robots(),
        named("math", area_1(Drive::TwoWheel)),
        environment("nothing", vec![], vec![], vec![]),
        environment(
            "idle",
            vec![robot("r", Drive::FourWheel, 1)],
            vec![movement("m", 0, vec![])],
            vec![vec![0]],
        ),
        numbers(),
        imported(),
    ];
    variants.extend((1..=200).map(names_of));
    variants.extend((1..=30).map(many));
    variants
}

/// Numbers of all magnitudes.
fn numbers() -> Environment {
    let actions = [1e-9, 0.1 + 0.2, 1e6, 123_456.789_012_345, -1e-7]
        .iter()
        .flat_map(|&number| [move_by(number, 1), move_at(number, number.abs(), 2), turn(number, 3)])
        .collect();
    environment(
        "numbers",
        vec![robot("r", Drive::TwoWheel, 1)],
        vec![movement("m", 0, actions)],
        vec![vec![0]],
    )
}

/// Two robots that explore in parallel, one of which also turns until its sensors are clear.
fn slam_and_more() -> Environment {
    let mut environment = slam();
    "slam_and_more".clone_into(&mut environment.name);
    environment.script.clone_from(&environment.name);
    let other = with_sensors(robot("r", Drive::TwoWheel, 1), &["a", "b", "c", "d", "e"]);
    environment.robots.push(other);
    let mut explore = environment.movements[0].clone();
    explore.robot = 1;
    "mov_2".clone_into(&mut explore.name);
    explore.actions.push(turn_until(&[0], "a", 9));
    environment.movements.push(explore);
    environment.schedule = vec![vec![0, 1]];
    environment
}

/// Actions from another file with special characters in its name.
fn imported() -> Environment {
    let source = |line| Source { file: Some("größe/机器人.pyr".to_owned()), line };
    let actions: Vec<ResolvedAction> = (1..60)
        .map(|length| ResolvedAction { text: "x".repeat(length), source: source(1), ..move_by(1.0, 1) })
        .collect();
    environment(
        "imported",
        vec![robot("r", Drive::TwoWheel, 1)],
        vec![movement("m", 0, actions)],
        vec![vec![0]],
    )
}

/// So many robots that drive in parallel, each with as many sensors.
fn many(count: usize) -> Environment {
    let names: Vec<String> = (1..=count).map(|number| format!("s{number}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let drives = [Drive::TwoWheel, Drive::FourWheel, Drive::Mecanum].into_iter().cycle();
    let robots = drives.zip(1..=count).map(|(drive, number)| {
        let mut robot = with_sensors(robot(&format!("r{number}"), drive, 23000), &names);
        robot.sensors.iter_mut().step_by(2).for_each(|sensor| sensor.kind = SensorKind::Bumper);
        robot
    });
    let all: Vec<usize> = (0..count).collect();
    let action = || vec![turn_until(&all, &names.join(", "), 9)];
    let movements = (0..count).map(|index| movement(&format!("m{index}"), index, action()));
    let schedule = vec![all.clone(), vec![0]];
    environment(&format!("many_{count}"), robots.collect(), movements.collect(), schedule)
}

/// Names of a given length for the environment, wheels, sensors, robots and movements.
fn names_of(length: usize) -> Environment {
    // The last letter differs.
    let name = |last: &str| "n".repeat(length - 1) + last;
    let (long, other) = (name("a"), name("b"));
    let mut robots = vec![
        with_sensors(robot(&long, Drive::TwoWheel, 19997), &[&long, &other]),
        robot(&other, Drive::Mecanum, 19998),
    ];
    for robot in &mut robots {
        for (wheel, last) in robot.wheels.iter_mut().zip(["a", "b", "c", "d"]) {
            wheel.name = name(last);
        }
    }
    let until = |sensors: &[usize]| turn_until(sensors, &format!("{long}, {other}"), 9);
    let movements = vec![
        movement(&long, 0, vec![move_by(1.0, 8), until(&[0]), until(&[0, 1])]),
        movement(&other, 1, vec![turn(45.0, 8)]),
    ];
    let script = format!("names_{length}");
    Environment { script, ..environment(&long, robots, movements, vec![vec![0], vec![0, 1]]) }
}
