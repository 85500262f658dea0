//! The statements of a movement: actions, and statements with actions inside.

use crate::MotionPrimitive;

/// A statement of a movement.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Its place in its movement, from 0, in text order; statements with blocks count, and so do those inside.
    pub number: usize,
    /// Its kind.
    pub kind: StepKind,
}

/// The kind of a statement.
#[derive(Debug, Clone, PartialEq)]
pub enum StepKind {
    /// An action.
    Action(MotionPrimitive),
    /// An action that a condition may end early.
    Until {
        /// The action without its condition: what it does at most.
        limit: MotionPrimitive,
    },
    /// Its body, so many times.
    Repeat {
        /// The number of rounds.
        count: u32,
        /// The repeated steps.
        body: Vec<Step>,
    },
    /// One of several ways; the world decides which. A way that does nothing is empty. A chain of `else if` is one step with
    /// many ways, so that it is as deep as it looks.
    Branch {
        /// The ways.
        ways: Vec<Vec<Step>>,
    },
    /// The steps of another movement of the same robot.
    Call {
        /// Which one, by the list that the plan is made with. Nobody can plan a call of a movement that is not listed before
        /// the one that calls it: its end is unknown.
        movement: usize,
    },
}

/// A movement of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// Which robot.
    pub robot: usize,
    /// Its steps, in order.
    pub steps: Vec<Step>,
}

impl Step {
    /// Actions without any statement around them.
    pub fn flat(actions: &[MotionPrimitive]) -> Vec<Self> {
        let step = |(number, &action)| Self { number, kind: StepKind::Action(action) };
        actions.iter().enumerate().map(step).collect()
    }
}
