//! The rule for movements and their actions.

use chumsky::IterParser;
use chumsky::prelude::{Parser, choice, just, via_parser};

use super::slot::{
    NAME, NUMBER, declared_name, keyword, nothing_more, number, reference, references, skip_before,
    skip_statement, slot,
};
use super::{Extra, Input, Rule};
use crate::ast::{
    Action, ActionKind, Direction, Entity, Move, Movement, SpeedClause, Turn, TurnExtent, Unit,
};
use crate::{EntityKind, Expected, Quantity, TokenKind, TokenSet};

const OPEN: TokenSet = TokenSet::of(&[TokenKind::OpenBrace]);
const CLOSE: TokenSet = TokenSet::of(&[TokenKind::CloseBrace]);
const OF: TokenSet = TokenSet::of(&[TokenKind::Of]);
const ACTIONS: TokenSet = TokenSet::of(&TokenKind::ACTIONS);
const UNITS: TokenSet = TokenSet::of(&[TokenKind::Meters, TokenKind::Centimeters]);
const AT: TokenSet = TokenSet::of(&[TokenKind::At]);
const DIRECTIONS: TokenSet = TokenSet::of(&[TokenKind::Left, TokenKind::Right]);
const UNTIL: TokenSet = TokenSet::of(&[TokenKind::Until]);

/// What can follow an action.
const NEXT: TokenSet = ACTIONS.or(CLOSE);

/// `parallel movement name of robot { … }`
pub(super) fn movement<'s>() -> Rule<'s, Option<Entity>> {
    let body = ACTIONS.or(CLOSE);
    let parallel = just(TokenKind::Parallel)
        .map_with(|_, extra| extra.span())
        .then_ignore(keyword(TokenKind::Movement, NAME, OF.or(OPEN)))
        .map(Some);
    choice((parallel, just(TokenKind::Movement).to(None)))
        .then(declared_name(EntityKind::Movement, OF, OPEN.or(body)))
        .then_ignore(keyword(TokenKind::Of, NAME, OPEN.or(body)))
        .then(reference(EntityKind::Robot, OPEN, body))
        .then(block())
        .then_ignore(nothing_more())
        .map(|(((parallel, name), robot), (actions, span))| {
            Some(Entity::Movement(Movement { parallel, name, robot, body: Some(span), actions }))
        })
        .boxed()
}

fn block<'s>() -> impl Parser<'s, Input<'s>, (Vec<Action>, crate::Span), Extra<'s>> + Clone {
    let open = slot(just(TokenKind::OpenBrace).ignored(), OPEN, ACTIONS.or(CLOSE));
    let item = action().map(Some).recover_with(via_parser(skip_statement(NEXT).to(None))).boxed();
    let close = slot(just(TokenKind::CloseBrace).ignored(), CLOSE, TokenSet::default());
    open.ignore_then(item.repeated().collect::<Vec<_>>())
        .then_ignore(close)
        .map_with(|actions, extra| (actions.into_iter().flatten().collect(), extra.span()))
        .boxed()
}

fn action<'s>() -> Rule<'s, Action> {
    choice((move_action(), turn_action(), just(TokenKind::Slam).to(ActionKind::Slam).boxed()))
        .map_with(|kind, extra| Action { kind, span: extra.span() })
        .labelled(Expected::Action)
        .boxed()
}

fn move_action<'s>() -> Rule<'s, ActionKind> {
    let unit = choice((
        just(TokenKind::Meters).to(Unit::Meters),
        just(TokenKind::Centimeters).to(Unit::Centimeters),
    ))
    .map_with(|unit, extra| (unit, extra.span()));
    let speed = just(TokenKind::At)
        .ignore_then(slot(number(Quantity::Speed), NUMBER, NEXT))
        .map_with(|value, extra| SpeedClause { value, span: extra.span() });
    just(TokenKind::Move)
        .ignore_then(slot(number(Quantity::Distance), NUMBER, UNITS.or(AT).or(NEXT)))
        .then(slot(unit, UNITS, AT.or(NEXT)))
        .then(speed.or_not())
        .map(|((distance, unit), speed)| ActionKind::Move(Move { distance, unit, speed }))
        .boxed()
}

fn turn_action<'s>() -> Rule<'s, ActionKind> {
    let direction =
        choice((just(TokenKind::Left).to(Direction::Left), just(TokenKind::Right).to(Direction::Right)))
            .map_with(|direction, extra| (direction, extra.span()));
    // `turn 90 left`: the angle comes last.
    let swapped = skip_before(NUMBER, DIRECTIONS).ignore_then(direction);
    let direction = direction.recover_with(via_parser(swapped));
    let until = just(TokenKind::Until)
        .ignore_then(references(EntityKind::Sensor, false, ACTIONS))
        .map(TurnExtent::Until);
    let extent = choice((number(Quantity::Angle).map(TurnExtent::Angle).boxed(), until.boxed()));
    just(TokenKind::Turn)
        .ignore_then(slot(direction, DIRECTIONS, NUMBER.or(UNTIL).or(NEXT)))
        .then(extent.or_not())
        .map(|(direction, extent)| ActionKind::Turn(Turn { direction, extent }))
        .boxed()
}
