//! From the tokens of one entity to its tree, with chumsky.
//!
//! One parser per kind of entity; [`slot`] holds the way all of them recover, [`tidy`] turns what they report into
//! one error per mistake.

mod components;
mod environment;
mod movement;
mod pairs;
mod robot;
mod slot;
mod tidy;

use chumsky::Boxed;
use chumsky::Parser as _;
use chumsky::extra::{self, SimpleState};
use chumsky::input::{Input as _, MappedInput};
use smol_str::SmolStr;

use self::slot::Fault;
use crate::ast::Entity;
use crate::cut::misspelt_beginning;
use crate::{EntityKind, Expected, Lexeme, Span, SyntaxError, Token, cut, lex};

type Input<'s> = MappedInput<'s, Token, Span, &'s [Lexeme]>;
type Extra<'s> = extra::Full<Fault, SimpleState<&'s str>, ()>;
type Rule<'s, O> = Boxed<'s, 's, Input<'s>, O, Extra<'s>>;

/// What one piece of a file turned out to be.
#[derive(Debug, Clone, PartialEq)]
pub struct Parse {
    /// The tree; `None` for what stands before the first entity.
    pub entity: Option<Entity>,
    /// In the order of the text.
    pub errors: Vec<SyntaxError>,
    /// All tokens, comments included.
    pub lexemes: Box<[Lexeme]>,
    /// Names in text that had to be skipped. They may be declarations that a mistake hides, so nobody should be told
    /// that such a name does not exist.
    pub skipped_names: Vec<SmolStr>,
}

/// How many pieces are read with the same rules: so many that building those hardly counts, and so few that what is
/// kept beside them stays small.
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
    let lexemes = lex(text);
    parse_cut(text, &lexemes, &cut(text, &lexemes), emit);
}

/// As [`parse_each`], of a text that is lexed and cut already.
pub fn parse_cut(text: &str, lexemes: &[Lexeme], starts: &[usize], mut emit: impl FnMut(Span, Parse)) {
    let end = Span::of(text).end;
    let mut pieces = Vec::with_capacity(starts.len() + 1);
    let first_start = starts.first().map_or(end, |&index| lexemes[index].1.start);
    if first_start > 0 || starts.is_empty() {
        pieces.push((0, 0));
    }
    pieces.extend(starts.iter().map(|&index| (index, lexemes[index].1.start)));
    let bounds: Vec<_> = (0..pieces.len())
        .map(|i| {
            let (from, start) = pieces[i];
            let (to, end) = pieces.get(i + 1).copied().unwrap_or((lexemes.len(), end));
            (&lexemes[from..to], Span::new(start, end))
        })
        .collect();
    for batch in bounds.chunks(BATCH) {
        parse_batch(text, batch, &mut emit);
    }
}

/// What could stand behind these tokens of one entity, each kind of thing once; `lexemes` are places in `text`. This is
/// the grammar's own answer: the parser is asked what it expects at a token that fits nowhere.
pub fn expected_after(text: &str, lexemes: &[Lexeme]) -> Vec<Expected> {
    let mut tokens = without_trivia(lexemes);
    if tokens.is_empty() {
        return vec![Expected::Declaration];
    }
    correct_beginning(text, lexemes, &mut tokens);
    let cursor = tokens.last().map_or(0, |(_, span)| span.end);
    tokens.push((Token::Cursor, Span::at(cursor)));
    let (_, faults) = Parser::new().run(text, &tokens);
    let expected = faults.iter().find_map(|fault| match fault {
        Fault::Expected { at, expected } if at.start >= cursor => Some(expected.clone()),
        _ => None,
    });
    let mut expected = expected.unwrap_or_default();
    expected.sort_unstable();
    expected.dedup();
    let brace = Expected::Word(Token::CloseBrace);
    if expected.contains(&brace) && must_not_close(text, &tokens) {
        expected.retain(|other| *other != brace);
    }
    expected
}

/// Whether `tokens`, the last of which is the cursor, end in a list that must not be empty and still is.
fn must_not_close(text: &str, tokens: &[Lexeme]) -> bool {
    let [before @ .., (Token::OpenBrace, open), (Token::Cursor, cursor)] = tokens else { return false };
    let closed = [before, &[(Token::OpenBrace, *open), (Token::CloseBrace, *cursor)]].concat();
    let (_, faults) = Parser::new().run(text, &closed);
    faults.iter().any(|fault| matches!(fault, Fault::EmptyList(span, _) if span.end >= cursor.end))
}

