//! Group "value": single numbers.

use crate::Finding;
use crate::program::{Action, ActionKind, Body, Condition, Length, Number, Rounds, Turn};
use crate::project::File;

pub(super) fn check(file: &File, findings: &mut Vec<Finding>) {
    for entity in &file.program.entities {
        match &entity.body {
            Body::Wheel(wheel) => findings.extend(radius(&wheel.radius)),
            Body::Robot(robot) => findings.extend(port(&robot.port, file.for_vrep)),
            Body::Ip(ip) if ip.address.text.split('.').any(|octet| !is_octet(octet)) => {
                findings.push(Finding::new("invalid-ip", &ip.address.range));
            }
            Body::Movement(movement) => {
                movement.statements().iter().for_each(|action| statement(action, findings));
            }
            _ => {}
        }
    }
}

fn statement(action: &Action, findings: &mut Vec<Finding>) {
    match &action.kind {
        ActionKind::Move { distance, speed, .. } => {
            findings.extend(distance.as_ref().and_then(self::distance));
            findings.extend(speed.as_ref().and_then(self::speed));
        }
        ActionKind::Turn(turn) => self::turn(turn, findings),
        ActionKind::Wait { seconds, .. } => findings.extend(seconds.as_ref().and_then(time)),
        ActionKind::Repeat { rounds: Rounds::Times(count), .. } => findings.extend(self::count(count)),
        _ => {}
    }
    findings.extend(action.condition().and_then(within));
}

fn turn(turn: &Turn, findings: &mut Vec<Finding>) {
    let angle = if turn.circle.is_some() { angle_on_circle } else { angle_in_place };
    findings.extend(turn.angle.as_ref().and_then(angle));
    findings.extend(turn.circle.as_ref().and_then(|circle| radius_of_circle(&circle.value)));
    findings.extend(turn.speed.as_ref().and_then(|clause| speed(&clause.value)));
    if turn.circle.is_none() {
        findings.extend(turn.reverse.as_ref().map(|place| Finding::new("invalid-arc", place)));
    }
}

/// Metres: 1 000 km.
pub(super) const MAX_DISTANCE: f64 = 1_000_000.0;

/// Non-finite numbers are out of range and have no other finding.
fn judge(number: &Number, code: impl Fn(f64) -> Option<&'static str>) -> Option<Finding> {
    let value = number.value();
    let code = if value.is_finite() { code(value)? } else { "number-out-of-range" };
    Some(Finding::new(code, &number.range))
}

/// Centimetres.
fn radius(number: &Number) -> Option<Finding> {
    judge(number, |centimetres| match centimetres {
        0.5..=100.0 => None,
        0.001..=100_000.0 => Some("implausible-radius"),
        _ => Some("invalid-radius"),
    })
}

/// A port may have any number of digits.
fn port(number: &Number, for_vrep: bool) -> Option<Finding> {
    let code = match port_number(number) {
        // V-REP's ports, although scripts are for CoppeliaSim.
        Some(19997..=19999) if !for_vrep => "port-of-other-target",
        Some(_) => return None,
        None => "invalid-port",
    };
    Some(Finding::new(code, &number.range))
}

/// `None` if it is no port.
pub(super) fn port_number(number: &Number) -> Option<u32> {
    let digits = number.text.trim_start_matches('0');
    digits.parse().ok().filter(|port| digits.len() <= 5 && (1..=65535).contains(port))
}

fn is_octet(digits: &str) -> bool {
    let digits = digits.trim_start_matches('0');
    digits.is_empty() || digits.parse::<u8>().is_ok()
}

/// Beyond 1 000 km, or zero.
fn distance(length: &Length) -> Option<Finding> {
    judge(&length.number, |value| {
        if length.value().abs() > MAX_DISTANCE {
            Some("number-out-of-range")
        } else {
            (value == 0.0).then_some("zero-distance")
        }
    })
}

/// Beyond 1 000 km, or not positive.
fn within(condition: &Condition) -> Option<Finding> {
    let length = &condition.within.as_ref()?.value;
    judge(&length.number, |value| {
        if length.value().abs() > MAX_DISTANCE {
            Some("number-out-of-range")
        } else {
            (value <= 0.0).then_some("invalid-within")
        }
    })
}

/// Centimetres per second; robots have at most 10 000.
fn speed(number: &Number) -> Option<Finding> {
    judge(number, |speed| (!(0.001..=10_000.0).contains(&speed)).then_some("invalid-speed"))
}

/// Degrees: zero, negative, or more than a full turn.
fn angle_in_place(number: &Number) -> Option<Finding> {
    judge(number, |degrees| (degrees <= 0.0 || degrees > 360.0).then_some("invalid-angle"))
}

/// Not positive, or beyond 1 000 km.
fn radius_of_circle(length: &Length) -> Option<Finding> {
    judge(&length.number, |value| (value <= 0.0 || length.value() > MAX_DISTANCE).then_some("invalid-arc"))
}

/// Degrees on a circle: zero, negative, or more than any robot turns. Several turns are possible there.
fn angle_on_circle(number: &Number) -> Option<Finding> {
    judge(number, |degrees| {
        if degrees == 0.0 {
            Some("invalid-arc")
        } else {
            (!(0.0..=36_000.0).contains(&degrees)).then_some("invalid-angle")
        }
    })
}

/// Seconds: zero, negative, or more than a day.
fn time(number: &Number) -> Option<Finding> {
    judge(number, |seconds| (seconds <= 0.0 || seconds > 86_400.0).then_some("invalid-time"))
}

/// No whole number from 1 to 10 000, or 1.
fn count(number: &Number) -> Option<Finding> {
    judge(number, |count| {
        (count.fract() != 0.0 || !(2.0..=10_000.0).contains(&count)).then_some("invalid-count")
    })
}
