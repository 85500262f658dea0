//! From the tokens of one entity to its tree, with chumsky.
//!
//! One parser per kind of entity; [`slot`] holds the way all of them recover, [`errors`] turns what they report into
//! one error per mistake.

mod actions;
mod components;
mod condition;
mod environment;
mod errors;
mod expectation;
mod movement;
mod pairs;
mod piece;
mod reuse;
mod robot;
mod slot;

use std::cmp::Ordering;

use chumsky::Boxed;
use chumsky::Parser as _;
use chumsky::extra::{self, SimpleState};
use chumsky::input::{Input as _, MappedInput};
use smol_str::SmolStr;

use self::piece::{Piece, correct_beginning, without_trivia};
use self::reuse::Known;
use self::slot::Fault;
use crate::ast::Entity;
use crate::{Earlier, EntityKind, Expected, Span, SyntaxError, Token, TokenKind, cut, lex, lex_again};

type Input<'s> = MappedInput<'s, TokenKind, Span, &'s [Token]>;
type Extra<'s> = extra::Full<Fault, SimpleState<Source<'s>>, ()>;
type Rule<'s, O> = Boxed<'s, 's, Input<'s>, O, Extra<'s>>;

/// The context of an entity that the rules see beside its tokens.
#[derive(Debug, Clone, Copy)]
struct Source<'s> {
    text: &'s str,
    /// The number of its closing braces, compared with that of its opening ones.
    closed: Ordering,
    /// Actions that need not be read again.
    known: &'s [Known<'s>],
}

/// The result of parsing one piece of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Parse {
    /// The tree; `None` for the text before the first entity.
    pub entity: Option<Entity>,
    /// In the order of the text.
    pub errors: Vec<SyntaxError>,
    /// All tokens, comments included.
    pub tokens: Box<[Token]>,
    /// Names in text that had to be skipped. They may be declarations that a mistake hides, so nothing should report
    /// that such a name does not exist.
    pub skipped_names: Vec<SmolStr>,
    /// From the first complaint of a rule to the last one, those that are no error of their own included.
    faults: Option<Span>,
}

/// The number of pieces that are read with the same rules: so many that building those hardly counts, and so few that
/// the data kept beside them stays small.
const BATCH: usize = 512;

/// Cuts and parses a whole text: each piece with the range it covers. The pieces tile the text; spans inside a piece
/// count from its start. There is always at least one piece, and only the first can be without an entity.
pub fn parse(text: &str) -> Vec<(Span, Parse)> {
    let mut parses = Vec::new();
    parse_each(text, |span, parse| parses.push((span, parse)));
    parses
}

/// As [`parse`], handing over one piece after the other.
pub fn parse_each(text: &str, emit: impl FnMut(Span, Parse)) {
    let tokens = lex(text);
    parse_cut(text, &tokens, &cut(text, &tokens), None, emit);
}

/// As [`parse`], where one of the pieces was read before an edit inside it.
pub fn parse_again(text: &str, earlier: Option<Earlier<'_>>) -> Vec<(Span, Parse)> {
    let tokens = lex_again(text, earlier.as_ref());
    let mut parses = Vec::new();
    parse_cut(text, &tokens, &cut(text, &tokens), earlier, |span, parse| parses.push((span, parse)));
    parses
}

/// As [`parse_again`], of a text that is lexed and cut already.
pub fn parse_cut(
    text: &str,
    tokens: &[Token],
    starts: &[usize],
    earlier: Option<Earlier<'_>>,
    mut emit: impl FnMut(Span, Parse),
) {
    let end = Span::of(text).end;
    let mut pieces = Vec::with_capacity(starts.len() + 1);
    let first_start = starts.first().map_or(end, |&index| tokens[index].1.start);
    if first_start > 0 || starts.is_empty() {
        pieces.push((0, 0));
    }
    pieces.extend(starts.iter().map(|&index| (index, tokens[index].1.start)));
    let bounds: Vec<_> = (0..pieces.len())
        .map(|i| {
            let (from, start) = pieces[i];
            let (to, end) = pieces.get(i + 1).copied().unwrap_or((tokens.len(), end));
            (&tokens[from..to], Span::new(start, end))
        })
        .collect();
    for batch in bounds.chunks(BATCH) {
        parse_batch(text, batch, earlier.as_ref(), &mut emit);
    }
}

