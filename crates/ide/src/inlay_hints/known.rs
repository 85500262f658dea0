//! The last valid state of movements, so that poses stay visible while the program has errors.
//!
//! A movement is a list of steps: its actions, and invalid code between them. The first step after invalid code starts
//! from its last known pose; the following ones are planned from there.

use pydslrep_analysis::environment::{ActionKind, Movement, Robot};
use pydslrep_analysis::{Database, Driver, FileId};
use pydslrep_kinematics::{Leg, Pose};
use pydslrep_syntax::Span;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use super::{InlayHint, lines};

/// More than any screen shows: for larger requests no lines are kept.
const MAX_HINTS: usize = 2_000;

/// The movements of one file at the last request for hints, by name. Keep it with the open document and pass it to each
/// request, so that hints survive errors.
#[derive(Debug, Default)]
pub struct KnownMovements {
    by_name: FxHashMap<SmolStr, Known>,
    /// The lines with hints.
    lines: Vec<KnownLine>,
}

/// A line with its hints; their offsets are relative to the start of the line.
#[derive(Debug)]
struct KnownLine {
    text: String,
    hints: Vec<InlayHint>,
}

/// The last state of a movement.
#[derive(Debug)]
struct Known {
    /// The last valid robot.
    robot: Robot,
    steps: Vec<KnownStep>,
}

#[derive(Debug)]
struct KnownStep {
    step: Step,
    from: Option<Pose>,
}

/// A part of a movement's body.
#[derive(Debug, Clone)]
pub(super) enum Step {
    /// A valid action.
    Action(ActionKind),
    /// A valid action that does other movements. They have numbers that change with what else is done, so it is known again
    /// by its text.
    Calling(ActionKind, String),
    /// Invalid code.
    Broken,
}

impl PartialEq for Step {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Action(kind), Self::Action(other)) => kind == other,
            (Self::Calling(_, text), Self::Calling(_, other)) => text == other,
            (Self::Broken, Self::Broken) => true,
            _ => false,
        }
    }
}

/// The plan of one step.
#[derive(Debug)]
pub(super) struct Planned {
    /// Its leg; `None` if the end depends on the world or on invalid code. The poses are only valid for [`Start::At`].
    pub(super) leg: Option<Leg>,
    /// Its start pose.
    pub(super) start: Start,
}

/// The start pose of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Start {
    /// Planned, now or in the last valid version.
    At { pose: Pose, is_old: bool },
    /// Depends on the world, from the step with this index on.
    Open { since: usize },
    /// Depends on invalid code.
    Broken,
}

/// The plan of a movement.
#[derive(Debug)]
pub(super) struct Route {
    /// Its robot, or the last valid one.
    pub(super) robot: Robot,
    /// One per step.
    pub(super) steps: Vec<Planned>,
}

impl KnownMovements {
    /// The last valid robot of a movement.
    pub(super) fn robot(&self, name: &SmolStr) -> Option<&Robot> {
        self.by_name.get(name).map(|known| &known.robot)
    }

    /// Plans a movement and remembers the result; `robot` is `None` while the current one is invalid. `done` are the movements
    /// that it does.
    pub(super) fn plan(
        &mut self,
        name: &SmolStr,
        robot: Option<Robot>,
        steps: Vec<Step>,
        done: &[Movement],
    ) -> Option<Route> {
        let before = self.by_name.remove(name);
        let live = robot.and_then(|robot| Some((Driver::new(&robot).ok()?, robot, false)));
        let (driver, robot, is_old) = match (live, &before) {
            (Some(live), _) => live,
            (None, Some(known)) => (Driver::new(&known.robot).ok()?, known.robot.clone(), true),
            (None, None) => return None,
        };
        let driver = driver.with_done(done);
        let known = before.map_or_else(Vec::new, |known| known.steps);
        let planned = plan(&driver, &steps, &known, is_old);
        let remembered = steps.into_iter().zip(&planned).map(|(step, planned)| {
            let from = match planned.start {
                Start::At { pose, .. } => Some(pose),
                Start::Open { .. } | Start::Broken => None,
            };
            KnownStep { step, from }
        });
        let remembered = Known { robot: robot.clone(), steps: remembered.collect() };
        self.by_name.insert(name.clone(), remembered);
        Some(Route { robot, steps: planned })
    }

