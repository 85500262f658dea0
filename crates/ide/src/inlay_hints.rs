//! Inlay hints: after each action its default speed or angle, its duration, and the pose at its end; in a block, that of the
//! first round, or of the case that it is done at all.
//!
//! Poses are relative to the start of the movement. Lines that are being edited or have errors show no hints; all other
//! lines keep theirs. Hints that depend on code with errors show their last valid value ([`KnownMovements`]); if there
//! never was one, only hints that are certain appear.

mod known;
mod plan;
mod steps;

use pydslrep_analysis::environment::ResolvedActionKind;
use pydslrep_analysis::{Database, EntityRef, FileId};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{self, Entity};
use smol_str::SmolStr;

pub use self::known::KnownMovements;
use self::known::Route;
use self::plan::{PlannedStep, Start};
use self::steps::{Body, calls};
use crate::hover::action::{describe_leg, open_end_reason, way_of};
use crate::hover::format::{number, short_pose, time};
use crate::hover::within::Within;

/// The label after an action with an unknown end pose.
const UNKNOWN: &str = "· pose unknown";

/// The enabled kinds of hints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InlayHintOptions {
    /// The pose after each action.
    pub pose: bool,
    /// The duration of each action.
    pub duration: bool,
    /// Omitted speeds and angles.
    pub defaults: bool,
}

impl Default for InlayHintOptions {
    fn default() -> Self {
        Self { pose: true, duration: true, defaults: true }
    }
}

/// The location of a request for hints.
#[derive(Debug, Clone, Copy)]
pub struct InlayHintPlaces<'a> {
    /// The file.
    pub file: FileId,
    /// The requested part of it.
    pub range: Span,
    /// The lines being edited, which show no hints.
    pub typed: &'a [Span],
}

/// A hint after an action.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InlayHint {
    /// The end of the action.
    pub offset: u32,
    /// The text shown.
    pub label: String,
    /// Markdown.
    pub tooltip: String,
    /// The text that makes the hint explicit in the program, if possible.
    pub insert: Option<String>,
}

/// The hints in a range, in text order. `known` holds the last valid state; it may be empty.
pub fn inlay_hints(
    database: &Database,
    places: InlayHintPlaces<'_>,
    options: InlayHintOptions,
    known: &mut KnownMovements,
) -> Vec<InlayHint> {
    let InlayHintPlaces { file, range, typed } = places;
    let is_wanted = options.pose || options.duration || options.defaults;
    let entities = database
        .entities_from(file, range.start.saturating_sub(1))
        .take_while(|entity| is_wanted && entity.span.start <= range.end);
    let mut hints = Vec::new();
    let mut errors = Vec::new();
    let mut broken = Vec::new();
    for entity in entities {
        errors.extend(database.errors(&entity));
        hints.extend(
            movement_hints(database, &entity, range, options, known, &mut broken).unwrap_or_default(),
        );
    }
    let (caused_by_edit, others): (Vec<Span>, Vec<Span>) =
        errors.into_iter().partition(|error| is_caused_by_edit(database, file, *error, typed));
    let line_of = |error: Span| lines(database, file, error);
    let affected: Vec<Span> = caused_by_edit.into_iter().chain(broken).map(line_of).collect();
    let others = others.into_iter().map(line_of).filter(|line| !affected.contains(line));
    let hidden: Vec<Span> = typed.iter().copied().chain(others).collect();
    hints.retain(|hint| !hidden.iter().any(|line| line.touches(hint.offset)));
    known.restore(database, file, &affected, &mut hints);
    let movements = database.count(file, pydslrep_syntax::EntityKind::Movement);
    known.evict(movements, |name| {
        !database.definitions(file, pydslrep_syntax::EntityKind::Movement, name).is_empty()
    });
    hints
}

/// Returns whether an error at the start of a line is caused by an edit of the line before: an incomplete `at` takes
/// the next token for its speed.
fn is_caused_by_edit(database: &Database, file: FileId, error: Span, typed: &[Span]) -> bool {
    let follows = |line: &Span| {
        line.end < error.start
            && database.slice(file, Span::new(line.end, error.start)).chars().all(char::is_whitespace)
    };
    // Bounded, because the text in between is read.
    typed.iter().filter(|line| error.start.saturating_sub(line.end) < 256).any(follows)
}

/// The full lines that a range touches, without the last line break.
pub(crate) fn lines(database: &Database, file: FileId, span: Span) -> Span {
    let Some(text) = database.text(file) else { return span };
    let line_of = |offset: u32| text.byte_to_line((offset as usize).min(text.len_bytes()));
    let start = text.line_to_byte(line_of(span.start));
    let last = text.line(line_of(span.end));
    let ending = last.chars_at(last.len_chars()).reversed().take_while(|c| matches!(c, '\n' | '\r')).count();
    let end = text.line_to_byte(line_of(span.end)) + last.len_bytes() - ending;
    (start..end).into()
}

