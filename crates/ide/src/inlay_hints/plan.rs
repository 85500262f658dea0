//! The plan of a movement that is being written. The first step after invalid code starts from its last known pose; the
//! following ones are planned from there. Blocks are planned in their first round.

use std::sync::Arc;

use pydslrep_analysis::Driver;
use pydslrep_analysis::environment::ResolvedActionKind;
use pydslrep_kinematics::{Leg, Pose};
use pydslrep_syntax::ast;

use super::steps::{Step, StepKind};

/// The plan of one step.
#[derive(Debug)]
pub(super) struct PlannedStep<'a> {
    /// The planned action; `None` for invalid code between actions.
    pub(super) action: Option<&'a ast::Action>,
    pub(super) kind: Arc<StepKind>,
    /// Its leg; `None` if the end depends on the world or on invalid code. The poses are only valid for [`Start::At`].
    pub(super) leg: Option<Leg>,
    /// Its start pose.
    pub(super) start: Start,
    /// Why poses after it depend on the world, if it is the first such step. If what is in its only block is the cause, that
    /// says so.
    pub(super) opens: Option<usize>,
    /// The steps of its blocks.
    pub(super) blocks: Vec<Vec<PlannedStep<'a>>>,
}

/// The start pose of a step.
#[derive(Debug, Clone, Copy)]
pub(super) enum Start {
    /// Planned, now or in the last valid version.
    At { pose: Pose, is_old: bool },
    /// Depends on the world, for the reason with this index.
    Open { why: usize },
    /// Depends on invalid code.
    Broken,
}

/// A step of the last version, with those of its blocks.
#[derive(Debug, Clone)]
pub(super) struct KnownStep {
    kind: Arc<StepKind>,
    from: Option<Pose>,
    blocks: Vec<Vec<KnownStep>>,
}

/// Plans the steps of one movement.
pub(super) struct Planner<'p> {
    /// `None` while the movement has had no robot that can drive.
    pub(super) driver: Option<&'p Driver>,
    /// Says why the end of an action depends on the world.
    pub(super) reason: &'p dyn Fn(&ResolvedActionKind, &ast::Action) -> String,
    /// The reasons so far.
    pub(super) reasons: Vec<String>,
}

