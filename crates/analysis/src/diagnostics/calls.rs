//! Where the movements lead that a movement does.

use pydslrep_syntax::ast::{Action, Name};
use rustc_hash::FxHashMap;

use super::context::Context;
use crate::EntityId;

/// The maximum length of a chain of movements that do each other: far more than in any program, and fewer than Python can call.
pub(super) const MAX_CALL_DEPTH: usize = 200;

#[derive(Debug, Clone)]
pub(super) enum Calls {
    /// Back to the movement that is checked, by this way: each does the next, and the last is the one that is checked.
    Back(Vec<EntityId>),
    /// To more than [`MAX_CALL_DEPTH`] movements in a row.
    TooMany,
    /// Neither.
    Elsewhere,
}

/// Each `do` of a movement, and where it leads.
pub(super) fn of<'a>(context: &Context<'a>) -> impl Iterator<Item = (&'a Name, Calls)> {
    let mut known: FxHashMap<EntityId, Calls> = FxHashMap::default();
    context.actions().filter_map(Action::done).filter_map(move |done| {
        let (id, _) = context.movement(done)?;
        Some((done, known.entry(id).or_insert_with(|| from(context, id)).clone()))
    })
}

/// By the shortest way from a movement.
fn from(context: &Context<'_>, from: EntityId) -> Calls {
    let mut before: FxHashMap<EntityId, EntityId> = FxHashMap::default();
    let mut row = vec![from];
    for _ in 0..MAX_CALL_DEPTH {
        if row.contains(&context.id) {
            let mut way = vec![context.id];
            while let Some(id) = way.last().filter(|id| **id != from).and_then(|id| before.get(id)) {
                way.push(*id);
            }
            way.reverse();
            return Calls::Back(way);
        }
        let mut next = Vec::new();
        for id in row {
            let does = context.summary(id).map(|summary| summary.does).unwrap_or_default();
            for other in does.iter().filter_map(|name| context.movement_of(id, name)) {
                if other != from && !before.contains_key(&other) {
                    before.insert(other, id);
                    next.push(other);
                }
            }
        }
        row = next;
    }
    if row.is_empty() { Calls::Elsewhere } else { Calls::TooMany }
}
