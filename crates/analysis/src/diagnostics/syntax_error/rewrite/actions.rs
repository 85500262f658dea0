//! Movements: their actions and what is before them.

use pydslrep_syntax::{EntityKind, Span, Token, TokenKind};
use pydslrep_text::is_similar;

use super::statement::{Word, are_sound, rewrite, shape, words_of};
use crate::diagnostics::context::Context;
use crate::diagnostics::rewritten::Rewrite;
use crate::diagnostics::syntax_error::words;

/// Statements of a block after these are not rewritten.
const MAX_STATEMENTS: usize = 64;

pub(super) fn find(context: &Context<'_>) -> Vec<Rewrite> {
    let is_open = |(token, _): &Token| *token == TokenKind::OpenBrace;
    let Some(open) = context.tokens.iter().position(is_open) else { return Vec::new() };
    let (head, body) = (&context.tokens[..open], &context.tokens[open + 1..]);
    let mut found: Vec<(Rewrite, String)> = header(context, head).into_iter().collect();
    let mut follows = false;
    for statement in statements(context, body).iter().take(MAX_STATEMENTS) {
        let action = statement_as_action(context, statement, follows);
        follows = action.is_some() && !begins_action(statement);
        found.extend(action);
    }
    if found.is_empty() {
        return Vec::new();
    }
    let texts: Vec<&str> = found.iter().map(|(_, whole)| whole.as_str()).collect();
    let all_sound = are_sound(&texts);
    found.retain(|(_, whole)| all_sound || are_sound(&[whole.as_str()]));
    found.into_iter().map(|(rewrite, _)| rewrite).collect()
}

/// Returns the number of errors in a range.
fn errors_in(context: &Context<'_>, span: Span) -> usize {
    let inside =
        |error: &&pydslrep_syntax::SyntaxError| span.start <= error.span.start && error.span.end <= span.end;
    context.errors.iter().filter(inside).count()
}

fn span_of(words: &[Word]) -> Option<Span> {
    Some(words.first()?.span.to(words.last()?.span))
}

/// `movement patrol(rover) {`
fn header(context: &Context<'_>, tokens: &[Token]) -> Option<(Rewrite, String)> {
    let words = words_of(context, tokens)?;
    let errors = errors_in(context, span_of(&words)?);
    if errors == 0 {
        return None;
    }
    let is_parallel = words.iter().any(|word| word.token == TokenKind::Parallel || word.text == "parallel");
    let names: Vec<&Word> =
        words.get(1..)?.iter().filter(|word| word.token.is_name() && !joins(&word.text)).collect();
    let known = |word: &Word| {
        word.token.is_name()
            || word.is_noise()
            || matches!(
                word.token,
                TokenKind::Movement | TokenKind::Parallel | TokenKind::Of | TokenKind::With | TokenKind::Has
            )
    };
    let [name, robot] = names[..] else { return None };
    if !words.iter().all(known) {
        return None;
    }
    let text =
        format!("{}movement {} of {}", if is_parallel { "parallel " } else { "" }, name.text, robot.text);
    let whole = format!("{text} {{ }}");
    let rewrite = rewrite(&words, text, shape(context, EntityKind::Movement), errors < 2)?;
    Some((rewrite, whole))
}

/// Words that people put between a movement and its robot.
fn joins(word: &str) -> bool {
    ["for", "by", "from", "using", "on", "off", "fo", "robot"].contains(&word)
}

/// The tokens of a movement's body by statements: one on each line, or more where one ends or the next begins.
fn statements<'a>(context: &Context<'_>, body: &'a [Token]) -> Vec<&'a [Token]> {
    let (mut starts, mut depth, mut previous): (Vec<usize>, usize, Option<Token>) = (vec![0], 0, None);
    for (index, &(token, span)) in body.iter().enumerate() {
        let gap = previous.map(|(_, before)| context.text(Span::new(before.end, span.start)));
        let is_new_line = gap.is_some_and(|gap| gap.contains(['\n', '\r']));
        let is_over = previous.is_some_and(|(token, span)| {
            token == TokenKind::Invalid && context.text(span).contains(';') || token == TokenKind::CloseBrace
        });
        let is_action = token.is_action() && depth == 0;
        if index > 0 && (is_new_line || is_over || is_action || token == TokenKind::CloseBrace) {
            starts.push(index);
        }
        if token == TokenKind::Invalid {
            let text = context.text(span);
            let count = |bracket: char| text.matches(bracket).count();
            depth = (depth + count('(')).saturating_sub(count(')'));
        }
        if is_new_line {
            depth = 0;
        }
        previous = Some((token, span));
    }
    starts.push(body.len());
    starts.windows(2).map(|pair| &body[pair[0]..pair[1]]).filter(|part| !part.is_empty()).collect()
}

/// Returns whether the parser takes a statement for an action; otherwise it skipped the rest of the statement.
fn begins_action(statement: &[Token]) -> bool {
    let first = statement.iter().find(|(token, _)| !token.is_comment());
    first.is_some_and(|(token, _)| token.is_action())
}

