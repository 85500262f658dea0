//! The rule for robots.

use chumsky::prelude::{Parser, choice, empty, just};

use super::actions::{CLOSE, OPEN, WITH};
use super::slot::{
    Fault, NAME, NUMBER, declared_name, keyword, nothing_more, one_in, references, slot, take,
};
use super::{Extra, Input, Rule};
use crate::ast::{DriveClause, Entity, Name, PortNumber, References, Robot};
use crate::{EntityKind, Expected, Span, TokenKind, TokenSet};

const TYPE: TokenSet = TokenSet::of(&[TokenKind::Type]);
const DRIVES: TokenSet = TokenSet::of(&TokenKind::DRIVES);
const PORT: TokenSet = TokenSet::of(&[TokenKind::Port]);
const HAS: TokenSet = TokenSet::of(&[TokenKind::Has]);
const WHEELS: TokenSet = TokenSet::of(&[TokenKind::Wheels]);
const SENSORS: TokenSet = TokenSet::of(&[TokenKind::Sensors]);

/// The tokens that can follow the port clause.
const TAIL: TokenSet = HAS.or(OPEN).or(CLOSE).or(WHEELS);

/// `robot name type tw with port 23000 has { … } wheels with sensors { … }`
pub(super) fn robot<'s>() -> Rule<'s, Option<Entity>> {
    just(TokenKind::Robot)
        .ignore_then(head())
        .then(port())
        .then(wheels())
        .then(sensors().or_not())
        .then_ignore(nothing_more())
        .validate(|(((((before, name), after), port), wheels), sensors), _, emitter| {
            if let (Some(_), Some(second)) = (&before, &after) {
                let expected = Expected::Word(TokenKind::With).into();
                emitter.emit(Fault::Expected { at: second.span, expected });
                emitter.emit(Fault::Skipped(second.span));
            }
            let before = before.map(|clause| DriveClause { before_name: true, ..clause });
            Some(Entity::Robot(Robot { name, drive: after.or(before), port, wheels: Some(wheels), sensors }))
        })
        .boxed()
}

/// A type, the name, a type.
type Head = ((Option<DriveClause>, Option<Name>), Option<DriveClause>);

fn head<'s>() -> Rule<'s, Head> {
    let name = || declared_name(EntityKind::Robot, TYPE.or(WITH), PORT.or(NUMBER).or(TAIL));
    // Before the name, and after the name once more, a type is understood, but never expected.
    let before = drive(one_in(TYPE), NAME.or(WITH)).map(Some).then(name());
    let before = before.then(drive(one_in(TYPE), WITH.or(PORT)).or_not());
    let following = empty().to(None).then(name()).then(drive(just(TokenKind::Type), WITH.or(PORT)).or_not());
    choice((before, following)).boxed()
}

fn drive<'s>(
    first: impl Parser<'s, Input<'s>, TokenKind, Extra<'s>> + Clone + 's,
    next: TokenSet,
) -> impl Parser<'s, Input<'s>, DriveClause, Extra<'s>> + Clone {
    let word = choice(TokenKind::DRIVES.map(|word| just(word).map(TokenKind::drive)));
    first
        .ignore_then(slot(word, DRIVES, next.or(PORT).or(NUMBER).or(TAIL)))
        .map_with(|word, extra| DriveClause { word: word.flatten(), span: extra.span(), before_name: false })
        .boxed()
}

fn port<'s>() -> Rule<'s, Option<PortNumber>> {
    let number = take(|token, span, text| NUMBER.has(token).then_some((token, span, text)))
        .validate(|(token, span, text): (TokenKind, Span, &str), _, emitter| {
            let whole = token == TokenKind::Integer;
            if !whole {
                emitter.emit(Fault::PortNotWhole(span));
            }
            PortNumber { value: span.text(text).parse().ok().filter(|port| *port != 0), span, whole }
        })
        .labelled(Expected::Port);
    keyword(TokenKind::With, PORT, NUMBER.or(TAIL))
        .ignore_then(keyword(TokenKind::Port, NUMBER, TAIL))
        .ignore_then(slot(number, NUMBER, TAIL))
        .boxed()
}

fn wheels<'s>() -> Rule<'s, References> {
    let following = WHEELS.or(WITH).or(SENSORS);
    keyword(TokenKind::Has, OPEN, NAME.or(CLOSE).or(following))
        .ignore_then(references(EntityKind::Wheel, true, following))
        .then_ignore(keyword(TokenKind::Wheels, WITH, SENSORS))
        .boxed()
}

fn sensors<'s>() -> Rule<'s, References> {
    just(TokenKind::With)
        .ignore_then(keyword(TokenKind::Sensors, OPEN, NAME.or(CLOSE)))
        .ignore_then(references(EntityKind::Sensor, false, TokenSet::default()))
        .boxed()
}
