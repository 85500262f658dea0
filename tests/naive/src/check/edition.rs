//! What the article does not have.

use std::ops::Range;

use crate::Finding;
use crate::program::{Action, ActionKind, Body, Condition, Program, Turn};

/// Each extension: a statement at its first word, another part at the words that are new.
pub(crate) fn not_in_article(program: &Program) -> Vec<Finding> {
    let mut places: Vec<Range<usize>> = program.imports.iter().map(|path| path.range.clone()).collect();
    for entity in &program.entities {
        if let Body::Movement(movement) = &entity.body {
            // An `else if` belongs to its `if`: together they are one extension.
            let statements = movement.statements();
            let continued: Vec<_> = statements.iter().filter_map(|action| action.else_if()).collect();
            let is_continued = |action: &Action| continued.iter().any(|other| std::ptr::eq(*other, action));
            let first = statements.into_iter().filter(|action| !is_continued(action));
            places.extend(first.flat_map(extensions));
        }
    }
    places.iter().map(|place| Finding::new("not-in-article", place)).collect()
}

fn extensions(action: &Action) -> Vec<Range<usize>> {
    match &action.kind {
        ActionKind::Slam => Vec::new(),
        ActionKind::Move { until, .. } => until.iter().map(|stop| stop.range.clone()).collect(),
        ActionKind::Turn(turn) => turn_extensions(turn),
        _ => vec![action.keyword.clone()],
    }
}

fn turn_extensions(turn: &Turn) -> Vec<Range<usize>> {
    let circle = turn.circle.iter().map(|circle| circle.range.clone());
    let speed = turn.speed.iter().map(|speed| speed.range.clone());
    let mut places: Vec<_> = circle.chain(speed).chain(turn.reverse.clone()).collect();
    if let Some(stop) = &turn.until {
        if turn.angle.is_some() || !places.is_empty() {
            places.push(stop.range.clone());
        } else {
            places.extend(after_list(&stop.value));
        }
    }
    places
}

/// What follows the list of sensors, as one clause.
fn after_list(condition: &Condition) -> Option<Range<usize>> {
    let within = condition.within.as_ref().map(|within| &within.range);
    let first = condition.word.as_ref().or(within)?;
    Some(first.start..within.unwrap_or(first).end)
}
