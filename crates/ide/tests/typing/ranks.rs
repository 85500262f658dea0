//! The rank of the next word of a program in the completion list.

use pydslrep_ide::CompletionTrigger;
use pydslrep_syntax::{Span, Token, TokenKind, lex};

use crate::typed::Typed;

/// Counts over all positions where a keyword or name comes next.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Ranks {
    pub(crate) places: usize,
    /// The number of positions where it ranks first.
    pub(crate) first: usize,
}

impl Ranks {
    pub(crate) fn and(self, other: &Self) -> Self {
        Self { places: self.places + other.places, first: self.first + other.first }
    }
}

/// Requests completion at each keyword and each declared name: after a space if the list opens there, otherwise after the
/// first letter.
pub(crate) fn ranks(program: &str) -> Ranks {
    let mut ranks = Ranks::default();
    let mut typed = Typed::new(program);
    let tokens: Vec<Token> = lex(program).into_iter().filter(|(token, _)| !token.is_comment()).collect();
    for (index, (token, span)) in tokens.iter().enumerate() {
        let is_due = token.is_keyword() || (token.is_name() && is_known(program, &tokens, index));
        if is_due && let Some(words) = offered(program, &mut typed, *span) {
            ranks.places += 1;
            ranks.first += usize::from(words.first().is_some_and(|first| first == span.text(program)));
        }
    }
    ranks
}

/// Returns whether a name refers to an earlier declaration: later ones cannot be suggested.
fn is_known(program: &str, tokens: &[Token], index: usize) -> bool {
    let name = |index: usize| tokens[index].1.text(program);
    let is_declared = |other: usize| name(other) == name(index) && declares(&tokens[..other]);
    !declares(&tokens[..index]) && (0..index).any(is_declared)
}

/// Returns whether the next word is a new name.
fn declares(before: &[Token]) -> bool {
    let declaring = [
        TokenKind::Wheel,
        TokenKind::WheelH,
        TokenKind::Sensor,
        TokenKind::Ip,
        TokenKind::Robot,
        TokenKind::Movement,
        TokenKind::Environment,
    ];
    // `with ip lab` refers to one.
    let is_reference = matches!(before, [.., (TokenKind::With, _), (TokenKind::Ip, _)]);
    before.last().is_some_and(|(token, _)| declaring.contains(token)) && !is_reference
}

/// The distinct words that are offered when the list opens, best first; `None` if no list opens, as for words that are
/// almost complete after the first letter.
fn offered(program: &str, typed: &mut Typed, word: Span) -> Option<Vec<String>> {
    typed.type_to(word.start as usize);
    let blank = program[..typed.length()].chars().last();
    let by_blank = blank.map(|blank| words(typed, CompletionTrigger::Character(blank)));
    by_blank.filter(|words| !words.is_empty()).or_else(|| {
        let length = word.end - word.start;
        if length == 1 {
            return None;
        }
        typed.type_to(word.start as usize + 1);
        let words = words(typed, CompletionTrigger::Letter);
        (length > 4 || !words.is_empty()).then_some(words)
    })
}

/// The distinct first words of what is offered, best first.
fn words(typed: &Typed, trigger: CompletionTrigger) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for item in typed.offered(trigger) {
        let word = item.insert.split_whitespace().next().unwrap_or_default().to_owned();
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words
}