/// The hints of a movement. The ends of actions that are broken only because of what is in their blocks, or of what they
/// do, are added to `broken`.
fn movement_hints(
    database: &Database,
    entity: &EntityRef<'_>,
    range: Span,
    options: InlayHintOptions,
    known: &mut KnownMovements,
    broken: &mut Vec<Span>,
) -> Option<Vec<InlayHint>> {
    let Some(Entity::Movement(tree)) = &entity.parse.entity else { return None };
    let back = |offset: u32| offset.saturating_sub(entity.span.start);
    let sight = Span::new(back(range.start), back(range.end));
    if !tree.actions.iter().any(|action| is_in(action.span, sight)) {
        return None;
    }
    let name = tree.name.as_ref().map_or_else(SmolStr::default, |name| name.text.clone());
    let robot = database.robot_of(entity.id);
    let statements = database.known_statements(entity.id, robot.as_ref().or(known.robot(&name)))?;
    let body = Body { database, entity: *entity, known: statements, sight };
    let steps = body.steps(tree.body?, &tree.actions);
    let reason = |kind: &ResolvedActionKind, action: &ast::Action| {
        open_end_reason(kind, &database.action_head(entity, action))
    };
    let route = known.plan(&name, robot, steps, body.known.done(), &reason);
    let mut hints = Vec::new();
    let writer = Writer { entity, sight, options, route: &route };
    writer.write(&route.steps, Within::default(), &mut hints, broken);
    Some(hints)
}

/// Returns whether a part of an entity is in sight.
fn is_in(part: Span, sight: Span) -> bool {
    part.start <= sight.end && sight.start <= part.end
}

/// Returns the nesting of the blocks of an action.
fn within_blocks(within: Within, action: &ast::Action) -> Within {
    match &action.kind {
        ast::ActionKind::Repeat(ast::Repeat { rounds: Some(ast::Rounds::Until(_)), .. }) => {
            within.rounds().condition()
        }
        ast::ActionKind::Repeat(_) => within.rounds(),
        _ => within.condition(),
    }
}

/// Writes the hints of one movement.
struct Writer<'a> {
    entity: &'a EntityRef<'a>,
    sight: Span,
    options: InlayHintOptions,
    route: &'a Route<'a>,
}

impl Writer<'_> {
    fn write(
        &self,
        steps: &[PlannedStep<'_>],
        within: Within,
        hints: &mut Vec<InlayHint>,
        broken: &mut Vec<Span>,
    ) {
        for step in steps {
            let Some(action) = step.action.filter(|action| is_in(action.span, self.sight)) else { continue };
            for block in &step.blocks {
                self.write(block, within_blocks(within, action), hints, broken);
            }
            if self.sight.touches(action.span.end) {
                self.write_step(step, action, within, hints, broken);
            }
        }
    }

    fn write_step(
        &self,
        step: &PlannedStep<'_>,
        action: &ast::Action,
        within: Within,
        hints: &mut Vec<InlayHint>,
        broken: &mut Vec<Span>,
    ) {
        let offset = action.span.end + self.entity.span.start;
        let Some(kind) = step.kind.action() else {
            if calls(action) || action.blocks().next().is_some() {
                broken.push(Span::at(offset));
            }
            return;
        };
        if let Some((label, insert)) = default_clause(action, kind).filter(|_| self.options.defaults) {
            let tooltip = "Default value".to_owned();
            hints.push(InlayHint { offset, label, tooltip, insert: Some(insert) });
        }
        if let Some((label, tooltip)) = self.pose_and_time(step, within) {
            hints.push(InlayHint { offset, label, tooltip, insert: None });
        }
    }

    /// The label and tooltip of a step.
    fn pose_and_time(&self, step: &PlannedStep<'_>, within: Within) -> Option<(String, String)> {
        let why = |why: usize| self.route.reasons.get(why).map_or("", String::as_str);
        let Some(leg) = &step.leg else {
            let label = self.options.pose.then(|| UNKNOWN.to_owned())?;
            return Some((label, format!("Poses from here on cannot be planned: {}.", why(step.opens?))));
        };
        // An invalid speed is reported as an error.
        if !leg.duration.is_finite() {
            return None;
        }
        let from = || format!("{} {}", within.opening(), way_of(leg));
        let (pose, poses) = match step.start {
            Start::At { is_old: false, .. } => (true, from()),
            Start::At { is_old: true, .. } => {
                (true, format!("{} Based on the last version without errors.", from()))
            }
            Start::Open { why: index } => {
                (false, format!("The start pose cannot be planned: {}.", why(index)))
            }
            Start::Broken => {
                (false, "The start pose cannot be planned because of an earlier error.".to_owned())
            }
        };
        let duration = self.options.duration.then(|| format!("· {}", time(leg.duration)));
        let pose = (self.options.pose && pose).then(|| format!("→ {}", short_pose(&leg.to)));
        let label: Vec<String> = duration.into_iter().chain(pose).collect();
        let robot = self.route.robot.as_ref().filter(|_| !label.is_empty())?;
        Some((label.join(" "), describe_leg(robot, leg, &poses)))
    }
}

/// The clause that an action omits: the label, and the text to insert.
fn default_clause(written: &ast::Action, action: &ResolvedActionKind) -> Option<(String, String)> {
    let text = match (&written.kind, action) {
        (
            ast::ActionKind::Move(ast::Move { speed: None, until: None, .. }),
            ResolvedActionKind::Move { speed, .. },
        ) => {
            let speed = number(speed * 100.0, 3);
            if speed.contains('.') { format!("at {speed}") } else { format!("at {speed}.0") }
        }
        (
            ast::ActionKind::Turn(turn),
            ResolvedActionKind::Turn { degrees: Some(degrees), until: None, .. },
        ) if turn.angle.is_none() && turn.circle.is_none() && turn.speed.is_none() => {
            number(degrees.abs(), 3)
        }
        _ => return None,
    };
    let insert = format!(" {text}");
    Some((text, insert))
}

#[cfg(test)]
mod tests;
