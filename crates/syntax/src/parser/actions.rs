//! The rules for actions and the blocks that they are in.

use chumsky::IterParser;
use chumsky::prelude::{Parser, choice, just, recursive, via_parser};

use super::condition::{UNTIL, condition, until};
use super::reuse::known_action;
use super::slot::{
    HARD_ACTIONS, NUMBER, action_ahead, braced, keyword, misspelling, number, one_in, plain_name,
    skip_before, skip_statement, skip_to_block, slot, slot_before,
};
use super::{Extra, Input, Rule};
use crate::ast::{
    Action, ActionKind, Block, Branch, Circle, Condition, Direction, Do, If, Move, Number, Repeat, Rounds,
    SpeedClause, Turn, Unit, Until, Wait,
};
use crate::{EntityKind, Expected, Quantity, Span, TokenKind, TokenSet};

pub(super) const OPEN: TokenSet = TokenSet::of(&[TokenKind::OpenBrace]);
pub(super) const CLOSE: TokenSet = TokenSet::of(&[TokenKind::CloseBrace]);
pub(super) const ACTIONS: TokenSet = TokenSet::of(&TokenKind::ACTIONS);
pub(super) const UNITS: TokenSet = TokenSet::of(&[TokenKind::Meters, TokenKind::Centimeters]);
const AT: TokenSet = TokenSet::of(&[TokenKind::At]);
const DIRECTIONS: TokenSet = TokenSet::of(&[TokenKind::Left, TokenKind::Right]);
pub(super) const WITH: TokenSet = TokenSet::of(&[TokenKind::With]);
const IN: TokenSet = TokenSet::of(&[TokenKind::In]);
const IF: TokenSet = TokenSet::of(&[TokenKind::If]);

/// The tokens that can follow an action.
const NEXT: TokenSet = ACTIONS.or(CLOSE);

/// The tokens that can follow the angle of a turn.
const TURN_CLAUSES: TokenSet = WITH.or(AT).or(IN).or(UNTIL);

type Actions<'s> = Rule<'s, Vec<Action>>;

/// `{ … }` of a movement, of which some actions may be known if it is read `again`.
pub(super) fn block<'s>(again: bool) -> Rule<'s, Block> {
    let actions = recursive(|actions| {
        let item = action(&inner_block(&actions.boxed()), again);
        item.repeated().fold(Vec::new(), with_understood)
    });
    let open = slot(just(TokenKind::OpenBrace).ignored(), OPEN, ACTIONS.or(CLOSE));
    as_block(open.ignore_then(actions).then_ignore(close()))
}

/// `{ … }` of an action.
fn inner_block<'s>(actions: &Actions<'s>) -> Rule<'s, Block> {
    as_block(braced(actions.clone().then_ignore(close()), ACTIONS.or(CLOSE)))
}

fn close<'s>() -> Rule<'s, Option<()>> {
    slot(just(TokenKind::CloseBrace).ignored(), CLOSE, TokenSet::default())
}

fn as_block<'s>(actions: impl Parser<'s, Input<'s>, Vec<Action>, Extra<'s>> + Clone + 's) -> Rule<'s, Block> {
    actions.map_with(|actions, extra| Block { actions, span: extra.span() }).boxed()
}

/// The actions with what is understood of the next statement.
fn with_understood(mut actions: Vec<Action>, more: Understood) -> Vec<Action> {
    match more {
        Understood::One(action) => actions.push(action),
        Understood::Others(more) => actions.extend(more),
    }
    actions
}

/// What is understood of one statement.
#[expect(clippy::large_enum_variant, reason = "nearly all are actions, which are moved only once")]
enum Understood {
    /// The action that it is.
    One(Action),
    /// The actions in a block that belongs to nothing that is known; none where nothing was understood.
    Others(Vec<Action>),
}

/// One statement.
fn action<'s>(block: &Rule<'s, Block>, again: bool) -> Rule<'s, Understood> {
    // Rules that several others share are built once: a key typed in a movement builds all of them anew.
    let until = until(NEXT);
    let (waits, repeats) = (after_wait(&until), after_repeat(block));
    let condition_and_block = condition(OPEN.or(NEXT)).then(block.clone()).boxed();
    // Those that a slip of spelling is understood of, by what follows.
    let spelt = |word: fn(TokenKind) -> Rule<'s, ()>| {
        choice((
            word(TokenKind::Wait).ignore_then(waits.clone()),
            word(TokenKind::Repeat).ignore_then(repeats.clone()),
            if_action(word(TokenKind::If), &condition_and_block, block),
        ))
    };
    let kinds = choice((
        move_action(&until),
        turn_action(&until),
        spelt(|word| just(word).ignored().boxed()),
        do_action(),
        just(TokenKind::Slam).to(ActionKind::Slam),
    ));
    let kinds = spanned(kinds).boxed();
    let kinds = if again { choice((known_action(), kinds)).boxed() } else { kinds };
    let misspelt = spanned(spelt(misspelt_action));
    kinds
        .labelled(Expected::Action)
        .recover_with(via_parser(misspelt))
        .map(Understood::One)
        .recover_with(via_parser(unknown_block(block).map(Understood::Others)))
        .recover_with(via_parser(skip_statement(NEXT).map(|()| Understood::Others(Vec::new()))))
        .boxed()
}

