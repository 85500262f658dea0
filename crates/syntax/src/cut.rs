//! Cutting a file's tokens into entities, before any of them is parsed.
//!
//! Entities tile the file: each begins at its keyword and reaches to the next one's; what is before the first is
//! a piece of its own. A mistake inside an entity, such as a brace that is never closed, therefore never reaches the
//! next one. A word that is nearly a keyword begins an entity, too, where what follows it leaves no doubt.
//!
//! The decision that a token begins an entity depends on the entity it is in, the token before it and the [`LOOKAHEAD`]
//! tokens after it and on nothing else. That bound is what incremental analysis relies on; widen it only together with
//! `pydslrep-analysis`'s rule for growing the window of an edit.

use crate::{EntityKind, Token, TokenKind, TokenSet};

/// The number of tokens after one that can matter for whether it begins an entity.
pub const LOOKAHEAD: usize = 2;

/// The indices into `tokens`, which are places in `text`, at which entities (and imports) begin.
pub fn cut(text: &str, tokens: &[Token]) -> Vec<usize> {
    let mut starts = Vec::new();
    let mut inside = None;
    let mut previous = None;
    for (index, &(token, _)) in tokens.iter().enumerate() {
        if token.is_comment() {
            continue;
        }
        let keyword = if could_begin(token) {
            let next = tokens[index + 1..].iter().map(|(token, _)| *token).find(|token| !token.is_comment());
            begins_entity(token, previous, next, inside).then_some(token)
        } else {
            Some(token)
                .filter(|token| could_be_misspelt(*token) && may_end(previous, *token, inside))
                .and_then(|_| misspelt_beginning(text, &tokens[index..]))
        };
        if let Some(keyword) = keyword {
            starts.push(index);
            inside = keyword.entity_kind();
        }
        previous = Some(keyword.unwrap_or(token));
    }
    starts
}

fn could_begin(token: TokenKind) -> bool {
    token == TokenKind::Import || token.entity_kind().is_some()
}

/// Names, and the plurals that are keywords of their own.
fn could_be_misspelt(token: TokenKind) -> bool {
    matches!(token, TokenKind::Name | TokenKind::Wheels | TokenKind::Sensors | TokenKind::Robots)
}

/// Returns whether the entity before `token` may be over after `previous`, so that a misspelt keyword may follow.
fn may_end(previous: Option<TokenKind>, token: TokenKind, inside: Option<EntityKind>) -> bool {
    let Some(previous) = previous else { return true };
    match previous {
        // `{ a b } wheels`
        TokenKind::CloseBrace => token == TokenKind::Name,
        TokenKind::String | TokenKind::UnterminatedString => true,
        _ if TokenKind::ENDS.has(previous) => true,
        // A port never ends a robot, and a list may lack its braces.
        _ if previous.is_number() => inside != Some(EntityKind::Robot),
        _ if previous.is_name() => {
            !matches!(inside, Some(EntityKind::Robot | EntityKind::Environment | EntityKind::Movement))
        }
        _ => false,
    }
}

/// The keyword of an entity that the first of these tokens is a slip for, where the next tokens are those of such an
/// entity.
pub(crate) fn misspelt_beginning(text: &str, tokens: &[Token]) -> Option<TokenKind> {
    let mut significant = tokens.iter().filter(|(token, _)| !token.is_comment());
    let &(first, span) = significant.next()?;
    if !could_be_misspelt(first) {
        return None;
    }
    let &(next, _) = significant.next()?;
    let after = significant.next();
    let follows = |keyword: &TokenKind| match *keyword {
        TokenKind::Import => is_string(next),
        TokenKind::Parallel => next == TokenKind::Movement,
        // A sensor may be over after its name.
        TokenKind::Sensor => {
            next.is_name()
                && after.is_none_or(|(after, _)| {
                    *after == TokenKind::Colon || *after == TokenKind::Name || could_begin(*after)
                })
        }
        keyword => next.is_name() && after.is_some_and(|after| is_one_of(text, *after, clauses(keyword))),
    };
    let written = span.text(text);
    TokenKind::closest(written, TokenKind::DECLARATIONS.into_iter().filter(follows))
}