    /// Restores the last hints of the lines that an edit above them invalidates, and remembers all hints.
    pub(super) fn restore(
        &mut self,
        database: &Database,
        file: FileId,
        affected: &[Span],
        hints: &mut Vec<InlayHint>,
    ) {
        if hints.len() > MAX_HINTS {
            self.lines.clear();
            return;
        }
        let mut now: Vec<(u32, KnownLine)> = Vec::new();
        for hint in hints.iter() {
            let line = lines(database, file, Span::at(hint.offset));
            let hint = InlayHint { offset: hint.offset - line.start, ..hint.clone() };
            if let Some((_, known)) = now.last_mut().filter(|(start, _)| *start == line.start) {
                known.hints.push(hint);
            } else {
                now.push((line.start, KnownLine { text: database.slice(file, line), hints: vec![hint] }));
            }
        }
        for line in affected {
            let place = now.partition_point(|(start, _)| *start < line.start);
            if now.get(place).is_some_and(|(start, _)| *start == line.start) {
                continue;
            }
            let text = database.slice(file, *line);
            let equal = now[..place].iter().filter(|(_, known)| known.text == text).count();
            if let Some(former) = self.lines.iter().filter(|known| known.text == text).nth(equal) {
                let restored = former.hints.iter();
                let restored =
                    restored.map(|hint| InlayHint { offset: hint.offset + line.start, ..hint.clone() });
                let at = hints.partition_point(|hint| hint.offset < line.start);
                hints.splice(at..at, restored);
                now.insert(place, (line.start, KnownLine { text, hints: former.hints.clone() }));
            }
        }
        self.lines = now.into_iter().map(|(_, known)| known).collect();
    }

    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.by_name.len()
    }

    /// Drops removed movements once there are many.
    pub(super) fn evict(&mut self, movements: u32, is_there: impl Fn(&SmolStr) -> bool) {
        if self.by_name.len() > 2 * movements as usize + 16 {
            self.by_name.retain(|name, _| is_there(name));
        }
    }
}

fn plan(driver: &Driver, steps: &[Step], known: &[KnownStep], is_old: bool) -> Vec<Planned> {
    let mut start = Start::At { pose: Pose::default(), is_old };
    let former = Former::new(steps, known);
    let mut planned = Vec::with_capacity(steps.len());
    for (index, step) in steps.iter().enumerate() {
        if start == Start::Broken
            && let Some(pose) = former.start_of(index)
        {
            start = Start::At { pose, is_old: true };
        }
        let (leg, next) = match (step, start) {
            (Step::Broken, Start::At { .. } | Start::Broken) => (None, Start::Broken),
            (Step::Broken, Start::Open { .. }) => (None, start),
            (Step::Action(action) | Step::Calling(action, _), _) => drive(driver, action, start, index),
        };
        planned.push(Planned { leg, start });
        start = next;
    }
    planned
}

fn drive(driver: &Driver, action: &ActionKind, start: Start, index: usize) -> (Option<Leg>, Start) {
    let from = match start {
        Start::At { pose, .. } => pose,
        Start::Open { .. } | Start::Broken => Pose::default(),
    };
    let leg = driver.drive(from, action);
    let next = match (&leg, start) {
        (Some(leg), Start::At { is_old, .. }) => Start::At { pose: leg.to, is_old },
        (None, Start::At { .. } | Start::Broken) => Start::Open { since: index },
        (_, start) => start,
    };
    (leg, next)
}

/// Maps steps to their last version by the common prefix and suffix of both lists; the changes are in between.
struct Former<'a> {
    known: &'a [KnownStep],
    count: usize,
    head: usize,
    tail: usize,
}

impl<'a> Former<'a> {
    fn new(steps: &[Step], known: &'a [KnownStep]) -> Self {
        let is_same = |(step, known): &(&Step, &KnownStep)| **step == known.step;
        let head = steps.iter().zip(known).take_while(is_same).count();
        let rest = steps[head..].iter().rev().zip(known[head..].iter().rev());
        let tail = rest.take_while(is_same).count();
        Self { known, count: steps.len(), head, tail }
    }

    /// The last start pose of a step; also for the first changed one, whose predecessor is unchanged.
    fn start_of(&self, index: usize) -> Option<Pose> {
        let former = if index <= self.head {
            index
        } else {
            let from_the_end = self.count - index;
            (from_the_end <= self.tail).then(|| self.known.len() - from_the_end)?
        };
        self.known.get(former)?.from
    }
}