fn spanned<'s>(
    kind: impl Parser<'s, Input<'s>, ActionKind, Extra<'s>> + Clone + 's,
) -> impl Parser<'s, Input<'s>, Action, Extra<'s>> + Clone {
    kind.map_with(|kind, extra| Action { kind, span: extra.span() })
}

/// A slip for the keyword of an action, right before what no name is before.
fn misspelt_action<'s>(word: TokenKind) -> Rule<'s, ()> {
    misspelt_before(word, word.only_before())
}

/// A slip for a keyword, right before one of `next`.
fn misspelt_before<'s>(word: TokenKind, next: TokenSet) -> Rule<'s, ()> {
    misspelling(word).then_ignore(one_in(next).rewind()).ignored().boxed()
}

/// The actions in a block that follows something else than an action: they are understood, and it is not.
fn unknown_block<'s>(block: &Rule<'s, Block>) -> Actions<'s> {
    let inside = choice((one_in(OPEN.or(HARD_ACTIONS)).ignored(), action_ahead()));
    let ahead = just(TokenKind::OpenBrace).then(inside).rewind();
    skip_to_block(NEXT).then_ignore(ahead).ignore_then(block.clone()).map(|block| block.actions).boxed()
}

fn unit<'s>() -> impl Parser<'s, Input<'s>, (Unit, Span), Extra<'s>> + Clone {
    choice((just(TokenKind::Meters).to(Unit::Meters), just(TokenKind::Centimeters).to(Unit::Centimeters)))
        .map_with(|unit, extra| (unit, extra.span()))
}

type Length = (Option<Number>, Option<(Unit, Span)>);

/// A length with its unit in a clause, where `later` can follow it.
pub(super) fn length<'s>(later: TokenSet) -> Rule<'s, Length> {
    let number = slot_before(number(Quantity::Distance), NUMBER, UNITS.or(later));
    number.then(slot(unit(), UNITS, later)).boxed()
}

/// Parses the distance of a move.
fn distance<'s>() -> Rule<'s, Length> {
    let later = AT.or(UNTIL).or(NEXT);
    let number = slot(number(Quantity::Distance), NUMBER, UNITS.or(later));
    number.then(slot(unit(), UNITS, later)).boxed()
}

fn speed<'s>() -> Rule<'s, SpeedClause> {
    just(TokenKind::At)
        .ignore_then(slot(number(Quantity::Speed), NUMBER, NEXT.or(UNTIL).or(IN)))
        .map_with(|value, extra| SpeedClause { value, span: extra.span() })
        .boxed()
}

fn move_action<'s>(until: &Rule<'s, Until>) -> Rule<'s, ActionKind> {
    let far = distance()
        .then(speed().or_not())
        .then(until.clone().or_not())
        .map(|(((distance, unit), speed), until)| Move { distance, unit, speed, until });
    // Where the question is what follows `at`, it is a speed, and not the `until` after one that is missing.
    let asked = just(TokenKind::At).then(just(TokenKind::Cursor)).ignored();
    // `move at 4 meters`: what has a unit of length is how far, and `at` is the word too many.
    let distance_at = just(TokenKind::At).then(one_in(NUMBER)).then(one_in(UNITS)).ignored();
    let open_ended = choice((asked, distance_at))
        .not()
        .ignore_then(speed().or_not())
        .then(until.clone())
        .map(|(speed, until)| Move { distance: None, unit: None, speed, until: Some(until) });
    just(TokenKind::Move).ignore_then(choice((open_ended, far))).map(ActionKind::Move).boxed()
}

