//! Group "robot": the lists of a robot.

use super::{is_among, repeated};
use crate::Finding;
use crate::program::{Action, Body, Entity, Name, Robot};
use crate::project::{Declared, Scope};
use crate::robot_types::{Layout, layouts};

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for entity in &scope.program().entities {
        match &entity.body {
            Body::Robot(robot) => check_robot(scope, entity, robot, findings),
            Body::Movement(movement) => {
                for condition in movement.statements().into_iter().filter_map(Action::condition) {
                    repeated_sensor(&condition.sensors, findings);
                }
            }
            _ => {}
        }
    }
}

fn check_robot(scope: Scope<'_>, entity: &Entity, robot: &Robot, findings: &mut Vec<Finding>) {
    wheel_count(robot, findings);
    wheel_kind_mismatch(scope, entity, robot, findings);
    mixed_radii(scope, robot, findings);
    for wheel in repeated(&robot.wheels) {
        findings.push(Finding::new("repeated-wheel", &wheel.range));
    }
    repeated_sensor(&robot.sensors, findings);
    wheel_order(robot, findings);
}

fn repeated_sensor(sensors: &[Name], findings: &mut Vec<Finding>) {
    findings.extend(repeated(sensors).map(|sensor| Finding::new("repeated-sensor", &sensor.range)));
}

/// As many as its type has; without `type` those of any are allowed.
fn wheel_count(robot: &Robot, findings: &mut Vec<Finding>) {
    if !has_right_count(robot) {
        findings.push(Finding::new("wheel-count", &robot.wheel_list));
    }
}

pub(super) fn has_right_count(robot: &Robot) -> bool {
    fitting(robot).next().is_some()
}

/// What its type or the lack of one allows, with as many wheels.
fn fitting(robot: &Robot) -> impl Iterator<Item = Layout> {
    let word = robot.drive.as_ref().map(|drive| drive.text.as_str());
    layouts(word).filter(|layout| layout.wheels == robot.wheels.len())
}

/// Warning: `fw` with four `wheelH`. Error: `fwh` with any `wheel`, `tw` with `wheelH`, mixed kinds.
///
/// A wrong number of wheels is a single error and does not imply one about their kinds.
fn wheel_kind_mismatch(scope: Scope<'_>, entity: &Entity, robot: &Robot, findings: &mut Vec<Finding>) {
    if !has_right_count(robot) {
        return;
    }
    let kinds = mecanum(scope, robot);
    if !fitting(robot).any(|layout| kinds.iter().all(|mecanum| *mecanum == layout.mecanum)) {
        let place = robot.drive.as_ref().map_or(&entity.name.range, |drive| &drive.range);
        findings.push(Finding::new("wheel-kind-mismatch", place));
    }
}

/// Whether each known wheel is a `wheelH`.
fn mecanum(scope: Scope<'_>, robot: &Robot) -> Vec<bool> {
    robot.wheels.iter().filter_map(|name| scope.wheel(&name.text)).map(|wheel| wheel.mecanum).collect()
}

/// The wheels of one robot differ in radius: reported at the first that differs from the previous ones.
#[allow(clippy::float_cmp, reason = "the specification requires exact comparison")]
fn mixed_radii(scope: Scope<'_>, robot: &Robot, findings: &mut Vec<Finding>) {
    let radius = |name: &Name| {
        let radius = scope.wheel(&name.text)?.radius.value();
        radius.is_finite().then_some(radius)
    };
    let radii: Vec<(&Name, f64)> =
        robot.wheels.iter().filter_map(|name| Some((name, radius(name)?))).collect();
    if let Some((name, _)) = radii.iter().find(|(_, radius)| *radius != radii[0].1) {
        findings.push(Finding::new("mixed-radii", &name.range));
    }
}

/// Two names that differ in exactly one letter, L or R (either case), are listed right before left: reported at the right
/// one.
fn wheel_order(robot: &Robot, findings: &mut Vec<Finding>) {
    for (index, name) in robot.wheels.iter().enumerate() {
        if robot.wheels[index..].iter().any(|later| is_right_of(&name.text, &later.text)) {
            findings.push(Finding::new("wheel-order", &name.range));
        }
    }
}

fn is_right_of(one: &str, other: &str) -> bool {
    let differences: Vec<(char, char)> = one.chars().zip(other.chars()).filter(|(a, b)| a != b).collect();
    one.len() == other.len()
        && differences.len() == 1
        && "Rr".contains(differences[0].0)
        && "Ll".contains(differences[0].1)
}

/// More than two wheels by its type, or by its wheels; with three wheels and no type it is incomplete.
pub(super) fn has_more_than_two_wheels(robot: &Robot) -> bool {
    match &robot.drive {
        Some(drive) => layouts(Some(&drive.text)).any(|layout| layout.wheels > 2),
        None => fitting(robot).any(|layout| layout.wheels > 2),
    }
}

/// The number of distinct distance sensors; `None` if a sensor is unknown.
pub(super) fn distance_sensors(robot: &Declared<'_, Robot>) -> Option<usize> {
    let mut count = 0;
    for (index, name) in robot.sensors.iter().enumerate() {
        let is_distance = !robot.home.sensor(&name.text)?.bumper;
        if is_distance && !is_among(name, &robot.sensors[..index]) {
            count += 1;
        }
    }
    Some(count)
}
