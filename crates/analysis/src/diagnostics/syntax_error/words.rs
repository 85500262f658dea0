//! Sentences and phrases for messages: what is expected at a place, and how a statement is written.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Expected, Quantity, Span, TokenKind};

use crate::diagnostics::context::Context;

/// Returns a sentence that shows the syntax of all actions.
pub(super) fn actions() -> String {
    format!(
        "an action is written {}",
        quoted(TokenKind::ACTIONS.iter().filter_map(|action| action.examples().first()))
    )
}

/// Returns a sentence that shows the syntax of the action that a keyword begins.
pub(super) fn action(keyword: TokenKind) -> String {
    format!("a {} is written {}", keyword.spelling().unwrap_or_default(), quoted(keyword.examples()))
}

const CONDITION: &str = "a condition is written `{ SENSORS } clear` or `{ SENSORS } detect`";

/// Returns a sentence about the braces that are missing after a keyword of an action, and their content.
pub(super) fn missing_braces(before: TokenKind, expected: &[Expected]) -> Option<&'static str> {
    let is_brace = expected == [Expected::Word(TokenKind::OpenBrace)];
    if !is_brace && expected != [Expected::ReferenceTo(EntityKind::Sensor)] {
        return None;
    }
    match before {
        TokenKind::Until | TokenKind::If => Some(CONDITION),
        TokenKind::Times
        | TokenKind::Clear
        | TokenKind::Detect
        | TokenKind::Meters
        | TokenKind::Centimeters
        | TokenKind::Else => Some("its actions follow between braces: `{ ACTIONS }`"),
        _ => None,
    }
}

/// Returns a sentence that shows the syntax of the action whose number, or whose word after that, is expected at a place:
/// several actions may have the same word there.
pub(super) fn amount(context: &Context<'_>, at: Span, expected: &[Expected]) -> Option<String> {
    let before =
        context.tokens.iter().rev().filter(|(token, span)| !token.is_comment() && span.end <= at.start);
    let mut before = before.skip_while(|(token, _)| token.is_number());
    let (token, span) = before.next()?;
    let is_keyword =
        |action: &TokenKind| action == token || token.is_name() && action.is_similar_to(context.text(*span));
    let is_amount = |expected: &Expected| match expected {
        Expected::Number(_) => true,
        Expected::Word(word) => word.is_name(),
        _ => false,
    };
    let here = TokenKind::ACTIONS.into_iter().find(is_keyword).filter(|_| expected.iter().any(is_amount));
    let any = || {
        TokenKind::ACTIONS.into_iter().find(|action| expected.iter().any(|word| counts_in(*action, *word)))
    };
    here.or_else(any).map(action)
}

/// Returns whether what is expected is the word after the number of an action, as `seconds` is in `wait 2 seconds`.
fn counts_in(action: TokenKind, expected: Expected) -> bool {
    let Expected::Word(word) = expected else { return false };
    let follows = |example: &&str| {
        let mut words = example.split(' ').skip_while(|word| !word.starts_with(|c: char| c.is_ascii_digit()));
        words.nth(1) == word.spelling()
    };
    word.is_name() && action.examples().iter().any(follows)
}

/// Returns a sentence that shows the syntax of the statement or declaration in which the text is expected.
pub(super) fn shape(
    context: &Context<'_>,
    inside: Option<EntityKind>,
    expected: &[Expected],
) -> Option<String> {
    if let Some(Entity::Import(_)) = context.tree {
        return Some("an import is written `import \"wheels.pyr\"`".to_owned());
    }
    let expects_any = |of: &[Expected]| expected.iter().any(|expected| of.contains(expected));
    let word = Expected::Word;
    if expects_any(&[Expected::Action]) {
        return Some(actions());
    }
    let number = Expected::Number;
    let moves = [number(Quantity::Distance), number(Quantity::Speed)];
    if expects_any(&moves) || expects_any(&[word(TokenKind::Meters), word(TokenKind::Centimeters)]) {
        return Some(action(TokenKind::Move));
    }
    let turns = [number(Quantity::Angle), Expected::ReferenceTo(EntityKind::Sensor)];
    if expected == [word(TokenKind::Until)] {
        return Some(action(TokenKind::Move));
    }
    if expects_any(&[word(TokenKind::Clear), word(TokenKind::Detect)]) {
        return Some(CONDITION.to_owned());
    }
    let in_turn = expects_any(&[word(TokenKind::Left), word(TokenKind::Right), word(TokenKind::Until)])
        || expects_any(&turns);
    if in_turn && inside == Some(EntityKind::Movement) {
        return Some(action(TokenKind::Turn));
    }
    let kind = inside?;
    let shape = match kind {
        EntityKind::Sensor if expects_any(&[word(TokenKind::Distance), word(TokenKind::Bumper)]) => {
            "sensor NAME : bumper"
        }
        EntityKind::Robot
            if expects_any(&[word(TokenKind::Sensors), Expected::ReferenceTo(EntityKind::Sensor)]) =>
        {
            "robot NAME type tw with port 23000 has { WHEELS } wheels with sensors { SENSORS }"
        }
        EntityKind::Environment
            if expects_any(&[word(TokenKind::Ip), Expected::ReferenceTo(EntityKind::Ip)]) =>
        {
            "environment NAME with ip ADDRESS has { ROBOTS } robots with { MOVEMENTS } moves"
        }
        _ => kind.shape(),
    };
    Some(format!("{} is written `{shape}`", kind.a_noun()))
}