fn turn_action<'s>(until: &Rule<'s, Until>) -> Rule<'s, ActionKind> {
    let direction =
        choice((just(TokenKind::Left).to(Direction::Left), just(TokenKind::Right).to(Direction::Right)))
            .map_with(|direction, extra| (direction, extra.span()));
    // `turn 90 left`: the angle comes last.
    let swapped = skip_before(NUMBER, DIRECTIONS).ignore_then(direction);
    let direction = direction.recover_with(via_parser(swapped));
    just(TokenKind::Turn)
        .ignore_then(slot(direction, DIRECTIONS, NUMBER.or(TURN_CLAUSES).or(NEXT)))
        .then(number(Quantity::Angle).or_not())
        .then(circle().or_not())
        .then(speed().or_not())
        .then(in_reverse().or_not())
        .then(until.clone().or_not())
        .map(|(((((direction, angle), circle), speed), reverse), until)| {
            ActionKind::Turn(Turn { direction, angle, circle, speed, reverse, until })
        })
        .boxed()
}

/// `with radius 1.5 meters`
fn circle<'s>() -> Rule<'s, Circle> {
    let later = AT.or(IN).or(UNTIL).or(NEXT);
    just(TokenKind::With)
        .ignore_then(keyword(TokenKind::Radius, NUMBER, UNITS.or(later)))
        .ignore_then(length(later))
        .map_with(|(radius, unit), extra| Circle { radius, unit, span: extra.span() })
        .boxed()
}

/// `in reverse`
fn in_reverse<'s>() -> Rule<'s, Span> {
    just(TokenKind::In)
        .ignore_then(keyword(TokenKind::Reverse, NEXT.or(UNTIL), NEXT.or(UNTIL)))
        .map_with(|_, extra| extra.span())
        .boxed()
}

/// `2 seconds`, before one of `next`, or of `later` if that is missing.
fn amount<'s>(
    quantity: Quantity,
    word: TokenKind,
    next: TokenSet,
    later: TokenSet,
) -> Rule<'s, Option<Number>> {
    slot_before(number(quantity), NUMBER, TokenSet::of(&[word]).or(next).or(later))
        .then_ignore(keyword(word, next, later))
        .boxed()
}

fn after_wait<'s>(until: &Rule<'s, Until>) -> Rule<'s, ActionKind> {
    let later = NEXT.or(UNTIL);
    let long = amount(Quantity::Time, TokenKind::Seconds, later, later)
        .then(until.clone().or_not())
        .map(|(seconds, until)| Wait { seconds, until });
    let open_ended = until.clone().map(|until| Wait { seconds: None, until: Some(until) });
    choice((open_ended, long)).map(ActionKind::Wait).boxed()
}

fn after_repeat<'s>(block: &Rule<'s, Block>) -> Rule<'s, ActionKind> {
    let later = OPEN.or(NEXT);
    let times = amount(Quantity::Count, TokenKind::Times, OPEN, NEXT).map(|count| count.map(Rounds::Times));
    let open_ended = until(later).map(|until| Some(Rounds::Until(until)));
    choice((open_ended, times))
        .then(block.clone())
        .map(|(rounds, block)| ActionKind::Repeat(Repeat { rounds, block: Some(block) }))
        .boxed()
}

fn if_action<'s>(
    word: Rule<'s, ()>,
    condition_and_block: &Rule<'s, (Condition, Block)>,
    block: &Rule<'s, Block>,
) -> Rule<'s, ActionKind> {
    let exact = just(TokenKind::Else).ignored();
    let other = choice((exact, misspelt_before(TokenKind::Else, OPEN.or(IF)))).boxed();
    let branch = |word: Rule<'s, ()>| {
        word.ignore_then(condition_and_block.clone()).map_with(|(condition, block), extra| Branch {
            condition: Some(condition),
            block: Some(block),
            span: extra.span(),
        })
    };
    let more = other.clone().ignore_then(branch(just(TokenKind::If).ignored().boxed()));
    branch(word)
        .map(|first| vec![first])
        .foldl(more.repeated(), |mut branches, branch| {
            branches.push(branch);
            branches
        })
        .then(other.ignore_then(block.clone()).or_not())
        .map(|(branches, otherwise)| ActionKind::If(If { branches, otherwise }))
        .boxed()
}

/// `do side`: a keyword that only begins an action where something follows that only it has after it, or a plain name.
fn do_action<'s>() -> Rule<'s, ActionKind> {
    const PLAIN: TokenSet = TokenSet::of(&[TokenKind::Name, TokenKind::MalformedName]);
    let next_do = just(TokenKind::Do).then(one_in(PLAIN)).ignored();
    let name = plain_name()
        .and_is(choice((action_ahead(), next_do)).not())
        .labelled(Expected::ReferenceTo(EntityKind::Movement));
    just(TokenKind::Do)
        .ignore_then(slot(name, PLAIN, NEXT))
        .map(|movement| ActionKind::Do(Do { movement }))
        .boxed()
}
