//! The rules for conditions.

use chumsky::prelude::{Parser, choice, just};

use super::actions::{OPEN, UNITS, length};
use super::slot::{Fault, misspelling, one_in, references};
use super::{Extra, Input, Rule};
use crate::ast::{Condition, SensorState, Until, Within};
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
    references(EntityKind::Sensor, false, STATES.or(WITHIN).or(later))
        .then(state().or_not())
        .then_ignore(unknown_state().or_not())
        .then(within(later).or_not())
        .map_with(|((sensors, state), within), extra| Condition {
            sensors,
            state,
            within,
            span: extra.span(),
        })
        .boxed()
}

fn state<'s>() -> impl Parser<'s, Input<'s>, (SensorState, Span), Extra<'s>> + Clone {
    let word = |token, state| choice((just(token).ignored(), misspelling(token).ignored())).to(state);
    choice((word(TokenKind::Clear, SensorState::Clear), word(TokenKind::Detect, SensorState::Detect)))
        .map_with(|state, extra| (state, extra.span()))
}

/// A word that is neither, where one of the two must be.
fn unknown_state<'s>() -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    const WORD: TokenSet = TokenSet::of(&[TokenKind::Name, TokenKind::MalformedName]);
    let words = [TokenKind::Clear, TokenKind::Detect].map(Expected::Word);
    // The doubled negation looks ahead without a trace: what fails behind the word would hide what is wrong with it.
    let ahead = one_in(WORD).then(one_in(OPEN.or(WITHIN))).not().not();
    one_in(WORD).and_is(ahead).validate(move |_, extra, emitter| {
        emitter.emit(Fault::Expected { at: extra.span(), expected: words.to_vec() });
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
