//! Group "value": single numbers.

use crate::Finding;
use crate::program::{ActionKind, Body, Number};
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
                for action in &movement.actions {
                    match &action.kind {
                        ActionKind::Move { distance, meters, speed } => {
                            findings.extend(self::distance(distance, *meters));
                            findings.extend(speed.as_ref().and_then(self::speed));
                        }
                        ActionKind::Turn { angle } => findings.extend(angle.as_ref().and_then(self::angle)),
                        ActionKind::TurnUntil { .. } | ActionKind::Slam => {}
                    }
                }
            }
            _ => {}
        }
    }
}

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
fn distance(number: &Number, meters: bool) -> Option<Finding> {
    judge(number, |value| {
        let metres = if meters { value } else { value / 100.0 };
        if metres.abs() > 1_000_000.0 {
            Some("number-out-of-range")
        } else {
            (value == 0.0).then_some("zero-distance")
        }
    })
}

/// Centimetres per second; robots have at most 10 000.
fn speed(number: &Number) -> Option<Finding> {
    judge(number, |speed| (!(0.001..=10_000.0).contains(&speed)).then_some("invalid-speed"))
}

/// Degrees: zero, negative, or more than a full turn.
fn angle(number: &Number) -> Option<Finding> {
    judge(number, |degrees| (degrees <= 0.0 || degrees > 360.0).then_some("invalid-angle"))
}
