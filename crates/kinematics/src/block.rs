//! Steps with what they come to: computed once, however often they are repeated or called.

use crate::action::Course;
use crate::summary::{Motion, Summary};
use crate::{Model, MotionPrimitive, Pose, Step, StepKind};

/// A sequence of steps, as one robot does them. Steps without an entry in a plan are left out, so that a look at every
/// round costs no more than its entries.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(crate) nodes: Vec<Node>,
    pub(crate) summary: Summary,
}

/// A step of a [`Block`].
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) number: usize,
    pub(crate) kind: NodeKind,
    pub(crate) summary: Summary,
}

#[derive(Debug)]
pub(crate) enum NodeKind {
    /// Boxed, as the largest of them.
    Course(Box<Course>),
    /// It ends at the latest when its course does, if it has one.
    Unknown(Option<Box<Course>>),
    Repeat {
        count: u32,
        body: Block,
    },
    Branch {
        ways: Vec<Block>,
    },
    Call {
        movement: usize,
    },
}

impl Block {
    /// `called` has the summaries of the movements that can be called.
    pub(crate) fn new(model: &Model, steps: &[Step], called: &dyn Fn(usize) -> Option<Summary>) -> Self {
        let mut block = Self::default();
        for step in steps {
            let (kind, summary) = NodeKind::new(model, &step.kind, called);
            if summary.entries > 0 {
                block.summary = block.summary.then(&summary);
                block.nodes.push(Node { number: step.number, kind, summary });
            }
        }
        block
    }
}

impl NodeKind {
    fn new(model: &Model, step: &StepKind, called: &dyn Fn(usize) -> Option<Summary>) -> (Self, Summary) {
        match step {
            StepKind::Action(action) => match Course::new(model, *action) {
                Some(course) => {
                    let motion = Motion { change: course.end(Pose::default()), seconds: course.duration };
                    (Self::Course(Box::new(course)), Summary::known(motion, 1))
                }
                None => (Self::Unknown(None), Summary::unknown()),
            },
            StepKind::Until { limit } => (Self::until(model, *limit), Summary::unknown()),
            StepKind::Repeat { count, body } => {
                let body = Block::new(model, body, called);
                let summary = body.summary.repeated(*count);
                (Self::Repeat { count: *count, body }, summary)
            }
            StepKind::Branch { ways } => {
                let ways: Vec<Block> = ways.iter().map(|way| Block::new(model, way, called)).collect();
                let summaries: Vec<Summary> = ways.iter().map(|way| way.summary).collect();
                (Self::Branch { ways }, Summary::of_ways(&summaries))
            }
            StepKind::Call { movement } => match called(*movement) {
                Some(summary) => (Self::Call { movement: *movement }, summary),
                None => (Self::Unknown(None), Summary::unknown()),
            },
        }
    }

    fn until(model: &Model, limit: MotionPrimitive) -> Self {
        Self::Unknown(Course::new(model, limit).map(Box::new))
    }
}
