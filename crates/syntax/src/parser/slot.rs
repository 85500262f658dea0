//! Error recovery, the same in every rule: a program is a row of slots, each of which is filled, empty, or holds
//! something else.
//!
//! A slot never fails. Where its content is absent it reports one fault, passes over what fits nowhere up to a token
//! that the slot itself or something after it can begin with, and lets the rest of the entity go on.

use std::cmp::Ordering;

use chumsky::DefaultExpected;
use chumsky::IterParser;
use chumsky::error::{Error, LabelError};
use chumsky::input::{InputRef, MapExtra};
use chumsky::prelude::{Parser, any, choice, custom, empty, end, just, via_parser};
use chumsky::primitive::select;
use chumsky::util::MaybeRef;

use super::expectation::Expectation;
use super::{Extra, Input, Rule};
use crate::ast::{Name, Number, References};
use crate::{EntityKind, Expected, Quantity, Span, TokenKind, TokenSet};

/// The tokens that are left.
type Tokens<'s, 'p> = InputRef<'s, 'p, Input<'s>, Extra<'s>>;

/// A fault that a rule reports while it runs; [`super::errors`] makes errors of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    /// Something else was expected at this token (or at the end).
    Expected { at: Span, expected: Expectation },
    /// These tokens were passed over.
    Skipped(Span),
    /// This token was taken for that keyword.
    TakenForKeyword(Span, TokenKind),
    /// This keyword was taken for a name.
    TakenForName(Span, EntityKind),
    /// This number is none.
    MalformedNumber(Span),
    /// This port has a fraction.
    PortNotWhole(Span),
    /// This list must not be empty.
    EmptyList(Span, EntityKind),
}

impl Fault {
    /// The fault of a rule that only looked ahead.
    pub(super) fn nothing(at: Span) -> Self {
        Self::Expected { at, expected: Expectation::default() }
    }

    /// The tokens that it is about.
    pub(super) fn span(&self) -> Span {
        match self {
            Self::Expected { at: span, .. }
            | Self::Skipped(span)
            | Self::TakenForKeyword(span, _)
            | Self::TakenForName(span, _)
            | Self::MalformedNumber(span)
            | Self::PortNotWhole(span)
            | Self::EmptyList(span, _) => *span,
        }
    }
}

impl<'s> Error<'s, Input<'s>> for Fault {
    fn merge(mut self, other: Self) -> Self {
        if let (Self::Expected { expected, .. }, Self::Expected { expected: more, .. }) = (&mut self, other) {
            *expected = expected.or(more);
        }
        self
    }
}

impl<'s> LabelError<'s, Input<'s>, DefaultExpected<'s, TokenKind>> for Fault {
    fn expected_found<E: IntoIterator<Item = DefaultExpected<'s, TokenKind>>>(
        expected: E,
        _: Option<MaybeRef<'s, TokenKind>>,
        at: Span,
    ) -> Self {
        let words = expected.into_iter().filter_map(|pattern| match pattern {
            DefaultExpected::Token(token) => Some(Expected::Word(*token)),
            _ => None,
        });
        Self::Expected { at, expected: words.collect() }
    }
}

impl<'s> LabelError<'s, Input<'s>, Expected> for Fault {
    fn expected_found<E: IntoIterator<Item = Expected>>(
        expected: E,
        _: Option<MaybeRef<'s, TokenKind>>,
        at: Span,
    ) -> Self {
        Self::Expected { at, expected: expected.into_iter().collect() }
    }

    fn label_with(&mut self, label: Expected) {
        if let Self::Expected { expected, .. } = self {
            *expected = label.into();
        }
    }
}

/// One token that `judge` makes something of, from the token, its place and the text.
pub(super) fn take<'s, O>(
    judge: impl Fn(TokenKind, Span, &'s str) -> Option<O> + Clone + 's,
) -> impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone {
    select(move |token, extra: &mut MapExtra<'s, '_, Input<'s>, Extra<'s>>| {
        judge(token, extra.span(), extra.state().text)
    })
}

