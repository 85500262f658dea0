//! What of all that fits is offered: nothing that would get in the way of typing.

use pydslrep_schema::{Place, Slot};
use pydslrep_syntax::Span;

use super::{Completion, CompletionTrigger};

/// So few letters are typed faster than a list is read. Without this, a list would still be open when Enter ends the line
/// right after the word, for as long as the editor waits for the answer to the last letter.
const FEW_LETTERS: usize = 3;

/// The word at the cursor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Word<'a> {
    /// Its part before the cursor.
    pub(crate) before: &'a str,
    /// Its part after the cursor.
    pub(crate) after: &'a str,
    /// Whether nothing follows it on its line but what editors close by themselves, so that Enter may come next.
    pub(crate) ends_line: bool,
}

impl Word<'_> {
    /// Whether a text is there already, or so nearly that the rest is typed faster.
    fn is_nearly(&self, text: &str) -> bool {
        let is_short = text.len() <= self.before.len() + FEW_LETTERS;
        self.ends_line && self.after.is_empty() && is_short && starts_with(text, &self.before.to_lowercase())
    }
}

/// Whether what follows a word on its line is only what editors close by themselves.
pub(crate) fn ends_line(following: impl Iterator<Item = char>) -> bool {
    let mut line = following.take_while(|character| !matches!(character, '\r' | '\n'));
    line.all(|character| " \t}]\"'".contains(character))
}

/// Of what fits, that which the typed beginning of the word can become. Where Enter may end the line, nothing is offered
/// of a word that is complete, and no word of which few letters are missing.
pub(crate) fn narrowed(items: Vec<Completion>, word: Word<'_>) -> Vec<Completion> {
    if word.before.is_empty() && word.after.is_empty() {
        return items;
    }
    if word.ends_line && word.after.is_empty() && items.iter().any(|item| item.plain() == word.before) {
        return Vec::new();
    }
    let typed = bare(word.before).to_lowercase();
    let mut found: Vec<(bool, Completion)> = items
        .into_iter()
        .filter(|item| !word.is_nearly(&item.plain()))
        .filter_map(|item| Some((!fit(&item, &typed)?, item)))
        .collect();
    found.sort_by_key(|(is_inside, item)| (*is_inside, item.rank));
    found.into_iter().map(|(_, item)| item).collect()
}

/// Whether the typed letters, in small letters, begin what is offered (true) or one of the words inside it (false).
fn fit(item: &Completion, typed: &str) -> Option<bool> {
    let label = bare(&item.label);
    if starts_with(label, typed) {
        return Some(true);
    }
    if label.starts_with(['{', '}']) {
        // Whoever types a letter in a list means a name.
        return None;
    }
    humps(label).any(|word| has_letters(word, typed)).then_some(false)
}

/// Without what marks a text or an escaped name.
fn bare(text: &str) -> &str {
    text.trim_start_matches(['^', '"', '\''])
}

pub(super) fn starts_with(text: &str, typed: &str) -> bool {
    text.get(..typed.len()).is_some_and(|start| start.to_lowercase() == typed)
}

/// The words that a name consists of, each with all that follows it: `wheelLeft` has `wheelLeft` and `Left`.
fn humps(name: &str) -> impl Iterator<Item = &str> {
    let mut previous = '_';
    name.char_indices().filter_map(move |(at, character)| {
        let is_start = character.is_alphanumeric()
            && (!previous.is_alphanumeric()
                || (previous.is_lowercase() && character.is_uppercase())
                || (previous.is_alphabetic() && character.is_ascii_digit()));
        previous = character;
        is_start.then(|| &name[at..])
    })
}

/// Whether a word begins with the first letter and has the others in this order, small or capital.
fn has_letters(word: &str, typed: &str) -> bool {
    let mut wanted = typed.chars();
    let mut letters = word.chars().flat_map(char::to_lowercase);
    wanted.next().is_none_or(|first| letters.next() == Some(first))
        && wanted.all(|wanted| letters.any(|letter| letter == wanted))
}

/// The same in a TOML file, all of whose completions at a place replace the same word.
pub(crate) fn narrowed_in_toml(items: Vec<Completion>, text: &str, offset: u32) -> Vec<Completion> {
    let Some(word) = items.first().map(|item| item.replace) else { return items };
    let cut = offset.clamp(word.start, word.end);
    let following = text.get(word.end as usize..).unwrap_or_default();
    let word = Word {
        before: Span::new(word.start, cut).text(text),
        after: Span::new(cut, word.end).text(text),
        ends_line: ends_line(following.chars()),
    };
    narrowed(items, word)
}

impl CompletionTrigger {
    /// Whether the list opens at this place of a TOML file: by itself where a value must come, and in a table's brackets.
    pub(crate) fn opens_in_toml(self, place: &Place) -> bool {
        match self {
            Self::Invoked => true,
            Self::Character('[') => matches!(place.slot, Slot::Table { .. }),
            Self::Character(' ' | '"') => matches!(place.slot, Slot::Value { .. }),
            Self::Character(_) => false,
        }
    }
}