fn parse_batch(text: &str, bounds: &[(&[Lexeme], Span)], emit: &mut impl FnMut(Span, Parse)) {
    let relative: Vec<Box<[Lexeme]>> =
        bounds.iter().map(|(lexemes, span)| relocate(lexemes, span.start)).collect();
    let changed: Vec<Option<Vec<Lexeme>>> = bounds
        .iter()
        .zip(&relative)
        .map(|((_, span), lexemes)| tokens_to_parse(span.text(text), lexemes))
        .collect();
    let mut parser = Parser::new();
    let trees: Vec<_> = bounds
        .iter()
        .zip(relative.iter().zip(&changed))
        .map(|((_, span), (all, some))| parser.run(span.text(text), some.as_deref().unwrap_or(all)))
        .collect();
    drop(parser);
    let tokens = relative.into_iter().zip(&changed);
    for (((_, span), (lexemes, some)), (entity, faults)) in bounds.iter().zip(tokens).zip(trees) {
        let piece = span.text(text);
        let tokens = some.as_deref().unwrap_or(&lexemes);
        let faults = with_beginning(&lexemes, tokens, faults);
        let errors = tidy::tidy(piece, entity.as_ref().and_then(Entity::kind), tokens, &lexemes, &faults);
        let skipped_names = tidy::skipped_names(piece, tokens, &faults);
        emit(*span, Parse { entity, errors, lexemes, skipped_names });
    }
}

/// The tokens the parser sees, where these are not the lexer's: no comments, and a misspelt keyword at the beginning is
/// the one that is meant.
fn tokens_to_parse(piece: &str, lexemes: &[Lexeme]) -> Option<Vec<Lexeme>> {
    let is_misspelt = misspelt_beginning(piece, lexemes).is_some();
    (is_misspelt || has_trivia(lexemes)).then(|| {
        let mut tokens = without_trivia(lexemes);
        correct_beginning(piece, lexemes, &mut tokens);
        tokens
    })
}

/// Writes the keyword that is meant for a misspelt one that begins an entity.
fn correct_beginning(text: &str, lexemes: &[Lexeme], tokens: &mut [Lexeme]) {
    if let (Some(keyword), Some((first, _))) = (misspelt_beginning(text, lexemes), tokens.first_mut()) {
        *first = keyword;
    }
}

/// The faults, and the one of a misspelt keyword at the beginning.
fn with_beginning(lexemes: &[Lexeme], tokens: &[Lexeme], mut faults: Vec<Fault>) -> Vec<Fault> {
    let written = lexemes.iter().find(|lexeme| !is_trivia(lexeme));
    if let (Some((written, span)), Some((meant, _))) = (written, tokens.first())
        && written != meant
    {
        faults.insert(0, Fault::TakenForKeyword(*span, *meant));
    }
    faults
}

fn relocate(lexemes: &[Lexeme], start: u32) -> Box<[Lexeme]> {
    lexemes.iter().map(|&(token, span)| (token, Span::new(span.start - start, span.end - start))).collect()
}

fn is_trivia((token, _): &Lexeme) -> bool {
    token.is_comment() || *token == Token::Invalid
}

fn has_trivia(lexemes: &[Lexeme]) -> bool {
    lexemes.iter().any(is_trivia)
}

fn without_trivia(lexemes: &[Lexeme]) -> Vec<Lexeme> {
    lexemes.iter().filter(|lexeme| !is_trivia(lexeme)).copied().collect()
}

/// The grammar's rules, each built when it is first needed: building one costs more than parsing an entity with it.
struct Parser<'s> {
    rules: [Option<Rule<'s, Option<Entity>>>; RULES],
}

const RULES: usize = 8;

impl<'s> Parser<'s> {
    fn new() -> Self {
        Self { rules: [const { None }; RULES] }
    }

    fn run(&mut self, text: &'s str, tokens: &'s [Lexeme]) -> (Option<Entity>, Vec<Fault>) {
        let Some(&(first, _)) = tokens.first() else { return (None, Vec::new()) };
        let (index, build) = rule_for(first);
        let rule = self.rules[index].get_or_insert_with(build);
        let input = tokens.split_token_span(Span::at(Span::of(text).end));
        let (tree, faults) = rule.parse_with_state(input, &mut SimpleState(text)).into_output_errors();
        (tree.flatten(), faults)
    }
}

type Build<'s> = fn() -> Rule<'s, Option<Entity>>;

fn rule_for<'s>(first: Token) -> (usize, Build<'s>) {
    match first.entity_kind() {
        Some(EntityKind::Wheel) => (1, || components::wheel()),
        Some(EntityKind::Sensor) => (2, || components::sensor()),
        Some(EntityKind::Ip) => (3, || components::ip()),
        Some(EntityKind::Robot) => (4, || robot::robot()),
        Some(EntityKind::Movement) => (5, || movement::movement()),
        Some(EntityKind::Environment) => (6, || environment::environment()),
        None if first == Token::Import => (7, || components::import()),
        None => (0, || components::preamble()),
    }
}

#[cfg(test)]
mod tests;