/// `part`, or nothing and a fault. `first` is what `part` begins with, `later` what can follow it.
pub(super) fn slot<'s, O: 's>(
    part: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    first: TokenSet,
    later: TokenSet,
) -> Rule<'s, Option<O>> {
    // `with { … }` begins the next clause and is not passed over for its brace, nor is the `wait` of `wait 2 seconds` for
    // its number.
    slot_passing(
        ANY.without(later.and(ACTION_WORDS.or(TokenSet::of(&[TokenKind::With])))),
        part,
        first,
        later,
    )
}

/// Like [`slot`], but what can follow is never passed over: a clause that is only begun leaves the next action whole.
pub(super) fn slot_before<'s, O: 's>(
    part: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    first: TokenSet,
    later: TokenSet,
) -> Rule<'s, Option<O>> {
    slot_passing(ANY.without(later), part, first, later)
}

/// The one token before the content that can be passed over for it is in `passed`.
fn slot_passing<'s, O: 's>(
    passed: TokenSet,
    part: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    first: TokenSet,
    later: TokenSet,
) -> Rule<'s, Option<O>> {
    slot_or(passed, part.map(Some), empty().map(|()| None), first, later)
}

/// `part`, or `otherwise` and a fault.
fn slot_or<'s, O: 's>(
    passed: TokenSet,
    part: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    otherwise: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    first: TokenSet,
    later: TokenSet,
) -> Rule<'s, O> {
    let stray = skip_before(passed, first).ignore_then(part.clone());
    part.clone()
        .recover_with(via_parser(stray))
        .recover_with(via_parser(skip_to(first.or(later)).ignore_then(choice((part, otherwise)))))
        .boxed()
}

/// Something in braces that is in other braces, where `rest` is what is after the opening one. Without that it is not
/// there, and the next closing brace belongs to what it is in, unless there is one too many.
pub(super) fn braced<'s, O: Default + 's>(
    rest: impl Parser<'s, Input<'s>, O, Extra<'s>> + Clone + 's,
    later: TokenSet,
) -> Rule<'s, O> {
    const OPEN: TokenSet = TokenSet::of(&[TokenKind::OpenBrace]);
    let is_closed = empty().try_map_with(|(), extra: &mut MapExtra<'s, '_, Input<'s>, Extra<'s>>| {
        let span = extra.span();
        (extra.state().closed == Ordering::Greater).then_some(()).ok_or_else(|| Fault::nothing(span))
    });
    let otherwise = choice((is_closed.ignore_then(rest.clone()), empty().map(|()| O::default())));
    let part = just(TokenKind::OpenBrace).ignore_then(rest);
    slot_or(ANY.without(later.and(ACTION_WORDS)), part, otherwise, OPEN, later)
}

/// Where the list of a condition is not there: before the brace that closes what it is in, and, where a block follows it,
/// before the actions of that. It reports what is missing.
pub(super) fn no_list<'s>(before_block: bool) -> impl Parser<'s, Input<'s>, References, Extra<'s>> + Clone {
    let close = brace(TokenKind::CloseBrace, |closed| closed != Ordering::Greater)
        .map(|at| (at, Expected::Word(TokenKind::OpenBrace)));
    let block = brace(TokenKind::OpenBrace, move |closed| before_block && closed == Ordering::Equal)
        .then_ignore(choice((one_in(HARD_ACTIONS).ignored(), action_ahead())))
        .map(|at| (at, Expected::ReferenceTo(EntityKind::Sensor)));
    let ahead = choice((close, block));
    // The doubled negation looks ahead without a trace.
    ahead.clone().not().not().ignore_then(ahead.rewind()).validate(|(at, expected), _, emitter| {
        emitter.emit(Fault::Expected { at, expected: expected.into() });
        References { names: Vec::new(), span: Span::at(at.start), broken: true }
    })
}