/// Removes from the expected text what a message need not list, unless nothing would be left:
///
/// * a comma where a name or `has` may follow,
/// * where a closing brace may follow, whatever could continue the list or the action before it,
/// * optional clauses where a mandatory one may follow,
/// * keywords where the declaration may end.
pub(super) fn worth_listing(expected: &[Expected]) -> Vec<Expected> {
    let may_close = expected.contains(&Expected::Word(TokenKind::CloseBrace));
    let may_reference = expected.iter().any(|expected| matches!(expected, Expected::ReferenceTo(_)));
    let may_name = expected.iter().any(|expected| matches!(expected, Expected::NameOf(_)));
    let may_end = expected.contains(&Expected::Declaration);
    let has = expected.contains(&Expected::Word(TokenKind::Has));
    let with = expected.contains(&Expected::Word(TokenKind::With));
    let may_be_distance = expected.contains(&Expected::Number(Quantity::Distance));
    let keep = |expected: &&Expected| match expected {
        Expected::Word(TokenKind::Comma) => !may_reference && !has,
        Expected::Word(TokenKind::Type) => !may_name && !with,
        Expected::Word(TokenKind::With | TokenKind::OpenBrace) if has => false,
        Expected::Word(TokenKind::At | TokenKind::Until) if may_be_distance => false,
        Expected::ReferenceTo(_)
        | Expected::Action
        | Expected::Number(Quantity::Angle)
        | Expected::Word(
            TokenKind::At
            | TokenKind::Until
            | TokenKind::In
            | TokenKind::Clear
            | TokenKind::Detect
            | TokenKind::Within,
        ) => !may_close,
        Expected::Word(TokenKind::With) if may_close => false,
        Expected::Word(_) => !may_end,
        _ => true,
    };
    let kept: Vec<Expected> = expected.iter().filter(keep).copied().collect();
    if kept.is_empty() { expected.to_vec() } else { kept }
}

/// Returns the phrases for all that is expected: `a`, `b` or `c`.
pub(super) fn listed(expected: &[Expected]) -> String {
    match expected {
        [] => "something else".to_owned(),
        _ => any_of(expected.iter().map(|expected| phrase(*expected))),
    }
}

/// Returns the texts in backticks, joined by commas and "or".
fn quoted<'a>(texts: impl IntoIterator<Item = &'a &'a str>) -> String {
    any_of(texts.into_iter().map(|text| format!("`{text}`")))
}

fn any_of(texts: impl Iterator<Item = String>) -> String {
    let texts: Vec<String> = texts.collect();
    match texts.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

fn phrase(expected: Expected) -> String {
    match expected {
        Expected::Word(word) => format!("`{}`", word.spelling().unwrap_or_default()),
        Expected::NameOf(kind) => format!("a name for the {}", kind.noun()),
        Expected::ReferenceTo(kind) => format!("the name of {}", kind.a_noun()),
        Expected::Number(quantity) => quantity.phrase().to_owned(),
        Expected::Port => "a port from 1 to 65535".to_owned(),
        Expected::Address => "an address such as `127.0.0.1`".to_owned(),
        Expected::Path => "a path in quotes".to_owned(),
        Expected::Action => {
            format!(
                "an action ({})",
                any_of(TokenKind::ACTIONS.into_iter().map(|action| phrase(Expected::Word(action))))
            )
        }
        Expected::Declaration => "the next declaration".to_owned(),
    }
}