/// Returns all that can follow these tokens of one entity, each kind of thing once; their spans are relative to `text`.
/// This is the grammar's own answer: the parser is asked what it expects at a token that fits nowhere.
pub fn expected_after(text: &str, tokens: &[Token]) -> Vec<Expected> {
    let mut significant = without_trivia(tokens);
    if significant.is_empty() {
        return vec![Expected::Declaration];
    }
    correct_beginning(text, tokens, &mut significant);
    let cursor = significant.last().map_or(0, |(_, span)| span.end);
    significant.push((TokenKind::Cursor, Span::at(cursor)));
    let (_, faults) = Parser::new().run(text, &significant, &[]);
    let expected = faults.iter().find_map(|fault| match fault {
        Fault::Expected { at, expected } if at.start >= cursor => Some(expected.to_vec()),
        _ => None,
    });
    let mut expected = expected.unwrap_or_default();
    let brace = Expected::Word(TokenKind::CloseBrace);
    if expected.contains(&brace) && must_not_close(text, &significant) {
        expected.retain(|other| *other != brace);
    }
    expected
}

/// Returns whether `significant`, the last of which is the cursor, end in a list that must not be empty and still is.
fn must_not_close(text: &str, significant: &[Token]) -> bool {
    let [before @ .., (TokenKind::OpenBrace, open), (TokenKind::Cursor, cursor)] = significant else {
        return false;
    };
    let closed = [before, &[(TokenKind::OpenBrace, *open), (TokenKind::CloseBrace, *cursor)]].concat();
    let (_, faults) = Parser::new().run(text, &closed, &[]);
    faults.iter().any(|fault| matches!(fault, Fault::EmptyList(span, _) if span.end >= cursor.end))
}

fn parse_batch(
    text: &str,
    bounds: &[(&[Token], Span)],
    earlier: Option<&Earlier<'_>>,
    emit: &mut impl FnMut(Span, Parse),
) {
    let pieces: Vec<Piece<'_>> =
        bounds.iter().map(|(tokens, span)| Piece::new(text, tokens, *span, earlier)).collect();
    let mut parser = Parser::new();
    let read: Vec<_> =
        pieces.iter().map(|piece| parser.run(piece.text, piece.significant(), &piece.known)).collect();
    drop(parser);
    for (piece, (entity, faults)) in pieces.into_iter().zip(read) {
        emit(piece.span, piece.parse(entity, faults));
    }
}

/// The grammar's rules, each built when it is first needed: building one costs more than parsing an entity with it.
struct Parser<'s> {
    rules: [Option<Rule<'s, Option<Entity>>>; RULES],
}

const RULES: usize = 9;

impl<'s> Parser<'s> {
    fn new() -> Self {
        Self { rules: [const { None }; RULES] }
    }

    /// Parses one entity, of which some actions may be known.
    fn run(
        &mut self,
        text: &'s str,
        significant: &'s [Token],
        known: &'s [Known<'s>],
    ) -> (Option<Entity>, Vec<Fault>) {
        let Some(&(first, _)) = significant.first() else { return (None, Vec::new()) };
        let (index, build) = rule_for(first, !known.is_empty());
        let rule = self.rules[index].get_or_insert_with(build);
        let input = significant.split_token_span(Span::at(Span::of(text).end));
        let open = significant.iter().fold(0_i64, |open, (token, _)| match token {
            TokenKind::OpenBrace => open + 1,
            TokenKind::CloseBrace => open - 1,
            _ => open,
        });
        let closed = 0.cmp(&open);
        let mut state = SimpleState(Source { text, closed, known });
        let (tree, faults) = rule.parse_with_state(input, &mut state).into_output_errors();
        (tree.flatten(), faults)
    }
}

type Build<'s> = fn() -> Rule<'s, Option<Entity>>;

/// The place of a rule and how it is built, for an entity that begins so; `again` if some of its actions are known.
fn rule_for<'s>(first: TokenKind, again: bool) -> (usize, Build<'s>) {
    match first.entity_kind() {
        Some(EntityKind::Wheel) => (1, || components::wheel()),
        Some(EntityKind::Sensor) => (2, || components::sensor()),
        Some(EntityKind::Ip) => (3, || components::ip()),
        Some(EntityKind::Robot) => (4, || robot::robot()),
        Some(EntityKind::Movement) if again => (8, || movement::movement(true)),
        Some(EntityKind::Movement) => (5, || movement::movement(false)),
        Some(EntityKind::Environment) => (6, || environment::environment()),
        None if first == TokenKind::Import => (7, || components::import()),
        None => (0, || components::preamble()),
    }
}
