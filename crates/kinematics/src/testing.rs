//! Steps for tests, written by hand.

use std::f64::consts::FRAC_PI_2;

use crate::{Drive, Geometry, Model, MotionPrimitive, Step, StepKind, motion};

pub(crate) fn two_wheels() -> Model {
    Model::new(Drive::TwoWheel, &[0.045, 0.045], Geometry { track: 0.30, wheelbase: 0.25 }).unwrap()
}

/// Gives steps their numbers, in text order.
pub(crate) fn numbered(mut steps: Vec<Step>) -> Vec<Step> {
    fn number(steps: &mut [Step], next: &mut usize) {
        for step in steps {
            step.number = *next;
            *next += 1;
            match &mut step.kind {
                StepKind::Repeat { body, .. } => number(body, next),
                StepKind::Branch { ways } => ways.iter_mut().for_each(|way| number(way, next)),
                _ => {}
            }
        }
    }
    number(&mut steps, &mut 0);
    steps
}

pub(crate) fn step(kind: StepKind) -> Step {
    Step { number: 0, kind }
}

pub(crate) fn forward(distance: f64) -> Step {
    step(StepKind::Action(MotionPrimitive::Move { distance, speed: 0.09 }))
}

pub(crate) fn turn(degrees: f64) -> Step {
    step(StepKind::Action(MotionPrimitive::Turn { angle: degrees.to_radians(), speed: motion::RIM_SPEED }))
}

pub(crate) fn left() -> Step {
    step(StepKind::Action(MotionPrimitive::Turn { angle: FRAC_PI_2, speed: motion::RIM_SPEED }))
}

pub(crate) fn arc(degrees: f64, radius: f64, speed: f64) -> Step {
    step(StepKind::Action(MotionPrimitive::Arc {
        angle: degrees.to_radians(),
        radius,
        speed,
        reverse: false,
    }))
}

pub(crate) fn wait(seconds: f64) -> Step {
    step(StepKind::Action(MotionPrimitive::Wait { seconds }))
}

pub(crate) fn slam() -> Step {
    step(StepKind::Action(MotionPrimitive::Unknown { reach: 0.0 }))
}

pub(crate) fn until(distance: f64) -> Step {
    step(StepKind::Until { limit: MotionPrimitive::Move { distance, speed: 0.09 } })
}

pub(crate) fn repeat(count: u32, body: Vec<Step>) -> Step {
    step(StepKind::Repeat { count, body })
}

pub(crate) fn either(ways: Vec<Vec<Step>>) -> Step {
    step(StepKind::Branch { ways })
}

pub(crate) fn call(movement: usize) -> Step {
    step(StepKind::Call { movement })
}
