//! The rank of the next word of a program in the completion list.

use pydslrep_analysis::Database;
use pydslrep_ide::{CompletionTrigger, FilePosition, completions};
use pydslrep_syntax::{Span, Token, TokenKind, lex};

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
    let tokens: Vec<Token> = lex(program).into_iter().filter(|(token, _)| !token.is_comment()).collect();
    for (index, (token, span)) in tokens.iter().enumerate() {
        let is_due = token.is_keyword() || (token.is_name() && is_known(program, &tokens, index));
        if is_due && let Some(words) = offered(program, *span) {
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
fn offered(program: &str, word: Span) -> Option<Vec<String>> {
    let blank = program[..word.start as usize].chars().last();
    let by_blank = blank.map(|blank| asked(program, word.start, CompletionTrigger::Character(blank)));
    by_blank.filter(|words| !words.is_empty()).or_else(|| {
        let length = word.end - word.start;
        let words = (length > 1).then(|| asked(program, word.start + 1, CompletionTrigger::Letter));
        words.filter(|words| length > 4 || !words.is_empty())
    })
}

/// The words that are offered after the typed part of the program.
fn asked(program: &str, offset: u32, trigger: CompletionTrigger) -> Vec<String> {
    let mut database = Database::new();
    let file = database.open("a.pyr", &program[..offset as usize]);
    let items = completions(&database, FilePosition { file, offset }, trigger, 9.0);
    let mut words: Vec<String> = Vec::new();
    for item in items {
        let word = item.insert.split_whitespace().next().unwrap_or_default().to_owned();
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words
}
