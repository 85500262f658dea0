//! The rules for conditions.

use chumsky::IterParser;
use chumsky::input::MapExtra;
use chumsky::prelude::{Parser, choice, just};

use super::actions::{OPEN, UNITS, length};
use super::slot::{Fault, NAME, misspelling, no_list, one_in, plain_name, references};
use super::{Extra, Input, Rule};
use crate::ast::{Condition, References, SensorState, Until, Within};
use crate::{EntityKind, Expected, Span, TokenKind, TokenSet};

pub(super) const UNTIL: TokenSet = TokenSet::of(&[TokenKind::Until]);
const STATES: TokenSet = TokenSet::of(&[TokenKind::Clear, TokenKind::Detect]);
const WITHIN: TokenSet = TokenSet::of(&[TokenKind::Within]);

/// `until { front } detect`, where `later` can follow it.
pub(super) fn until<'s>(later: TokenSet) -> Rule<'s, Until> {
    just(TokenKind::Until)
        .ignore_then(condition(later))
        .map_with(|condition, extra| Until { condition, span: extra.span() })
        .boxed()
}

/// `{ front, left } clear within 40 centimeters`, where `later` can follow it. Whether the word may be left out is no matter
/// of syntax.
pub(super) fn condition<'s>(later: TokenSet) -> Rule<'s, Condition> {
    let sensors = references(EntityKind::Sensor, false, STATES.or(WITHIN).or(later));
    let sensors = choice((bare_sensors(), sensors));
    let known =
        state().map(Some).then_ignore(unknown_words(&[TokenKind::Within, TokenKind::OpenBrace]).or_not());
    let unknown = unknown_words(&[TokenKind::Clear, TokenKind::Detect]).or_not().map(|_| None);
    choice((no_list(later.has(TokenKind::OpenBrace)), sensors))
        .then(choice((known, unknown)))
        .then(within(later).or_not())
        .map_with(|((sensors, state), within), extra| Condition {
            sensors,
            state,
            within,
            span: extra.span(),
        })
        .boxed()
}

/// `front left detect`: sensors without their braces. The word after them says that they are sensors, and is not one of them.
fn bare_sensors<'s>() -> impl Parser<'s, Input<'s>, References, Extra<'s>> + Clone {
    let word = STATES.or(WITHIN);
    let name = plain_name().and_is(one_in(word).not()).then_ignore(just(TokenKind::Comma).or_not());
    let names = name.repeated().at_least(1).collect::<Vec<_>>();
    let end = one_in(word).map_with(|_, extra: &mut MapExtra<'s, '_, Input<'s>, Extra<'s>>| extra.span());
    // The doubled negation looks ahead without a trace: mistakes in other lists are reported by their own rule.
    let ahead = names.clone().then(one_in(word)).not().not();
    ahead.ignore_then(names.map_with(|names, extra| (names, extra.span()))).then(end.rewind()).validate(
        |((names, span), end), _, emitter| {
            for (at, brace) in [(span, TokenKind::OpenBrace), (end, TokenKind::CloseBrace)] {
                emitter.emit(Fault::Expected { at, expected: Expected::Word(brace).into() });
            }
            References { names, span, broken: true }
        },
    )
}

fn state<'s>() -> impl Parser<'s, Input<'s>, (SensorState, Span), Extra<'s>> + Clone {
    const WORDS: [(TokenKind, SensorState); 2] =
        [(TokenKind::Clear, SensorState::Clear), (TokenKind::Detect, SensorState::Detect)];
    let exact = WORDS.map(|(word, state)| just(word).to(state));
    // To look whether a word is nearly another one takes longer than all the rest.
    let nearly = WORDS.map(|(word, state)| misspelling(word).to(state));
    choice((choice(exact), choice(nearly))).map_with(|state, extra| (state, extra.span()))
}

/// A word where one of `expected` can be, and the condition that it combines with this one.
fn unknown_words<'s>(expected: &'static [TokenKind]) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    const WORD: TokenSet = TokenSet::of(&[TokenKind::Name, TokenKind::MalformedName]);
    const LIST: TokenSet = NAME.or(TokenSet::of(&[TokenKind::Comma]));
    let list = just(TokenKind::OpenBrace)
        .ignore_then(one_in(LIST).repeated().at_least(1))
        .then_ignore(just(TokenKind::CloseBrace));
    let another = one_in(WORD).ignore_then(list).then_ignore(one_in(STATES.or(WITHIN).or(OPEN)).rewind());
    let another = another.then_ignore(one_in(STATES).or_not()).ignored();
    // The doubled negation looks ahead without a trace: what fails behind the word would hide what is wrong with it.
    let combined = another.clone().not().not().ignore_then(another);
    let ahead = one_in(WORD).then(one_in(OPEN.or(WITHIN))).not().not();
    let word = one_in(WORD).and_is(ahead).ignored();
    choice((combined, word)).validate(move |(), extra, emitter| {
        let expected = expected.iter().copied().map(Expected::Word).collect();
        emitter.emit(Fault::Expected { at: extra.span(), expected });
        emitter.emit(Fault::Skipped(extra.span()));
    })
}

/// `within 40 centimeters`
fn within<'s>(later: TokenSet) -> Rule<'s, Within> {
    just(TokenKind::Within)
        .ignore_then(length(later.without(UNITS)))
        .map_with(|(distance, unit), extra| Within { distance, unit, span: extra.span() })
        .boxed()
}
