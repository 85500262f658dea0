//! Finding fixes: what could fix an entity is tried, and offered where it does.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{Earlier, Expected, Span, TokenKind, TokenSet, parse_again};

use crate::diagnostics::context::Context;
use crate::diagnostics::edits::ProblemEdit;
use crate::diagnostics::problem::Problem;

/// Trying costs as much as reading the entity again, so it ends where an entity is a mess or very long.
const MAX_ERRORS: usize = 4;
pub(super) const MAX_LENGTH: u32 = 16 * 1024;

/// Returns whether the entity has fewer errors after the edits, and is still one entity.
pub(super) fn is_fixed(context: &Context<'_>, edits: &[ProblemEdit]) -> bool {
    entities_if_fixed(context, edits) == Some(1)
}

/// The same, where the edits may also begin another entity.
pub(super) fn is_split(context: &Context<'_>, edits: &[ProblemEdit]) -> bool {
    entities_if_fixed(context, edits).is_some()
}

/// Returns whether nothing is wrong after the edits, which may also begin another entity.
pub(super) fn has_no_errors(context: &Context<'_>, edits: &[ProblemEdit]) -> bool {
    entities_and_errors(context, edits).is_some_and(|(_, errors)| errors == 0)
}

fn entities_if_fixed(context: &Context<'_>, edits: &[ProblemEdit]) -> Option<usize> {
    let (entities, errors) = entities_and_errors(context, edits)?;
    (errors < context.errors.len()).then_some(entities)
}

/// Returns the number of entities and of errors after the edits; `None` where there is too much to try that.
fn entities_and_errors(context: &Context<'_>, edits: &[ProblemEdit]) -> Option<(usize, usize)> {
    let end = context.tokens.last()?.1.end;
    if context.errors.len() > MAX_ERRORS || end > MAX_LENGTH {
        return None;
    }
    let edited = edits.iter().map(|edit| edit.span).reduce(Span::to)?;
    let mut text = context.text(Span::new(0, end)).to_owned();
    let mut edits: Vec<&ProblemEdit> = edits.iter().collect();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
    for edit in edits {
        let range = std::ops::Range::from(edit.span);
        text.get(range.clone())?;
        text.replace_range(range, &edit.text);
    }
    let now = Span::of(&text);
    let growth = i64::from(now.len()) - i64::from(end);
    let pieces = parse_again(&text, Some(Earlier { parse: context.parse, now, edited, growth }));
    let errors = pieces.iter().map(|(_, parse)| parse.errors.len()).sum();
    Some((pieces.len(), errors))
}

/// Offers to insert what is missing at `span`, where exactly one thing fixes it.
pub(super) fn insert(context: &Context<'_>, problem: Problem, span: Span, expected: &[Expected]) -> Problem {
    /// Words that are often forgotten together.
    const TOGETHER: [&str; 4] = ["with radius", "} wheels", "} robots", "} moves"];
    let before = token_before(context, span);
    let words = expected.iter().filter_map(|expected| match expected {
        // A list with nothing in it is no better than one that does not end.
        Expected::Word(TokenKind::CloseBrace) if before == Some(TokenKind::OpenBrace) => None,
        Expected::Word(word) => word.spelling(),
        _ => None,
    });
    let words: Vec<&str> = words.collect();
    let edit = |text: &str| match text {
        "}" => closing(context, span),
        text => context.replace(span, format!(" {text}")),
    };
    let fixing: Vec<&str> = words.iter().copied().filter(|text| is_fixed(context, &[edit(text)])).collect();
    let text = match fixing[..] {
        [only] => Some(only),
        [] => TOGETHER
            .into_iter()
            .filter(|text| words.iter().any(|word| text.split(' ').next() == Some(*word)))
            .find(|text| is_fixed(context, &[edit(text)])),
        _ => None,
    };
    match (text, &fixing[..]) {
        (Some(text), _) => problem.fix(format!("insert `{text}`"), [edit(text)]),
        // `meters` or `centimeters`, `left` or `right`
        (None, choices @ [_, _]) => choices
            .iter()
            .fold(problem, |problem, text| problem.suggestion(format!("insert `{text}`"), [edit(text)])),
        (None, _) => problem,
    }
}

/// The edit that closes what is open. A brace that closes a movement gets a line of its own where the movement has
/// several.
pub(super) fn closing(context: &Context<'_>, place: Span) -> ProblemEdit {
    let has_lines = is_body(context, place) && context.text(Span::new(0, place.start)).contains(['\n', '\r']);
    context.replace(place, if has_lines { "\n}" } else { " }" })
}

