//! One piece of a text, from its tokens to what the parser sees of it, and from what the parser says to its errors.

use super::Parse;
use super::errors;
use super::reuse::{Known, known_actions};
use super::slot::Fault;
use crate::ast::Entity;
use crate::cut::misspelt_beginning;
use crate::{Earlier, Span, Token, TokenKind};

/// A piece of a text that is ready for the parser.
pub(super) struct Piece<'s> {
    pub(super) text: &'s str,
    pub(super) span: Span,
    tokens: Box<[Token]>,
    /// The tokens the parser sees, where they are others.
    corrected: Option<Vec<Token>>,
    /// What it does not see, because it is in too many blocks.
    deep: Vec<Span>,
    /// Actions that need not be read again.
    pub(super) known: Vec<Known<'s>>,
}

impl<'s> Piece<'s> {
    pub(super) fn new(text: &'s str, tokens: &[Token], span: Span, earlier: Option<&Earlier<'s>>) -> Self {
        let text = span.text(text);
        let tokens = relocate(tokens, span.start);
        let deep = deep_blocks(&tokens);
        let corrected = corrected(text, &tokens, &deep);
        let mut piece = Self { text, span, tokens, corrected, deep, known: Vec::new() };
        if let Some(earlier) = earlier.filter(|earlier| earlier.now == span && piece.deep.is_empty()) {
            piece.known = known_actions(earlier, piece.significant());
        }
        piece
    }

    /// The tokens the parser sees.
    pub(super) fn significant(&self) -> &[Token] {
        self.corrected.as_deref().unwrap_or(&self.tokens)
    }

    /// What it is, given its tree and what the rules complained about.
    pub(super) fn parse(self, entity: Option<Entity>, faults: Vec<Fault>) -> Parse {
        let mut faults = with_beginning(&self.tokens, self.significant(), faults);
        faults.extend(self.deep.iter().copied().map(Fault::Skipped));
        let kind = entity.as_ref().and_then(Entity::kind);
        let errors = errors::of_faults(self.text, kind, self.significant(), &self.tokens, &faults);
        let skipped_names = errors::skipped_names(self.text, &self.tokens, &faults);
        let faults = faults.iter().map(Fault::span).reduce(Span::to);
        Parse { entity, errors, tokens: self.tokens, skipped_names, faults }
    }
}

/// The tokens the parser sees, where they differ from those of the lexer: no comments, nothing in blocks that are too deep,
/// and a misspelt keyword at the beginning counts as the keyword that it resembles.
fn corrected(piece: &str, tokens: &[Token], deep: &[Span]) -> Option<Vec<Token>> {
    let is_misspelt = misspelt_beginning(piece, tokens).is_some();
    (is_misspelt || tokens.iter().any(is_trivia) || !deep.is_empty()).then(|| {
        let mut significant = without_trivia(tokens);
        significant
            .retain(|(_, span)| !deep.iter().any(|block| block.start <= span.start && span.end <= block.end));
        correct_beginning(piece, tokens, &mut significant);
        significant
    })
}

/// Returns the blocks that are deeper than [`MAX_DEPTH`]: the parser calls itself once per block, and its stack ends.
fn deep_blocks(tokens: &[Token]) -> Vec<Span> {
    let (mut depth, mut inside, mut blocks) = (0_usize, None, Vec::new());
    for (token, span) in tokens {
        match token {
            TokenKind::OpenBrace => {
                depth += 1;
                if depth > MAX_DEPTH {
                    inside.get_or_insert(span.end);
                }
            }
            TokenKind::CloseBrace => {
                depth = depth.saturating_sub(1);
                if let Some(start) = inside.take_if(|_| depth == MAX_DEPTH) {
                    blocks.push(Span::new(start, span.start));
                }
            }
            _ => {}
        }
    }
    blocks.extend(inside.map(|start| Span::new(start, u32::MAX)));
    blocks
}

/// The braces within each other that are parsed; far more than a program may have.
const MAX_DEPTH: usize = 40;

/// Replaces a misspelt keyword at the beginning of an entity by the correct one.
pub(super) fn correct_beginning(text: &str, tokens: &[Token], significant: &mut [Token]) {
    if let (Some(keyword), Some((first, _))) = (misspelt_beginning(text, tokens), significant.first_mut()) {
        *first = keyword;
    }
}

/// The faults, and the one of a misspelt keyword at the beginning.
fn with_beginning(tokens: &[Token], significant: &[Token], mut faults: Vec<Fault>) -> Vec<Fault> {
    let written = tokens.iter().find(|token| !is_trivia(token));
    if let (Some((written, span)), Some((keyword, _))) = (written, significant.first())
        && written != keyword
    {
        faults.insert(0, Fault::TakenForKeyword(*span, *keyword));
    }
    faults
}

fn relocate(tokens: &[Token], start: u32) -> Box<[Token]> {
    tokens.iter().map(|&(token, span)| (token, Span::new(span.start - start, span.end - start))).collect()
}

fn is_trivia((token, _): &Token) -> bool {
    token.is_comment() || *token == TokenKind::Invalid
}

pub(super) fn without_trivia(tokens: &[Token]) -> Vec<Token> {
    tokens.iter().filter(|token| !is_trivia(token)).copied().collect()
}