/// A statement as an action with a movement around it; `follows` where the one before begins with no action.
fn statement_as_action(
    context: &Context<'_>,
    statement: &[Token],
    follows: bool,
) -> Option<(Rewrite, String)> {
    let is_word = |(token, _): &&Token| !token.is_comment();
    let (_, start) = statement.iter().find(is_word)?;
    let (_, end) = statement.iter().rfind(is_word)?;
    let errors = errors_in(context, start.to(*end));
    let passed_over = follows && !begins_action(statement);
    if errors == 0 && !passed_over {
        return None;
    }
    let words = words_of(context, statement)?;
    let first = words.first()?;
    let (text, help) = action(&words)?;
    let is_call = words.iter().any(|word| word.token == TokenKind::Invalid && word.text.contains('('))
        || first.token == TokenKind::MalformedName;
    let is_only_begun = errors < 2 && !is_call && !passed_over;
    let is_fallback = is_only_begun && (begins_action(statement) || is_one_word_away(&words, &text));
    let whole = format!("movement m of r {{ {text} }}");
    let is_other_word = !text.split(' ').next().is_some_and(|verb| is_nearly(&first.text, verb));
    let message = format!("there is no action `{}`; did you mean `{text}`?", first.text);
    let rewrite = rewrite(&words, text, help, is_fallback)?;
    Some((if is_other_word { Rewrite { message, ..rewrite } } else { rewrite }, whole))
}

fn is_nearly(written: &str, verb: &str) -> bool {
    written == verb || is_similar(written, verb)
}

/// Returns whether another first word is all that it takes.
fn is_one_word_away(words: &[Word], text: &str) -> bool {
    let rest = words.iter().skip(1).map(|word| word.text.as_str());
    rest.eq(text.split(' ').skip(1))
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Verb {
    Move { backwards: bool },
    Turn { direction: Option<&'static str> },
    Slam,
}

/// Returns the verb that a word stands for: `move`, `drive`, `rover.turn_left`.
fn verb(written: &str) -> Option<Verb> {
    let word = written.rsplit('.').next()?.to_lowercase().replace('_', "");
    let ways = ["", "move", "go", "drive", "walk", "run"];
    let is_any = |ends: &[&str]| ways.iter().any(|way| ends.iter().any(|end| word == format!("{way}{end}")));
    Some(match word.as_str() {
        "move" | "go" | "drive" | "walk" | "run" | "advance" | "fd" => Verb::Move { backwards: false },
        _ if is_any(&["forward", "forwards", "ahead", "straight"]) => Verb::Move { backwards: false },
        "reverse" | "bk" => Verb::Move { backwards: true },
        _ if is_any(&["back", "backward", "backwards"]) => Verb::Move { backwards: true },
        "turn" | "rotate" | "spin" => Verb::Turn { direction: None },
        "left" | "turnleft" | "rotateleft" | "spinleft" | "lt" => Verb::Turn { direction: Some("left") },
        "right" | "turnright" | "rotateright" | "spinright" | "rt" => Verb::Turn { direction: Some("right") },
        "slam" => Verb::Slam,
        _ => return None,
    })
}

/// The numbers and words of a statement after its verb.
#[derive(Debug, Default)]
struct Arguments<'a> {
    numbers: Vec<&'a str>,
    speed: Option<&'a str>,
    unit: Option<&'static str>,
    direction: Option<&'static str>,
    backwards: bool,
}

fn arguments(words: &[Word]) -> Option<Arguments<'_>> {
    let mut arguments = Arguments::default();
    let mut speed_follows = false;
    for word in words {
        if word.is_number() {
            if !speed_follows {
                arguments.numbers.push(&word.text);
            } else if arguments.speed.replace(&word.text).is_some() {
                return None;
            }
            speed_follows = false;
            continue;
        }
        match word.text.to_lowercase().as_str() {
            "at" | "speed" | "velocity" => speed_follows = true,
            "m" | "meter" | "meters" | "metre" | "metres" if arguments.speed.is_none() => {
                arguments.unit = Some("meters");
            }
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => {
                arguments.unit = arguments.unit.or(arguments.speed.is_none().then_some("centimeters"));
            }
            "left" => arguments.direction = Some("left"),
            "right" => arguments.direction = Some("right"),
            "back" | "backward" | "backwards" => arguments.backwards = true,
            "forward" | "forwards" | "ahead" | "straight" | "degrees" | "degree" | "deg" | "°" | "by"
            | "for" | "to" | "the" | "a" | "distance" | "angle" | "direction" | "unit" | "of" => {}
            "/" | "s" if arguments.speed.is_some() => {}
            _ if word.is_noise() => {}
            _ => return None,
        }
    }
    Some(arguments)
}

/// Returns the action that a statement stands for, and a sentence that shows the syntax of such actions.
fn action(words: &[Word]) -> Option<(String, String)> {
    let (first, rest) = words.split_first()?;
    let verb = verb(&first.text)?;
    let arguments = arguments(rest)?;
    match verb {
        Verb::Move { backwards } => {
            let [distance] = arguments.numbers[..] else { return None };
            let backwards = backwards || arguments.backwards;
            if arguments.direction.is_some() || backwards && distance.starts_with('-') {
                return None;
            }
            let sign = if backwards { "-" } else { "" };
            let speed = arguments.speed.map_or(String::new(), |speed| format!(" at {speed}"));
            let unit = arguments.unit.unwrap_or("meters");
            Some((format!("move {sign}{distance} {unit}{speed}"), words::action(TokenKind::Move)))
        }
        Verb::Turn { direction } => {
            let direction = direction.or(arguments.direction)?;
            if arguments.unit.is_some()
                || arguments.speed.is_some()
                || arguments.backwards
                || arguments.numbers.len() > 1
            {
                return None;
            }
            let angle = arguments.numbers.first().map_or(String::new(), |angle| format!(" {angle}"));
            Some((format!("turn {direction}{angle}"), words::action(TokenKind::Turn)))
        }
        Verb::Slam => {
            let is_plain =
                arguments.numbers.is_empty() && arguments.unit.is_none() && arguments.direction.is_none();
            (is_plain && arguments.speed.is_none()).then(|| ("slam".to_owned(), words::actions()))
        }
    }
}
