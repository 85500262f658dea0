//! What the refactorings of movements share.

use pydslrep_syntax::ast::{Action, ActionKind, Entity, Move, Movement};

use super::Place;

impl<'a> Place<'a> {
    /// The movement that the selection is in.
    pub(super) fn movement(&self) -> Option<&'a Movement> {
        match self.entity.parse.entity.as_ref()? {
            Entity::Movement(movement) => Some(movement),
            _ => None,
        }
    }

    /// The moves of the movement that the selection touches; with an empty one between two, both.
    pub(super) fn selected_moves(&self) -> Vec<&'a Move> {
        let actions = self.movement().map_or(&[][..], |movement| &movement.actions);
        moves(actions.iter().filter(|action| self.touches(action.span))).collect()
    }
}

/// Those actions that are moves.
pub(super) fn moves<'a>(actions: impl IntoIterator<Item = &'a Action>) -> impl Iterator<Item = &'a Move> {
    actions.into_iter().filter_map(|action| match &action.kind {
        ActionKind::Move(step) => Some(step),
        _ => None,
    })
}
