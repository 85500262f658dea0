//! The rule for movements.

use chumsky::prelude::{Parser, choice, just};

use super::Rule;
use super::actions::{ACTIONS, CLOSE, OPEN, block};
use super::slot::{NAME, declared_name, keyword, nothing_more, reference};
use crate::ast::{Entity, Movement};
use crate::{EntityKind, TokenKind, TokenSet};

const OF: TokenSet = TokenSet::of(&[TokenKind::Of]);

/// `parallel movement name of robot { … }`, of which some actions may be known if it is read `again`.
pub(super) fn movement<'s>(again: bool) -> Rule<'s, Option<Entity>> {
    let body = ACTIONS.or(CLOSE);
    let parallel = just(TokenKind::Parallel)
        .map_with(|_, extra| extra.span())
        .then_ignore(keyword(TokenKind::Movement, NAME, OF.or(OPEN)))
        .map(Some);
    choice((parallel, just(TokenKind::Movement).to(None)))
        .then(declared_name(EntityKind::Movement, OF, OPEN.or(body)))
        .then_ignore(keyword(TokenKind::Of, NAME, OPEN.or(body)))
        .then(reference(EntityKind::Robot, OPEN, body))
        .then(block(again))
        .then_ignore(nothing_more())
        .map(|(((parallel, name), robot), block)| {
            Some(Entity::Movement(Movement {
                parallel,
                name,
                robot,
                body: Some(block.span),
                actions: block.actions,
            }))
        })
        .boxed()
}