/// A brace in an entity whose braces are `judge`d like that.
fn brace<'s>(
    which: TokenKind,
    judge: impl Fn(Ordering) -> bool + Clone + 's,
) -> impl Parser<'s, Input<'s>, Span, Extra<'s>> + Clone {
    select(move |token, extra: &mut MapExtra<'s, '_, Input<'s>, Extra<'s>>| {
        (token == which && judge(extra.state().closed)).then(|| extra.span())
    })
}

/// The keyword (or sign) `word`, forgiving a slip of spelling, or one other token in its place where what follows it
/// is in `next`.
pub(super) fn keyword<'s>(word: TokenKind, next: TokenSet, later: TokenSet) -> Rule<'s, Option<Span>> {
    let first = TokenSet::of(&[word]);
    let exact = just(word).map_with(|_, extra| extra.span());
    let misspelt = misspelling(word);
    // What can follow is not replaced, unless it may be a name.
    let replaced = ANY.without(later.without(NAME.without(ACTION_WORDS)));
    exact
        .map(Some)
        .recover_with(via_parser(skip_before(ANY, first).ignore_then(exact).map(Some)))
        .recover_with(via_parser(misspelt.map(Some)))
        .recover_with(via_parser(skip_before(replaced, next).to(None)))
        .recover_with(via_parser(skip_to(first.or(next).or(later)).ignore_then(exact.or_not())))
        .boxed()
}

/// A word that is nearly `word`.
pub(super) fn misspelling<'s>(word: TokenKind) -> impl Parser<'s, Input<'s>, Span, Extra<'s>> + Clone {
    take(move |token, span, text| looks_like(token, span, text, word).then_some(span)).validate(
        move |span, _, emitter| {
            emitter.emit(Fault::TakenForKeyword(span, word));
            span
        },
    )
}

fn looks_like(token: TokenKind, span: Span, text: &str, word: TokenKind) -> bool {
    (token.is_name() || token.is_keyword()) && word.is_similar_to(span.text(text))
}

/// Passes over tokens up to one of `until` or the end, and says which.
fn skip_to<'s>(until: TokenSet) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    custom(move |input: &mut Tokens<'s, '_>| {
        pass_over(input, until);
        Ok(())
    })
}

/// Like [`skip_to`], but there must be something to pass over.
pub(super) fn skip_some<'s>(until: TokenSet) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    custom(move |input: &mut Tokens<'s, '_>| {
        let begin = input.cursor();
        if pass_over(input, until) { Ok(()) } else { Err(Fault::nothing(input.span_since(&begin))) }
    })
}

/// Passes over tokens up to one of `until` or the end, says which, and returns whether there were any. A function instead of
/// parsers: nearly every rule has it, and would contain those.
#[inline(never)]
fn pass_over(input: &mut Tokens<'_, '_>, until: TokenSet) -> bool {
    let begin = input.cursor();
    while input.peek().is_some_and(|token| !until.or(CURSOR).has(token)) {
        input.skip();
    }
    let passed = input.span_since(&begin);
    if !passed.is_empty() {
        input.emit(Fault::Skipped(passed));
    }
    !passed.is_empty()
}

/// Like [`skip_some`], but a list in braces is passed over whole: its closing brace closes nothing else.
pub(super) fn skip_statement<'s>(until: TokenSet) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    skip_lists_and(until, until)
}

/// Like [`skip_statement`], but an opening brace that begins no list is not passed over.
pub(super) fn skip_to_block<'s>(until: TokenSet) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    skip_lists_and(until, until.or(TokenSet::of(&[TokenKind::OpenBrace])))
}

