//! The last valid state of movements, so that poses stay visible while the program has errors.

use pydslrep_analysis::environment::{Movement, ResolvedActionKind, Robot};
use pydslrep_analysis::{Database, Driver, FileId};
use pydslrep_kinematics::Pose;
use pydslrep_syntax::Span;
use pydslrep_syntax::ast;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use super::plan::{KnownStep, PlannedStep, Planner, Start};
use super::steps::Step;
use super::{InlayHint, lines};

/// More than any screen shows: for larger requests no lines are kept.
const MAX_HINTS: usize = 2_000;

/// The movements of one file at the last request for hints, by name. Keep it with the open document and pass it to each
/// request, so that hints survive errors.
#[derive(Debug, Default)]
pub struct KnownMovements {
    by_name: FxHashMap<SmolStr, KnownMovement>,
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
struct KnownMovement {
    /// The last valid robot.
    robot: Robot,
    steps: Vec<KnownStep>,
}

/// The plan of a movement.
#[derive(Debug)]
pub(super) struct Route<'a> {
    /// Its robot, or the last valid one, if there was one.
    pub(super) robot: Option<Robot>,
    pub(super) steps: Vec<PlannedStep<'a>>,
    /// Why poses depend on the world, from some step on.
    pub(super) reasons: Vec<String>,
}

impl KnownMovements {
    /// The last valid robot of a movement.
    pub(super) fn robot(&self, name: &SmolStr) -> Option<&Robot> {
        self.by_name.get(name).map(|known| &known.robot)
    }

    /// Plans a movement and remembers the result; `robot` is `None` while the current one is invalid. `done` are the movements
    /// that it does.
    pub(super) fn plan<'a>(
        &mut self,
        name: &SmolStr,
        robot: Option<Robot>,
        steps: Vec<Step<'a>>,
        done: &[Movement],
        reason: &dyn Fn(&ResolvedActionKind, &ast::Action) -> String,
    ) -> Route<'a> {
        let before = self.by_name.remove(name);
        let robot = robot.filter(|robot| Driver::new(robot).is_ok());
        let is_old = robot.is_none();
        let (robot, known) = match before {
            Some(known) => (robot.or(Some(known.robot)), known.steps),
            None => (robot, Vec::new()),
        };
        let driver = robot.as_ref().and_then(|robot| Driver::new(robot).ok());
        let driver = driver.map(|driver| driver.with_done(done));
        let mut planner = Planner { driver: driver.as_ref(), reason, reasons: Vec::new() };
        let start = Start::At { pose: Pose::default(), is_old };
        let (steps, remembered, _) = planner.plan(steps, &known, start);
        let reasons = planner.reasons;
        if let Some(robot) = robot.clone().filter(|_| driver.is_some()) {
            self.by_name.insert(name.clone(), KnownMovement { robot, steps: remembered });
        }
        Route { robot, steps, reasons }
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