impl Planner<'_> {
    /// Returns the plan of some steps, their known steps for the next time, and their end.
    pub(super) fn plan<'a>(
        &mut self,
        steps: Vec<Step<'a>>,
        known: &[KnownStep],
        mut start: Start,
    ) -> (Vec<PlannedStep<'a>>, Vec<KnownStep>, Start) {
        let former = Former::new(&steps, known);
        let mut planned = Vec::with_capacity(steps.len());
        let mut remembered: Vec<KnownStep> = Vec::with_capacity(steps.len());
        for step in steps {
            let is_more = is_more(remembered.last().map(|last| &*last.kind), &step.kind);
            let place = remembered.len() - usize::from(is_more);
            if let (Start::Broken, Some(pose)) = (start, former.start_of(place)) {
                start = Start::At { pose, is_old: true };
            }
            if !is_more {
                let from = match start {
                    Start::At { pose, .. } => Some(pose),
                    Start::Open { .. } | Start::Broken => None,
                };
                remembered.push(KnownStep { kind: Arc::clone(&step.kind), from, blocks: Vec::new() });
            }
            let Step { kind, action, blocks } = step;
            let before = remembered.last().map_or(0, |last| last.blocks.len());
            let known = former.blocks_of(place).get(before..).unwrap_or_default();
            let (blocks, known, ends) = self.blocks(blocks, known, start);
            let (leg, next, opens) = self.step(&kind, action, start, &ends);
            remembered.iter_mut().last().into_iter().for_each(|last| last.blocks.extend_from_slice(&known));
            planned.push(PlannedStep { action, kind, leg, start, opens, blocks });
            start = next;
        }
        (planned, remembered, start)
    }

    /// The same of the blocks of one step, all of which start alike.
    fn blocks<'a>(
        &mut self,
        blocks: Vec<Vec<Step<'a>>>,
        known: &[Vec<KnownStep>],
        start: Start,
    ) -> (Vec<Vec<PlannedStep<'a>>>, Vec<Vec<KnownStep>>, Vec<Start>) {
        if blocks.is_empty() {
            // Blocks that are not in sight keep their known steps.
            return (Vec::new(), known.to_vec(), Vec::new());
        }
        let (mut planned, mut remembered, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        for (index, steps) in blocks.into_iter().enumerate() {
            let known = known.get(index).map_or(&[][..], Vec::as_slice);
            let (block, known, end) = self.plan(steps, known, start);
            planned.push(block);
            remembered.push(known);
            ends.push(end);
        }
        (planned, remembered, ends)
    }

    /// The leg of a step, where the next one starts, and why later ones have no pose if this is the cause.
    fn step(
        &mut self,
        kind: &StepKind,
        action: Option<&ast::Action>,
        start: Start,
        ends: &[Start],
    ) -> (Option<Leg>, Start, Option<usize>) {
        let (Some(driver), Some(kind), Some(action)) = (self.driver, kind.action(), action) else {
            let next = if let Start::Open { .. } = start { start } else { Start::Broken };
            return (None, next, None);
        };
        let from = match start {
            Start::At { pose, .. } => pose,
            Start::Open { .. } | Start::Broken => Pose::default(),
        };
        let leg = driver.drive(from, kind);
        match (&leg, start) {
            (Some(leg), Start::At { is_old, .. }) => {
                let next = Start::At { pose: leg.to, is_old };
                (Some(leg.clone()), next, None)
            }
            (None, Start::At { .. } | Start::Broken) => {
                if let (ResolvedActionKind::Repeat { .. }, [Start::Open { why }]) = (kind, ends) {
                    return (None, Start::Open { why: *why }, None);
                }
                let why = self.reasons.len();
                self.reasons.push((self.reason)(kind, action));
                (None, Start::Open { why }, Some(why).filter(|_| matches!(start, Start::At { .. })))
            }
            (_, start) => (leg, start, None),
        }
    }
}

/// Returns whether a step only continues the invalid code before it: the number of such steps changes with every key.
fn is_more(before: Option<&StepKind>, kind: &StepKind) -> bool {
    matches!((before, kind), (Some(StepKind::Broken), StepKind::Broken))
}

/// Maps the places of steps to those in their last version by the common prefix and suffix of both lists; the changes are in
/// between. Invalid code has one place, however many steps it makes.
struct Former<'a> {
    known: &'a [KnownStep],
    count: usize,
    head: usize,
    tail: usize,
}

impl<'a> Former<'a> {
    fn new(steps: &[Step<'_>], known: &'a [KnownStep]) -> Self {
        let mut kinds: Vec<&StepKind> = Vec::with_capacity(steps.len());
        for step in steps {
            if !is_more(kinds.last().copied(), &step.kind) {
                kinds.push(&step.kind);
            }
        }
        let is_same = |(kind, known): &(&&StepKind, &KnownStep)| **kind == &*known.kind;
        let head = kinds.iter().zip(known).take_while(is_same).count();
        let rest = kinds[head..].iter().rev().zip(known[head..].iter().rev());
        let tail = rest.take_while(is_same).count();
        Self { known, count: kinds.len(), head, tail }
    }

    /// The last start pose at a place; also for the first changed one, whose predecessor is unchanged.
    fn start_of(&self, place: usize) -> Option<Pose> {
        self.known.get(if place <= self.head { place } else { self.unchanged(place)? })?.from
    }

    /// Returns the known blocks of a step; those of a changed step are at the same place.
    fn blocks_of(&self, place: usize) -> &'a [Vec<KnownStep>] {
        let known = self.known.get(self.unchanged(place).unwrap_or(place));
        known.map_or(&[], |known| known.blocks.as_slice())
    }

    /// Which one it was, if neither it nor any after it changed.
    fn unchanged(&self, place: usize) -> Option<usize> {
        let from_end = self.count - place;
        (from_end <= self.tail).then(|| self.known.len() - from_end)
    }
}
