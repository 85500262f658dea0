//! Two complaints that are one mistake: something is missing in one place because it is in another, or both braces
//! of a list are missing.

use crate::{Expected, Found, Span, SyntaxError, SyntaxErrorKind, Token, TokenKind};

/// The errors, which are in the order of the text, with each such pair as one.
pub(super) fn join(mut errors: Vec<SyntaxError>, tokens: &[Token]) -> Vec<SyntaxError> {
    let mut index = 0;
    while index + 1 < errors.len() {
        let (first, second) = (&errors[index], &errors[index + 1]);
        let joined = misplaced(first, second, tokens)
            .or_else(|| misplaced(second, first, tokens))
            .or_else(|| unbraced(first, second, tokens))
            .or_else(|| needless(first, second));
        if let Some(error) = joined {
            errors[index] = error;
            errors.remove(index + 1);
        }
        index += 1;
    }
    errors
}

/// Too early in `has wheels { a b }`, too late in `movement m r of { … }`.
fn misplaced(stray: &SyntaxError, gap: &SyntaxError, tokens: &[Token]) -> Option<SyntaxError> {
    let SyntaxErrorKind::Unexpected { found: Found::Text(written), inside, .. } = &stray.kind else {
        return None;
    };
    let SyntaxErrorKind::Missing { expected, .. } = &gap.kind else { return None };
    let (token, _) = tokens.iter().find(|(_, span)| *span == stray.span)?;
    let between = stray.span.start.min(gap.span.start)..stray.span.start.max(gap.span.start);
    if tokens
        .iter()
        .any(|(token, span)| token.is_action() && between.contains(&span.start) && *span != stray.span)
    {
        return None;
    }
    let kind = SyntaxErrorKind::Misplaced { written: written.clone(), to: gap.span.start, inside: *inside };
    expected.iter().any(|expected| fills(*token, *expected)).then_some(SyntaxError { span: stray.span, kind })
}

/// Returns whether a token is the missing one.
fn fills(token: TokenKind, expected: Expected) -> bool {
    match expected {
        Expected::Word(word) => {
            word == token && !matches!(word, TokenKind::Comma | TokenKind::OpenBrace | TokenKind::CloseBrace)
        }
        Expected::NameOf(_) | Expected::ReferenceTo(_) => token.is_name(),
        Expected::Number(_) | Expected::Port => {
            matches!(token, TokenKind::Integer | TokenKind::Float)
        }
        Expected::Address => token == TokenKind::Ipv4,
        Expected::Path => token == TokenKind::String,
        Expected::Action | Expected::Declaration => false,
    }
}

/// `has a b wheels`
fn unbraced(first: &SyntaxError, second: &SyntaxError, tokens: &[Token]) -> Option<SyntaxError> {
    let wants = |error: &SyntaxError, brace: TokenKind| match &error.kind {
        SyntaxErrorKind::Missing { expected, .. } => expected.contains(&Expected::Word(brace)),
        _ => false,
    };
    if !wants(first, TokenKind::OpenBrace) || !wants(second, TokenKind::CloseBrace) {
        return None;
    }
    let between = Span::new(first.span.start, second.span.start);
    let opened =
        tokens.iter().any(|(token, span)| *token == TokenKind::OpenBrace && between.touches(span.start));
    let mut inner = tokens.iter().filter(|(_, span)| between.start <= span.start && span.end <= between.end);
    if inner.clone().next().is_some() && inner.all(|(token, _)| *token == TokenKind::CloseBrace) {
        // `turn left until }`: the brace was taken for the list's.
        return Some(first.clone());
    }
    let SyntaxErrorKind::Missing { inside, .. } = first.kind else { return None };
    let kind = SyntaxErrorKind::Unbraced { close: second.span.start, inside };
    (!opened && between.start < between.end).then_some(SyntaxError { span: first.span, kind })
}

/// `has {{ a b }}`
fn needless(first: &SyntaxError, second: &SyntaxError) -> Option<SyntaxError> {
    let is = |error: &SyntaxError, brace: &str| match &error.kind {
        SyntaxErrorKind::Unexpected { found: Found::Text(found), .. } => found == brace,
        _ => false,
    };
    (is(first, "{") && is(second, "}")).then(|| first.clone())
}
