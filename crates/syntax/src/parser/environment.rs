//! The rule for environments.

use chumsky::prelude::{Parser, choice, end, just};

use super::actions::{CLOSE, OPEN, WITH};
use super::slot::{NAME, declared_name, keyword, nothing_more, one_in, reference, references};
use super::{Extra, Input, Rule};
use crate::ast::{Entity, Environment, IpClause, References};
use crate::{EntityKind, TokenKind, TokenSet};

const IP: TokenSet = TokenSet::of(&[TokenKind::Ip]);
const HAS: TokenSet = TokenSet::of(&[TokenKind::Has]);
const COMMA: TokenSet = TokenSet::of(&[TokenKind::Comma]);
const BUT_OPEN: TokenSet = TokenSet::all_but(TokenKind::OpenBrace);
const ROBOTS: TokenSet = TokenSet::of(&[TokenKind::Robots]);
const MOVES: TokenSet = TokenSet::of(&[TokenKind::Moves]);

/// The tokens that can follow the name and the ip.
const TAIL: TokenSet = HAS.or(OPEN).or(CLOSE).or(ROBOTS);

/// `environment name with ip ip1 has { … } robots with { … } moves`
pub(super) fn environment<'s>() -> Rule<'s, Option<Entity>> {
    just(TokenKind::Environment)
        .ignore_then(declared_name(EntityKind::Environment, WITH.or(COMMA).or(HAS), IP.or(TAIL)))
        .then(ip_clause().or_not())
        .then(robots())
        .then(movements().or_not())
        .then_ignore(nothing_more())
        .map(|(((name, ip), robots), movements)| {
            Some(Entity::Environment(Environment { name, ip, robots: Some(robots), movements }))
        })
        .boxed()
}

fn ip_clause<'s>() -> impl Parser<'s, Input<'s>, IpClause, Extra<'s>> + Clone {
    let with_comma = choice((
        // `with { … } moves` is about movements.
        just(TokenKind::With)
            .then_ignore(choice((one_in(BUT_OPEN).ignored(), end())).rewind())
            .then(keyword(TokenKind::Ip, NAME, TAIL))
            .to(false),
        // The older spelling is understood, but never expected.
        one_in(COMMA).to(true),
    ));
    with_comma
        .then(reference(EntityKind::Ip, HAS, TAIL))
        .map_with(|(with_comma, name), extra| IpClause { name, span: extra.span(), with_comma })
        .boxed()
}

fn robots<'s>() -> Rule<'s, References> {
    let following = ROBOTS.or(WITH).or(MOVES);
    keyword(TokenKind::Has, OPEN, NAME.or(CLOSE).or(following))
        .ignore_then(references(EntityKind::Robot, true, following))
        .then_ignore(keyword(TokenKind::Robots, WITH, MOVES))
        .boxed()
}

fn movements<'s>() -> Rule<'s, References> {
    just(TokenKind::With)
        .ignore_then(references(EntityKind::Movement, true, MOVES))
        .then_ignore(keyword(TokenKind::Moves, TokenSet::default(), TokenSet::default()))
        .boxed()
}