/// Returns the tokens that can follow the name of an entity with such a keyword, also where a word is missing.
const fn clauses(keyword: TokenKind) -> TokenSet {
    const NUMBER: TokenSet =
        TokenSet::of(&[TokenKind::Integer, TokenKind::Float, TokenKind::Ipv4, TokenKind::MalformedNumber]);
    match keyword {
        TokenKind::Wheel | TokenKind::WheelH => {
            TokenSet::of(&[TokenKind::With, TokenKind::Radius]).or(NUMBER)
        }
        TokenKind::Ip => NUMBER,
        TokenKind::Robot => {
            TokenSet::of(&[TokenKind::With, TokenKind::Type, TokenKind::Port, TokenKind::Has])
        }
        TokenKind::Movement => TokenSet::of(&[TokenKind::Of, TokenKind::OpenBrace]),
        _ => TokenSet::of(&[TokenKind::With, TokenKind::Has, TokenKind::Comma]),
    }
}

/// Returns whether a token is one of `set`, or a word that is nearly one of its keywords.
fn is_one_of(text: &str, (token, span): Token, set: TokenSet) -> bool {
    let words =
        [TokenKind::With, TokenKind::Radius, TokenKind::Type, TokenKind::Port, TokenKind::Has, TokenKind::Of];
    set.has(token)
        || token == TokenKind::Name
            && words.into_iter().any(|word| set.has(word) && word.is_similar_to(span.text(text)))
}

fn begins_entity(
    token: TokenKind,
    previous: Option<TokenKind>,
    next: Option<TokenKind>,
    inside: Option<EntityKind>,
) -> bool {
    match token {
        TokenKind::Import => next.is_some_and(is_string) || previous.is_none_or(is_string),
        _ if is_taken_for_name(previous, next) => false,
        TokenKind::Ip => previous != Some(TokenKind::With),
        TokenKind::Movement | TokenKind::Parallel if previous == Some(TokenKind::Parallel) => false,
        // `with { parallel m }`: it is said where the movement is declared.
        TokenKind::Parallel if inside == Some(EntityKind::Environment) => !is_listed(previous, next),
        // `movement parallel m`; before `parallel movement` someone is about to write another one.
        TokenKind::Parallel if previous == Some(TokenKind::Movement) => next == Some(TokenKind::Movement),
        // `} wheel`, `with sensor {`, `} robot with` and `} movement` are slips for the plural, not entities.
        TokenKind::Wheel if inside == Some(EntityKind::Robot) => !closes_list(previous, next),
        TokenKind::Robot | TokenKind::Movement if inside == Some(EntityKind::Environment) => {
            !closes_list(previous, next)
        }
        TokenKind::Sensor if inside == Some(EntityKind::Robot) => previous != Some(TokenKind::With),
        _ => true,
    }
}

/// `wheel robot with …`, `movement m of robot { … }`: a keyword where only a name can be meant. (`wheel` right before
/// `robot r` is a wheel that someone is about to write.)
fn is_taken_for_name(previous: Option<TokenKind>, next: Option<TokenKind>) -> bool {
    let (Some(previous), Some(next)) = (previous, next) else { return false };
    match previous {
        TokenKind::Of => next == TokenKind::OpenBrace,
        TokenKind::Parallel => false,
        _ => {
            previous.entity_kind().is_some()
                && matches!(
                    next,
                    TokenKind::With | TokenKind::Of | TokenKind::Has | TokenKind::Colon | TokenKind::Ipv4
                )
        }
    }
}

fn is_listed(previous: Option<TokenKind>, next: Option<TokenKind>) -> bool {
    let in_list =
        |token: TokenKind| matches!(token, TokenKind::OpenBrace | TokenKind::Comma) || token.is_name();
    previous.is_some_and(in_list) && next.is_some_and(TokenKind::is_name)
}

fn is_string(token: TokenKind) -> bool {
    matches!(token, TokenKind::String | TokenKind::UnterminatedString)
}

fn closes_list(previous: Option<TokenKind>, next: Option<TokenKind>) -> bool {
    previous == Some(TokenKind::CloseBrace) && !next.is_some_and(TokenKind::is_name)
}
