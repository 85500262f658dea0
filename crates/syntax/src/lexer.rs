//! From text to tokens. Memoryless: what a token is depends on nothing before it.

use logos::Logos;

use crate::shift::Shift;
use crate::{Span, TokenKind};

/// A token and where it is.
pub type Token = (TokenKind, Span);

const BYTE_ORDER_MARK: &str = "\u{feff}";

/// All tokens of `text`, comments included, in order. A leading byte order mark is passed over; it can only be at
/// the start of a file, because every other text handed in starts at an entity's keyword.
///
/// Texts beyond 4 GiB are cut off there.
pub fn lex(text: &str) -> Vec<Token> {
    lex_unless(text, |_, _| None)
}

/// As [`lex`], without reading what is `known`: it is asked where a token begins, with those before it, and may say which
/// tokens follow and how far they have moved since.
pub(crate) fn lex_unless<'t>(
    text: &str,
    known: impl Fn(u32, &[Token]) -> Option<(&'t [Token], i64)>,
) -> Vec<Token> {
    let start = if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    let mut tokens: Vec<Token> = Vec::with_capacity(text.len() / 6);
    let mut lexer = TokenKind::lexer(&text[start..]);
    while let Some(token) = lexer.next() {
        let range = lexer.span();
        let (Ok(from), Ok(to)) = (u32::try_from(range.start + start), u32::try_from(range.end + start))
        else {
            break;
        };
        let Some((run, by)) = known(from, &tokens) else {
            push(text, &mut tokens, token.unwrap_or(TokenKind::Invalid), Span::new(from, to));
            continue;
        };
        tokens.extend(run.iter().map(|&(token, mut span)| {
            span.shift(by);
            (token, span)
        }));
        let end = tokens.last().map_or(to, |(_, last)| last.end);
        let rest = lexer.remainder().len();
        lexer.bump((end.saturating_sub(to) as usize).min(rest));
    }
    tokens
}

/// Adds a token: to the one before it where both are one mistake, else after it.
fn push(text: &str, tokens: &mut Vec<Token>, token: TokenKind, span: Span) {
    let adjacent = tokens.last().is_some_and(|(_, last)| last.end == span.start);
    if !adjacent || !goes_on(text, tokens, token, span) {
        tokens.push((token, span));
    }
}

/// Adds a token to the adjacent one before it if both are one mistake, and returns whether they are. Characters that begin no
/// token come one by one: adjacent ones are one mistake, and so is `robot-1`.
fn goes_on(text: &str, tokens: &mut [Token], token: TokenKind, span: Span) -> bool {
    let [before @ .., (last_token, last)] = tokens else { return false };
    let goes_on = match (*last_token, token) {
        (TokenKind::Invalid, TokenKind::Invalid) => true,
        (name, TokenKind::Integer | TokenKind::Float | TokenKind::MalformedNumber) => {
            let exponent =
                before.last().is_some_and(|(token, span)| token.is_number() && span.end == last.start);
            may_begin_name(name) && !exponent && span.text(text).starts_with('-')
        }
        // `robot-1a`
        (TokenKind::MalformedName, word) => {
            let after_digit = last.text(text).ends_with(|c: char| c.is_ascii_digit());
            (word.is_name() || word.is_keyword()) && after_digit && !span.text(text).starts_with('^')
        }
        _ => false,
    };
    if goes_on {
        *last_token = if token == TokenKind::Invalid { token } else { TokenKind::MalformedName };
        last.end = span.end;
    }
    goes_on
}

/// Returns whether a number right after the token is meant as a part of a name, as no number follows it. (`move-4` is a
/// move.)
fn may_begin_name(token: TokenKind) -> bool {
    let before_number = token == TokenKind::Within || token.only_before().has(TokenKind::Integer);
    token.is_name() && !before_number || token.entity_kind().is_some()
}
