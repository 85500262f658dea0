//! What was expected, in a person's terms.

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Expected, TokenKind};

use crate::diagnostics::context::Context;

pub(super) const MOVE: &str = "a move is written `move 4.0 meters` or `move 40 centimeters at 9.0`";
pub(super) const TURN: &str = "a turn is written `turn left 90` or `turn right until { SENSORS }`";
pub(super) const ACTIONS: &str = "an action is written `move 4.0 meters`, `move 40 centimeters at 9.0`, `turn left 90`, \
    `turn right until { SENSORS }` or `slam`";

/// The pattern to follow.
pub(super) fn shape(
    context: &Context<'_>,
    inside: Option<EntityKind>,
    expected: &[Expected],
) -> Option<String> {
    if let Some(Entity::Import(_)) = context.tree {
        return Some("an import is written `import \"wheels.pyr\"`".to_owned());
    }
    let wants = |asked: &[Expected]| expected.iter().any(|expected| asked.contains(expected));
    let word = Expected::Word;
    if wants(&[Expected::Action]) {
        return Some(ACTIONS.to_owned());
    }
    if wants(&[Expected::Distance, Expected::Speed, word(TokenKind::Meters), word(TokenKind::Centimeters)]) {
        return Some(MOVE.to_owned());
    }
    let turns = [Expected::Angle, Expected::ReferenceTo(EntityKind::Sensor)];
    let in_turn =
        wants(&[word(TokenKind::Left), word(TokenKind::Right), word(TokenKind::Until)]) || wants(&turns);
    if in_turn && inside == Some(EntityKind::Movement) {
        return Some(TURN.to_owned());
    }
    let kind = inside?;
    let shape = match kind {
        EntityKind::Sensor if wants(&[word(TokenKind::Distance), word(TokenKind::Bumper)]) => {
            "sensor NAME : bumper"
        }
        EntityKind::Robot
            if wants(&[word(TokenKind::Sensors), Expected::ReferenceTo(EntityKind::Sensor)]) =>
        {
            "robot NAME type tw with port 23000 has { WHEELS } wheels with sensors { SENSORS }"
        }
        EntityKind::Environment if wants(&[word(TokenKind::Ip), Expected::ReferenceTo(EntityKind::Ip)]) => {
            "environment NAME with ip ADDRESS has { ROBOTS } robots with { MOVEMENTS } moves"
        }
        _ => kind.shape(),
    };
    Some(format!("{} is written `{shape}`", kind.a_noun()))
}

/// What is worth saying of all that could stand in a place: where a name or a brace would do, not that a comma would
/// as well; where a movement's brace is open, not every word that could continue its last action; and nothing that
/// is optional where something must follow.
pub(super) fn telling(expected: &[Expected]) -> Vec<Expected> {
    let closes = expected.contains(&Expected::Word(TokenKind::CloseBrace));
    let lists = expected.iter().any(|expected| matches!(expected, Expected::ReferenceTo(_)));
    let names = expected.iter().any(|expected| matches!(expected, Expected::NameOf(_)));
    let ends = expected.contains(&Expected::Declaration);
    let has = expected.contains(&Expected::Word(TokenKind::Has));
    let with = expected.contains(&Expected::Word(TokenKind::With));
    let keep = |expected: &&Expected| match expected {
        Expected::Word(TokenKind::Comma) => !lists && !has,
        Expected::Word(TokenKind::Type) => !names && !with,
        Expected::Word(TokenKind::With | TokenKind::OpenBrace) if has => false,
        Expected::ReferenceTo(_)
        | Expected::Action
        | Expected::Angle
        | Expected::Word(TokenKind::At | TokenKind::Until) => !closes,
        Expected::Word(_) => !ends,
        _ => true,
    };
    let kept: Vec<Expected> = expected.iter().filter(keep).copied().collect();
    if kept.is_empty() { expected.to_vec() } else { kept }
}

pub(super) fn listed(expected: &[Expected]) -> String {
    let words: Vec<String> = expected.iter().map(|expected| phrase(*expected)).collect();
    match words.split_last() {
        None => "something else".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

fn phrase(expected: Expected) -> String {
    match expected {
        Expected::Word(word) => format!("`{}`", word.spelling().unwrap_or_default()),
        Expected::NameOf(kind) => format!("a name for the {}", kind.noun()),
        Expected::ReferenceTo(kind) => format!("the name of {}", kind.a_noun()),
        Expected::Radius => "a radius in centimetres".to_owned(),
        Expected::Port => "a port from 1 to 65535".to_owned(),
        Expected::Address => "an address such as `127.0.0.1`".to_owned(),
        Expected::Distance => "a distance".to_owned(),
        Expected::Speed => "a speed in centimetres per second".to_owned(),
        Expected::Angle => "an angle in degrees".to_owned(),
        Expected::Path => "a path in quotes".to_owned(),
        Expected::Action => "an action (`move`, `turn` or `slam`)".to_owned(),
        Expected::Declaration => "the next declaration".to_owned(),
    }
}
