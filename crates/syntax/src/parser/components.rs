//! The rules for what robots are made of: wheels, sensors, ips; and for imports.

use chumsky::prelude::{Parser, choice, just};

use super::actions::WITH;
use super::slot::{NUMBER, declared_name, keyword, nothing_more, number, slot, take};
use super::{Rule, errors};
use crate::ast::{Entity, Import, Ip, Sensor, SensorKeyword, Wheel};
use crate::{EntityKind, Expected, Quantity, TokenKind, TokenSet};

/// The text before the first entity: nothing, or text that fits nowhere.
pub(super) fn preamble<'s>() -> Rule<'s, Option<Entity>> {
    nothing_more().to(None).boxed()
}

/// `import "file.pyr"`
pub(super) fn import<'s>() -> Rule<'s, Option<Entity>> {
    let strings = TokenSet::of(&[TokenKind::String, TokenKind::UnterminatedString]);
    let path =
        take(move |token, span, text| strings.has(token).then(|| (errors::unquoted(span, text), span)));
    just(TokenKind::Import)
        .ignore_then(slot(path.labelled(Expected::Path), strings, TokenSet::default()))
        .then_ignore(nothing_more())
        .map(|path| {
            let (path, path_span) = path.unzip();
            Some(Entity::Import(Import { path, path_span }))
        })
        .boxed()
}

/// `wheel name with radius 4.5`
pub(super) fn wheel<'s>() -> Rule<'s, Option<Entity>> {
    const RADIUS: TokenSet = TokenSet::of(&[TokenKind::Radius]);
    let head = choice((just(TokenKind::Wheel), just(TokenKind::WheelH)))
        .map_with(|token, extra| (token, extra.span()));
    head.then(declared_name(EntityKind::Wheel, WITH, RADIUS.or(NUMBER)))
        .then_ignore(keyword(TokenKind::With, RADIUS, NUMBER))
        .then_ignore(keyword(TokenKind::Radius, NUMBER, TokenSet::default()))
        .then(slot(number(Quantity::Radius), NUMBER, TokenSet::default()))
        .then_ignore(nothing_more())
        .map(|(((token, keyword), name), radius)| {
            Some(Entity::Wheel(Wheel { keyword, mecanum: token == TokenKind::WheelH, name, radius }))
        })
        .boxed()
}

/// `sensor name : bumper`
pub(super) fn sensor<'s>() -> Rule<'s, Option<Entity>> {
    const COLON: TokenSet = TokenSet::of(&[TokenKind::Colon]);
    const KINDS: TokenSet = TokenSet::of(&[TokenKind::Distance, TokenKind::Bumper]);
    let kind = choice((
        just(TokenKind::Distance).to(SensorKeyword::Distance),
        just(TokenKind::Bumper).to(SensorKeyword::Bumper),
    ))
    .map_with(|kind, extra| (kind, extra.span()));
    just(TokenKind::Sensor)
        .ignore_then(declared_name(EntityKind::Sensor, COLON, TokenSet::default()))
        .then(just(TokenKind::Colon).ignore_then(slot(kind, KINDS, TokenSet::default())).or_not())
        .then_ignore(nothing_more())
        .map(|(name, kind)| Some(Entity::Sensor(Sensor { name, kind: kind.flatten() })))
        .boxed()
}

/// `ip name 127.0.0.1`
pub(super) fn ip<'s>() -> Rule<'s, Option<Entity>> {
    let address =
        take(|token, span, text| (token == TokenKind::Ipv4).then(|| (span.text(text).into(), span)));
    let ipv4 = TokenSet::of(&[TokenKind::Ipv4]);
    just(TokenKind::Ip)
        .ignore_then(declared_name(EntityKind::Ip, ipv4, NUMBER))
        .then(slot(address.labelled(Expected::Address), ipv4, TokenSet::default()))
        .then_ignore(nothing_more())
        .map(|(name, address)| Some(Entity::Ip(Ip { name, address })))
        .boxed()
}