/// Passes over lists without anything of `outside`, and other tokens that are not in `until`.
fn skip_lists_and<'s>(
    outside: TokenSet,
    until: TokenSet,
) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    const BRACES: TokenSet = TokenSet::of(&[TokenKind::OpenBrace, TokenKind::CloseBrace]);
    let inside = any().filter(move |token: &TokenKind| !outside.or(CURSOR).or(BRACES).has(*token)).repeated();
    let list =
        just(TokenKind::OpenBrace).ignore_then(inside).then_ignore(just(TokenKind::CloseBrace)).ignored();
    let other = any().filter(move |token: &TokenKind| !until.or(CURSOR).has(*token)).ignored();
    let skipped = choice((list, other)).repeated().at_least(1);
    skipped.validate(|(), extra, emitter| emitter.emit(Fault::Skipped(extra.span())))
}

/// Passes over one token of `set` that is right before one of `next`.
pub(super) fn skip_before<'s>(
    set: TokenSet,
    next: TokenSet,
) -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    custom(move |input: &mut Tokens<'s, '_>| pass_one_over(input, set, next))
}

#[inline(never)]
fn pass_one_over(input: &mut Tokens<'_, '_>, set: TokenSet, next: TokenSet) -> Result<(), Fault> {
    let begin = input.cursor();
    let first = input.next();
    let passed = input.span_since(&begin);
    let is_in = |token: Option<TokenKind>, set: TokenSet| token.is_some_and(|token| set.has(token));
    if !is_in(first, set) || !is_in(input.peek(), next) {
        return Err(Fault::nothing(passed));
    }
    input.emit(Fault::Skipped(passed));
    Ok(())
}

/// One of the tokens of a set.
pub(super) fn one_in<'s>(set: TokenSet) -> impl Parser<'s, Input<'s>, TokenKind, Extra<'s>> + Clone {
    any().filter(move |token: &TokenKind| set.has(*token))
}

/// Nothing more, or a fault; whatever is left is passed over.
pub(super) fn nothing_more<'s>() -> Rule<'s, ()> {
    end().labelled(Expected::Declaration).recover_with(via_parser(skip_to(TokenSet::default()))).boxed()
}

/// Every token that may be passed over.
const ANY: TokenSet = TokenSet::all_but(TokenKind::Cursor);

/// The tokens that are never taken for a name.
const SIGNS: TokenSet =
    TokenSet::of(&[TokenKind::CloseBrace, TokenKind::Comma, TokenKind::Colon, TokenKind::String]).or(NUMBER);

/// Nothing passes over the cursor: the question is what could be there.
const CURSOR: TokenSet = TokenSet::of(&[TokenKind::Cursor]);

/// The first tokens of a name.
pub(super) const NAME: TokenSet = TokenKind::NAMES;

/// The keywords that are no names and begin an action.
pub(super) const HARD_ACTIONS: TokenSet = TokenSet::of(&TokenKind::ACTIONS).without(NAME);

/// The keywords that begin an action wherever one can begin, and are names elsewhere.
const ACTION_WORDS: TokenSet = TokenSet::of(&TokenKind::ACTIONS).and(NAME);

/// The first tokens of a number.
pub(super) const NUMBER: TokenSet = TokenKind::NUMBERS;

/// The name of a new entity; a keyword in its place is taken for a name where what follows it is in `next`.
pub(super) fn declared_name<'s>(kind: EntityKind, next: TokenSet, later: TokenSet) -> Rule<'s, Option<Name>> {
    name(kind, Expected::NameOf(kind), next, later)
}

/// The name of an entity declared elsewhere.
pub(super) fn reference<'s>(kind: EntityKind, next: TokenSet, later: TokenSet) -> Rule<'s, Option<Name>> {
    name(kind, Expected::ReferenceTo(kind), next, later)
}

