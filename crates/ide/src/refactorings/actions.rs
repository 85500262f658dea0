//! Helpers for refactorings of movements.

use pydslrep_syntax::ast::{Action, ActionKind, Entity, Move, Movement};

use super::Selection;

impl<'a> Selection<'a> {
    /// The selected movement.
    pub(super) fn movement(&self) -> Option<&'a Movement> {
        match self.entity.parse.entity.as_ref()? {
            Entity::Movement(movement) => Some(movement),
            _ => None,
        }
    }

    /// The selected `move` actions, those in blocks too; a cursor between two selects both.
    pub(super) fn selected_moves(&self) -> Vec<&'a Move> {
        let actions = self.movement().into_iter().flat_map(Movement::all_actions);
        moves(actions.filter(|action| self.touches(action.span))).collect()
    }
}

/// The `move` actions among some actions.
pub(super) fn moves<'a>(actions: impl IntoIterator<Item = &'a Action>) -> impl Iterator<Item = &'a Move> {
    actions.into_iter().filter_map(|action| match &action.kind {
        ActionKind::Move(step) => Some(step),
        _ => None,
    })
}
