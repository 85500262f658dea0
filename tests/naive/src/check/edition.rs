//! What the article does not have.

use std::ops::Range;

use super::condition::may_lack_word;
use crate::Finding;
use crate::program::{Action, ActionKind, Body, Condition, Program, Turn};

/// Each extension: a statement at its first word, another part at the words that are new.
pub(crate) fn not_in_article(program: &Program) -> Vec<Finding> {
    let mut places: Vec<Range<usize>> = program.imports.iter().map(|path| path.range.clone()).collect();
    for entity in &program.entities {
        if let Body::Movement(movement) = &entity.body {
            places.extend(movement.statements().into_iter().flat_map(extensions));
        }
    }
    places.iter().map(|place| Finding::new("not-in-article", place)).collect()
}

fn extensions(action: &Action) -> Vec<Range<usize>> {
    match &action.kind {
        ActionKind::Slam => Vec::new(),
        ActionKind::Move { until, .. } => until.iter().map(|stop| stop.range.clone()).collect(),
        ActionKind::Turn(turn) => turn_extensions(action, turn),
        _ => vec![action.keyword.clone()],
    }
}

fn turn_extensions(action: &Action, turn: &Turn) -> Vec<Range<usize>> {
    let circle = turn.circle.iter().map(|circle| circle.range.clone());
    let speed = turn.speed.iter().map(|speed| speed.range.clone());
    let mut places: Vec<_> = circle.chain(speed).chain(turn.reverse.clone()).collect();
    if let Some(stop) = &turn.until {
        if turn.angle.is_some() {
            places.push(stop.range.clone());
        } else if !may_lack_word(action, &stop.value) || stop.value.word.is_some() {
            places.extend(after_list(&stop.value));
        }
    }
    places
}

/// The words after the list of sensors.
fn after_list(condition: &Condition) -> Option<Range<usize>> {
    let within = condition.within.as_ref().map(|within| &within.range);
    let first = condition.word.as_ref().or(within)?;
    Some(first.start..within.unwrap_or(first).end)
}
