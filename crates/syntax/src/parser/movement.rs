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
use crate::{EntityKind, Expected, Token, TokenSet};

const OPEN: TokenSet = TokenSet::of(&[Token::OpenBrace]);
const CLOSE: TokenSet = TokenSet::of(&[Token::CloseBrace]);
const OF: TokenSet = TokenSet::of(&[Token::Of]);
const ACTIONS: TokenSet = TokenSet::of(&[Token::Move, Token::Turn, Token::Slam]);
const UNITS: TokenSet = TokenSet::of(&[Token::Meters, Token::Centimeters]);
const AT: TokenSet = TokenSet::of(&[Token::At]);
const DIRECTIONS: TokenSet = TokenSet::of(&[Token::Left, Token::Right]);
const UNTIL: TokenSet = TokenSet::of(&[Token::Until]);

/// What can stand behind an action.
const NEXT: TokenSet = ACTIONS.or(CLOSE);

/// `parallel movement name of robot { … }`
pub(super) fn movement<'s>() -> Rule<'s, Option<Entity>> {
    let body = ACTIONS.or(CLOSE);
    let parallel = just(Token::Parallel)
        .map_with(|_, extra| extra.span())
        .then_ignore(keyword(Token::Movement, NAME, OF.or(OPEN)))
        .map(Some);
    choice((parallel, just(Token::Movement).to(None)))
        .then(declared_name(EntityKind::Movement, OF, OPEN.or(body)))
        .then_ignore(keyword(Token::Of, NAME, OPEN.or(body)))
        .then(reference(EntityKind::Robot, OPEN, body))
        .then(block())
        .then_ignore(nothing_more())
        .map(|(((parallel, name), robot), (actions, span))| {
            Some(Entity::Movement(Movement { parallel, name, robot, body: Some(span), actions }))
        })
        .boxed()
}

fn block<'s>() -> impl Parser<'s, Input<'s>, (Vec<Action>, crate::Span), Extra<'s>> + Clone {
    let open = slot(just(Token::OpenBrace).ignored(), OPEN, ACTIONS.or(CLOSE));
    let item = action().map(Some).recover_with(via_parser(skip_statement(NEXT).to(None))).boxed();
    let close = slot(just(Token::CloseBrace).ignored(), CLOSE, TokenSet::default());
    open.ignore_then(item.repeated().collect::<Vec<_>>())
        .then_ignore(close)
        .map_with(|actions, extra| (actions.into_iter().flatten().collect(), extra.span()))
        .boxed()
}

fn action<'s>() -> Rule<'s, Action> {
    choice((move_action(), turn_action(), just(Token::Slam).to(ActionKind::Slam).boxed()))
        .map_with(|kind, extra| Action { kind, span: extra.span() })
        .labelled(Expected::Action)
        .boxed()
}

fn move_action<'s>() -> Rule<'s, ActionKind> {
    let unit = choice((just(Token::Meters).to(Unit::Meters), just(Token::Centimeters).to(Unit::Centimeters)))
        .map_with(|unit, extra| (unit, extra.span()));
    let speed = just(Token::At)
        .ignore_then(slot(number(Expected::Speed), NUMBER, NEXT))
        .map_with(|value, extra| SpeedClause { value, span: extra.span() });
    just(Token::Move)
        .ignore_then(slot(number(Expected::Distance), NUMBER, UNITS.or(AT).or(NEXT)))
        .then(slot(unit, UNITS, AT.or(NEXT)))
        .then(speed.or_not())
        .map(|((distance, unit), speed)| ActionKind::Move(Move { distance, unit, speed }))
        .boxed()
}

fn turn_action<'s>() -> Rule<'s, ActionKind> {
    let direction = choice((just(Token::Left).to(Direction::Left), just(Token::Right).to(Direction::Right)))
        .map_with(|direction, extra| (direction, extra.span()));
    // `turn 90 left`: the angle comes last.
    let swapped = skip_before(NUMBER, DIRECTIONS).ignore_then(direction);
    let direction = direction.recover_with(via_parser(swapped));
    let until =
        just(Token::Until).ignore_then(references(EntityKind::Sensor, false, ACTIONS)).map(TurnExtent::Until);
    let extent = choice((number(Expected::Angle).map(TurnExtent::Angle).boxed(), until.boxed()));
    just(Token::Turn)
        .ignore_then(slot(direction, DIRECTIONS, NUMBER.or(UNTIL).or(NEXT)))
        .then(extent.or_not())
        .map(|(direction, extent)| ActionKind::Turn(Turn { direction, extent }))
        .boxed()
}