fn name<'s>(kind: EntityKind, label: Expected, next: TokenSet, later: TokenSet) -> Rule<'s, Option<Name>> {
    let exact = plain_name().labelled(label);
    let taken = keyword_for_name(kind, TokenSet::default())
        .then_ignore(choice((one_in(next).ignored(), end())).rewind());
    let stray = skip_before(SIGNS, NAME).ignore_then(exact.clone());
    exact
        .clone()
        .map(Some)
        .recover_with(via_parser(stray.map(Some)))
        .recover_with(via_parser(taken.map(Some)))
        .recover_with(via_parser(skip_to(NAME.or(next).or(later)).ignore_then(exact.or_not())))
        .boxed()
}

pub(super) fn plain_name<'s>() -> impl Parser<'s, Input<'s>, Name, Extra<'s>> + Clone {
    take(|token, span, text| token.is_name().then(|| name_at(span, text)))
}

/// Before what is more than a name: the keyword of an action and what only that action has after it.
pub(super) fn action_ahead<'s>() -> impl Parser<'s, Input<'s>, (), Extra<'s>> + Clone {
    let belongs = |(word, next): &(TokenKind, TokenKind)| word.only_before().has(*next);
    one_in(ACTION_WORDS).then(any()).filter(belongs).ignored()
}

fn keyword_for_name<'s>(
    kind: EntityKind,
    but: TokenSet,
) -> impl Parser<'s, Input<'s>, Name, Extra<'s>> + Clone {
    take(move |token, span, text| (token.is_keyword() && !but.has(token)).then(|| name_at(span, text)))
        .validate(move |name, _, emitter| {
            emitter.emit(Fault::TakenForName(name.span, kind));
            name
        })
}

fn name_at(span: Span, text: &str) -> Name {
    Name { text: span.text(text).trim_start_matches('^').into(), span }
}

/// A number.
pub(super) fn number<'s>(quantity: Quantity) -> impl Parser<'s, Input<'s>, Number, Extra<'s>> + Clone {
    take(|token, span, text| NUMBER.has(token).then_some((token, span, text)))
        .validate(|(token, span, text): (TokenKind, Span, &str), _, emitter| {
            let value = match token {
                TokenKind::Integer | TokenKind::Float => span.text(text).parse().ok(),
                _ => {
                    emitter.emit(Fault::MalformedNumber(span));
                    None
                }
            };
            Number { value, span }
        })
        .labelled(Expected::Number(quantity))
}

/// `{ a, b c }` up to and with its closing brace. `later` is what can follow the list.
pub(super) fn references<'s>(
    kind: EntityKind,
    may_be_empty: bool,
    later: TokenSet,
) -> impl Parser<'s, Input<'s>, References, Extra<'s>> + Clone {
    let inside = NAME.or(TokenSet::of(&[TokenKind::CloseBrace]));
    let open =
        slot(just(TokenKind::OpenBrace).ignored(), TokenSet::of(&[TokenKind::OpenBrace]), inside.or(later));
    let stop = TokenSet::of(&[TokenKind::CloseBrace]).or(later);
    let item = plain_name()
        .and_is(action_ahead().not())
        .labelled(Expected::ReferenceTo(kind))
        .map(Some)
        .recover_with(via_parser(keyword_for_name(kind, stop).map(Some)))
        .recover_with(via_parser(skip_some(NAME.or(stop)).to(None)))
        .then_ignore(just(TokenKind::Comma).or_not())
        .boxed();
    let close = slot(just(TokenKind::CloseBrace).ignored(), TokenSet::of(&[TokenKind::CloseBrace]), later);
    open.then(item.repeated().collect::<Vec<_>>())
        .then(close)
        .map_with(|((open, items), close), extra| {
            let broken = items.iter().any(Option::is_none);
            let list =
                References { names: items.into_iter().flatten().collect(), span: extra.span(), broken };
            (list, open.is_some() && close.is_some())
        })
        // A list without its braces is another mistake than one with nothing in it.
        .validate(move |(list, braced), _, emitter| {
            if braced && list.names.is_empty() && !list.broken && !may_be_empty {
                emitter.emit(Fault::EmptyList(list.span, kind));
            }
            list
        })
        .boxed()
}