/// Returns whether a brace at this place is one of a movement's own.
pub(super) fn is_body(context: &Context<'_>, place: Span) -> bool {
    let before =
        context.tokens.iter().rev().filter(|(token, span)| !token.is_comment() && span.end <= place.start);
    let opened = before
        .map(|(token, _)| *token)
        .find(|token| *token == TokenKind::OpenBrace || CONDITIONS.has(*token));
    let list = opened.is_some_and(|token| CONDITIONS.has(token)) || is_in_condition(context, place);
    matches!(context.tree, Some(Entity::Movement(_))) && !list
}

/// The keywords before the list of a condition.
const CONDITIONS: TokenSet = TokenSet::of(&[TokenKind::Until, TokenKind::If]);

fn is_in_condition(context: &Context<'_>, place: Span) -> bool {
    let mut depth = Vec::new();
    let mut previous = None;
    for (token, span) in context.tokens.iter().filter(|(token, _)| !token.is_comment()) {
        if span.start >= place.start {
            break;
        }
        match token {
            TokenKind::OpenBrace => depth.push(previous.is_some_and(|token| CONDITIONS.has(token))),
            TokenKind::CloseBrace => {
                depth.pop();
            }
            _ => {}
        }
        previous = Some(*token);
    }
    depth.last() == Some(&true)
}

fn token_before(context: &Context<'_>, span: Span) -> Option<TokenKind> {
    let before =
        context.tokens.iter().rev().find(|(token, other)| !token.is_comment() && other.end <= span.start);
    before.map(|(token, _)| *token)
}

/// Returns whether the text at `span` repeats the text right before it, and once is enough.
pub(super) fn is_doubled(context: &Context<'_>, span: Span) -> bool {
    let before =
        context.tokens.iter().rev().find(|(token, other)| !token.is_comment() && other.end <= span.start);
    let same = before.is_some_and(|(_, before)| context.text(*before) == context.text(span));
    same && is_fixed(context, &[context.remove(span)])
}

/// Offers what fixes a token that does not fit: a word before it, another one in its place, or nothing.
pub(super) fn repair(
    context: &Context<'_>,
    problem: Problem,
    span: Span,
    found: &str,
    expected: &[Expected],
) -> Problem {
    let words: Vec<&str> = expected
        .iter()
        .filter_map(|expected| match expected {
            Expected::Word(TokenKind::Comma) => None,
            Expected::Word(word) => word.spelling(),
            _ => None,
        })
        .collect();
    let only = |edit: &dyn Fn(&str) -> ProblemEdit| {
        let fixing: Vec<&str> =
            words.iter().copied().filter(|word| is_fixed(context, &[edit(word)])).collect();
        match fixing[..] {
            [word] => Some(word.to_owned()),
            _ => None,
        }
    };
    let before = |word: &str| context.replace(Span::at(span.start), format!("{word} "));
    if let Some(word) = only(&before) {
        let problem = Problem { message: format!("missing `{word}` before `{found}`"), ..problem };
        return problem.fix(format!("insert `{word}`"), [before(&word)]);
    }
    let instead = |word: &str| context.replace(span, word);
    if let Some(word) = only(&instead).filter(|_| found.starts_with(char::is_alphabetic)) {
        return problem.suggestion(format!("change to `{word}`"), [instead(&word)]);
    }
    if let Some(close) = braces(context, span, found) {
        let both = [context.remove(span), context.remove(close)];
        if is_fixed(context, &both) {
            return problem.fix("remove `{` and `}`", both);
        }
    }
    let names = expected.iter().any(|expected| matches!(expected, Expected::NameOf(_)));
    let glued = context.tokens.iter().any(|(_, other)| other.end == span.start || other.start == span.end);
    let alone = context.tokens.len() == 1;
    if names && !found.starts_with(char::is_alphabetic) || glued || alone {
        return problem;
    }
    let nothing = context.remove_word(span);
    if is_fixed(context, std::slice::from_ref(&nothing)) {
        return problem.suggestion(format!("remove `{found}`"), [nothing]);
    }
    problem
}

/// Where a brace too many is closed.
fn braces(context: &Context<'_>, span: Span, found: &str) -> Option<Span> {
    let following = context.tokens.iter().filter(|(_, other)| other.start >= span.end);
    let mut close = following.filter(|(token, _)| *token == TokenKind::CloseBrace).map(|(_, span)| *span);
    close.next().filter(|_| found == "{")
}
