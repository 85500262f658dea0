//! Helpers for refactorings of movements.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Action, ActionKind, Entity, Move, Movement, Number, Unit};

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

/// A length with its unit.
pub(super) struct Length<'a> {
    pub(super) number: &'a Number,
    pub(super) unit: Unit,
    pub(super) unit_span: Span,
    /// The words that it is part of: an action, or what is before its block.
    pub(super) words: Span,
}

/// The lengths in a movement: distances, radii, and what conditions call near.
pub(super) fn lengths(movement: &Movement) -> Vec<Length<'_>> {
    movement.all_actions().flat_map(lengths_of).collect()
}

/// Those of one action; the actions in its blocks are not looked at.
fn lengths_of<'a>(action: &'a Action) -> Vec<Length<'a>> {
    let own = match &action.kind {
        ActionKind::Move(step) => step.distance.as_ref().zip(step.unit),
        ActionKind::Turn(turn) => {
            (turn.circle.as_ref()).and_then(|circle| circle.radius.as_ref().zip(circle.unit))
        }
        _ => None,
    };
    let within = action.conditions().filter_map(|condition| condition.within.as_ref());
    let near = within.filter_map(|within| within.distance.as_ref().zip(within.unit));
    let length = |(number, (unit, unit_span)): (&'a Number, (Unit, Span))| Length {
        number,
        unit,
        unit_span,
        words: words(action, number),
    };
    own.into_iter().chain(near).map(length).collect()
}

/// Returns the part of an action around a number in it, without the action's blocks.
fn words(action: &Action, number: &Number) -> Span {
    let ActionKind::If(choice) = &action.kind else {
        let end = action.blocks().next().map_or(action.span.end, |block| block.span.start);
        return Span::new(action.span.start, end);
    };
    let branch = choice.branches.iter().rev().find(|branch| branch.span.start <= number.span.start);
    let start = branch.map_or(action.span.start, |branch| branch.span.start);
    let block = branch.and_then(|branch| branch.block.as_ref());
    Span::new(start, block.map_or(number.span.end, |block| block.span.start))
}

/// The `move` actions among some actions.
pub(super) fn moves<'a>(actions: impl IntoIterator<Item = &'a Action>) -> impl Iterator<Item = &'a Move> {
    actions.into_iter().filter_map(|action| match &action.kind {
        ActionKind::Move(step) => Some(step),
        _ => None,
    })
}
