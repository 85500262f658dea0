//! The commands of the legacy remote API on objects; commands about time are in `handler`.

use nalgebra::Vector3;

use super::super::arguments::angles;
use super::super::calls::CallContext;
use super::super::info;
use super::super::objects::{Handle, Kind};
use super::message::{Name, Outcome, fraction, number};

/// Parameters of engines before 4.3, in addition to current ones.
const PARAM_MOTOR_ENABLED: i64 = 2000;
const PARAM_ABSOLUTE_VELOCITY: [i64; 3] = [11, 12, 13];

/// Executes a command. Unknown commands, and commands that do not fit their object, fail.
pub(super) fn execute(context: &mut CallContext, name: &Name, payload: &[u8]) -> Outcome {
    known(context, name, payload).unwrap_or_else(Outcome::failure)
}

fn known(context: &mut CallContext, name: &Name, payload: &[u8]) -> Option<Outcome> {
    let whole = |at: usize| number(&name.key, at).map(i64::from);
    match name.kind {
        // Number of last errors.
        0x0004 => Some(Outcome::number(0)),
        0x1001 => {
            let joint = context.joint_of(whole(0)?)?;
            Some(Outcome::fractions([joint.axis_sign * context.world.angle(joint.robot, joint.wheel)]))
        }
        0x1008 => set_target_velocity(context, whole(0)?, fraction(payload, 0)?),
        0x1009 => read_proximity_sensor(context, whole(0)?),
        0x1012 => {
            let parent = context.objects.get(whole(0)?)?.parent;
            Some(Outcome::number(parent.map_or(-1, to_handle)))
        }
        0x101f => (whole(0)? == info::PARAM_REAL_TIME).then(|| Outcome::number(1)),
        // The pace of the clock is an option of the simulator.
        0x1020 => (whole(0)? == info::PARAM_REAL_TIME).then(Outcome::done),
        0x1021 => (whole(0)? == info::PARAM_PROGRAM_VERSION)
            .then(|| Outcome::number(to_handle(info::PROGRAM_VERSION))),
        0x1023 => {
            (whole(0)? == info::PARAM_TIME_STEP).then(|| Outcome::fractions([context.world.step_length()]))
        }
        0x102a => Some(objects_of_type(context, whole(0)?)),
        0x1036 => {
            let Kind::Robot(robot) = context.objects.get(whole(0)?)?.kind else { return None };
            Some(Outcome::fractions(context.velocity_of(robot).iter().flatten().copied()))
        }
        0x2007 => float_parameter(context, whole(0)?, whole(4)?),
        0x2008 => int_parameter(context, whole(0)?, whole(4)?),
        0x200d | 0x200e | 0x2801 => Some(place(context, name.kind, whole(0)?, whole(4)?)),
        0x3001 => Some(handle_of(context, &name.key)),
        // There is no window for messages.
        0x3008 => Some(Outcome::done()),
        _ => None,
    }
}

/// Handles are small; others are invalid.
fn to_handle(handle: Handle) -> i32 {
    i32::try_from(handle).unwrap_or(-1)
}

fn set_target_velocity(context: &mut CallContext, handle: Handle, rate: f64) -> Option<Outcome> {
    let joint = context.joint_of(handle)?;
    rate.is_finite().then(|| {
        context.set_rate(joint, rate);
        Outcome::done()
    })
}

/// State, point in the sensor's frame, handle of the detected object, surface normal.
fn read_proximity_sensor(context: &mut CallContext, handle: Handle) -> Option<Outcome> {
    let Kind::Sensor { .. } = context.objects.get(handle)?.kind else { return None };
    let mut payload = vec![0; 29];
    payload[13..17].copy_from_slice(&(-1_i32).to_le_bytes());
    if let Some(seen) = context.detected(handle) {
        payload[0] = 1;
        payload[1..13].copy_from_slice(&vector(seen.point));
        payload[13..17].copy_from_slice(&to_handle(seen.handle).to_le_bytes());
        payload[17..].copy_from_slice(&vector(seen.normal));
    }
    let outcome = Outcome { payload, failed: false };
    if context.has_handled_sensors() {
        return Some(outcome);
    }
    let mut blind = outcome.but_failed();
    blind.payload[0] = 0xff;
    Some(blind)
}

/// Three 32-bit floats.
fn vector(vector: Vector3<f64>) -> Vec<u8> {
    #[allow(clippy::cast_possible_truncation)] // a point within a sensor's range
    vector.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect()
}

fn objects_of_type(context: &CallContext, kind: i64) -> Outcome {
    let of_type = context.objects.iter().filter(|(_, object)| object.type_number() == kind);
    let handles: Vec<i32> = of_type.map(|(handle, _)| to_handle(handle)).collect();
    let count = i32::try_from(handles.len()).unwrap_or(i32::MAX);
    let payload = std::iter::once(count).chain(handles).flat_map(i32::to_le_bytes).collect();
    Outcome { payload, failed: false }
}

fn float_parameter(context: &CallContext, handle: Handle, parameter: i64) -> Option<Outcome> {
    let value = match context.objects.get(handle)?.kind {
        Kind::Wheel { .. } if parameter == info::PARAM_VELOCITY => {
            let joint = context.joint_of(handle)?;
            joint.axis_sign * context.world.rate(joint.robot, joint.wheel)
        }
        Kind::Robot(robot) => {
            let axis = PARAM_ABSOLUTE_VELOCITY.iter().position(|&known| known == parameter)?;
            context.velocity_of(robot)[0][axis]
        }
        _ => return None,
    };
    Some(Outcome::fractions([value]))
}

fn int_parameter(context: &CallContext, handle: Handle, parameter: i64) -> Option<Outcome> {
    let joint = context.joint_of(handle)?;
    let controlled = context.world.is_controlled(joint.robot, joint.wheel);
    match parameter {
        info::PARAM_CONTROL_MODE if controlled => Some(Outcome::number(to_handle(info::CONTROL_VELOCITY))),
        info::PARAM_CONTROL_MODE => Some(Outcome::number(to_handle(info::CONTROL_FREE))),
        PARAM_MOTOR_ENABLED => Some(Outcome::number(i32::from(controlled))),
        _ => None,
    }
}

/// Angles, position or quaternion of an object; zeros if there is no such object.
fn place(context: &CallContext, kind: u16, handle: Handle, base: Handle) -> Outcome {
    let Some(frame) = context.frame_of(handle, base) else {
        let count = if kind == 0x2801 { 4 } else { 3 };
        return Outcome::fractions(vec![0.0; count]).but_failed();
    };
    match kind {
        0x200d => Outcome::fractions(angles(&frame)),
        0x200e => Outcome::fractions(frame.translation.vector.iter().copied()),
        _ => Outcome::fractions(frame.rotation.coords.iter().copied()),
    }
}

/// Resolves a name as engines since 4.3 do: a path, or a name without slash, which may be anywhere.
fn handle_of(context: &CallContext, key: &[u8]) -> Outcome {
    let name = key.strip_suffix(b"\0").unwrap_or(key);
    let path = match std::str::from_utf8(name) {
        Ok(name) if name.starts_with('/') => name.to_owned(),
        Ok(name) if !name.contains('/') => format!("/{name}"),
        _ => String::new(),
    };
    match context.objects.find(&path, None, 0) {
        Some(handle) => Outcome::number(to_handle(handle)),
        None => Outcome::number(-1).but_failed(),
    }
}
