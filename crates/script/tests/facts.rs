//! The facts that this program shares with the package that scripts import: written from the tables here
//! (`UPDATE_EXPECT=1 cargo test -p pydslrep-script --test facts`).

use std::fmt::Write;

use expect_test::expect_file;
use pydslrep_kinematics::{Drive, motion};
use pydslrep_scene::{SCHEMA, SensorKind, defaults};

#[test]
fn the_package_has_the_types_of_robots_and_the_figures_of_this_program() {
    expect_file!["../../../python/pydslrep_runtime/facts.py"].assert_eq(&(figures() + &robot_types()));
}

#[test]
fn a_long_tuple_has_a_line_for_each_item() {
    let items = |count: usize| vec!["\"right_middle\"".to_owned(); count];
    assert_eq!(tuple("wheels", &items(2)), "(\"right_middle\", \"right_middle\")");
    let last_on_a_line = tuple("wheels", &items(4));
    assert_eq!((last_on_a_line.lines().count(), last_on_a_line.len()), (1, 64));
    assert_eq!(
        tuple("wheels", &items(5)),
        format!("(\n{}        )", "            \"right_middle\",\n".repeat(5))
    );
}

fn figures() -> String {
    format!(
        r#""""Types of robots, and figures of scenes and motion, as the command has them.

A test of the command writes this file, crates/script/tests/facts.rs: do not change it here.
"""

import math
from typing import Literal, NamedTuple

STEP = {step:?}  # s of simulation time, unless a scene has other steps
RIM_SPEED = {speed:?}  # m/s at the wheels' rims, in turns and in moves without a speed
RIM_ACCELERATION = {acceleration:?}  # m/s² at the rims, when accelerating and braking
MOTOR_ACCELERATION = {motor:?}  # m/s² at the rims, at most, unless a scene has it
SENSOR_RANGE = {range:?}  # m of a distance sensor, unless a scene has it
SENSOR_CONE = math.radians({cone:?})  # opening angle of a sensor, unless a scene has it
TRACK = {track:?}  # m between left and right wheels, unless a scene has it
WHEELBASE = {wheelbase:?}  # m between front and rear wheels, unless a scene has it

# What a robot is like in ROS 2, unless a scene has it.
{ros2}"#,
        step = motion::STEP,
        speed = motion::RIM_SPEED,
        acceleration = motion::RIM_ACCELERATION,
        motor = defaults::MOTOR_ACCELERATION,
        range = defaults::range(SensorKind::Distance),
        cone = defaults::CONE_DEGREES,
        track = defaults::GEOMETRY.track,
        wheelbase = defaults::GEOMETRY.wheelbase,
        ros2 = ros2(),
    )
}

/// The defaults of the keys of scenes that have one.
fn ros2() -> String {
    let keys = SCHEMA.table("robots.NAME.ros2").into_iter().flat_map(|table| table.keys);
    let defaults = keys.filter_map(|key| Some((key.name, key.default_value()?)));
    let line = |(name, value): (&str, &str)| {
        let value = if value == "false" { "False" } else { value };
        format!("ROS2_{} = {value}\n", name.to_uppercase().replace('-', "_"))
    };
    defaults.map(line).collect()
}

/// A tuple after the name of a field, on as many lines as ruff's formatter writes it.
fn tuple(field: &str, items: &[String]) -> String {
    const COLUMNS: usize = 88;
    let line = format!("({})", items.join(", "));
    if format!("        {field}={line},").len() <= COLUMNS {
        return line;
    }
    let lines: Vec<String> = items.iter().map(|item| format!("            {item},\n")).collect();
    format!("(\n{}        )", lines.concat())
}

fn robot_types() -> String {
    let words = Drive::ALL.map(|drive| format!("\"{}\"", drive.word())).join(", ");
    let mut text = format!(
        r#"
TypeName = Literal[{words}]


class RobotType(NamedTuple):
    """What tells a type of robot apart from the others."""

    robot: str  # the class that scripts make robots of
    drive: str  # the class that drives them
    number: str  # of its wheels, in words
    wheels: tuple[str, ...]  # their places in order
    pushes: tuple[float, ...]  # to the left, as a share of that ahead
    mecanum: bool
    one_axle: bool  # so that casters must support it
    scrubs: bool  # whether wheels slide sideways in turns
    grip: float  # as in a scene, unless that says otherwise


ROBOT_TYPES: dict[TypeName, RobotType] = {{
"#
    );
    for drive in Drive::ALL {
        let row = drive.row();
        let places = row.wheels.iter();
        let _ = write!(
            text,
            r#"    "{}": RobotType(
        robot="{}",
        drive="{}",
        number="{}",
        wheels={},
        pushes={},
        mecanum={},
        one_axle={},
        scrubs={},
        grip={:?},
    ),
"#,
            row.word,
            row.class,
            row.runtime_drive,
            row.count,
            tuple(
                "wheels",
                &places.clone().map(|place| format!("\"{}\"", place.identifier)).collect::<Vec<_>>()
            ),
            tuple("pushes", &places.map(|place| format!("{:?}", place.push)).collect::<Vec<_>>()),
            python(row.mecanum),
            python(!row.has_wheelbase()),
            python(row.scrubs()),
            row.lateral_friction,
        );
    }
    text + "}\n"
}

fn python(truth: bool) -> &'static str {
    if truth { "True" } else { "False" }
}
