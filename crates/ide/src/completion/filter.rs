//! Filters completion items by the typed word, so that the list never gets in the way of typing.

use pydslrep_schema::{CursorContext, Slot};
use pydslrep_syntax::Span;

use super::{Completion, CompletionKind, CompletionTrigger};

/// A list that opens automatically has no items that save fewer letters than this or as many. Otherwise it would still be
/// open when the user presses a key right after the word, until the response to the last letter arrives.
const MIN_SAVED_LETTERS: usize = 3;

/// The word at the cursor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Word<'a> {
    /// The part before the cursor.
    pub(crate) before: &'a str,
    /// The part after the cursor.
    pub(crate) after: &'a str,
    /// Whether only auto-closed characters follow it on its line, so that Enter may come next.
    pub(crate) ends_line: bool,
}

impl Word<'_> {
    /// Whether a text is complete but for a few letters.
    fn almost_completes(&self, text: &str) -> bool {
        let is_short = text.len() <= self.before.len() + MIN_SAVED_LETTERS;
        self.ends_line && self.after.is_empty() && is_short && starts_with(text, &self.before.to_lowercase())
    }
}

/// Whether only characters that editors close automatically follow on the line.
pub(crate) fn ends_line(following: impl Iterator<Item = char>) -> bool {
    let mut line = following.take_while(|character| !matches!(character, '\r' | '\n'));
    line.all(|character| " \t}]\"'".contains(character))
}

/// The items that match the typed part of the word, the word itself first. No list opens automatically at a complete
/// word; where Enter may end the line, it has no items that are almost complete.
pub(crate) fn filter(items: Vec<Completion>, word: Word<'_>, trigger: CompletionTrigger) -> Vec<Completion> {
    if word.before.is_empty() && word.after.is_empty() {
        return items;
    }
    let is_automatic = trigger != CompletionTrigger::Invoked;
    let is_whole = |item: &Completion| word.after.is_empty() && item.plain() == word.before;
    if is_automatic && items.iter().any(is_whole) {
        return Vec::new();
    }
    let typed = bare(word.before).to_lowercase();
    let mut found: Vec<(bool, Completion)> = items
        .into_iter()
        .filter(|item| !is_automatic || !word.almost_completes(&item.plain()))
        .filter_map(|item| Some((!fit(&item, &typed)?, item)))
        .collect();
    found.sort_by_key(|(is_inside, item)| (!is_whole(item), *is_inside, item.rank));
    found.into_iter().map(|(_, item)| item).collect()
}

/// Whether the typed letters, in lower case, begin the label (`true`) or fit one of its subwords (`false`).
fn fit(item: &Completion, typed: &str) -> Option<bool> {
    let label = bare(&item.label);
    if starts_with(label, typed) {
        return Some(true);
    }
    if matches!(item.kind, CompletionKind::Keyword | CompletionKind::Snippet) {
        // Whoever types a clause or a statement begins with its first word; other letters begin a name or another statement.
        return None;
    }
    subwords(label).any(|word| has_letters(word, typed)).then_some(false)
}

/// A label without its quote or escape.
fn bare(text: &str) -> &str {
    text.trim_start_matches(['^', '"', '\''])
}

pub(super) fn starts_with(text: &str, typed: &str) -> bool {
    text.get(..typed.len()).is_some_and(|start| start.to_lowercase() == typed)
}

/// The words of a name, each with all that follows it: `wheelLeft` has `wheelLeft` and `Left`.
fn subwords(name: &str) -> impl Iterator<Item = &str> {
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

/// Whether a word begins with the first typed letter and contains the others in this order, ignoring case.
fn has_letters(word: &str, typed: &str) -> bool {
    let mut wanted = typed.chars();
    let mut letters = word.chars().flat_map(char::to_lowercase);
    wanted.next().is_none_or(|first| letters.next() == Some(first))
        && wanted.all(|wanted| letters.any(|letter| letter == wanted))
}

/// The same for a TOML file; all items at a position replace the same word.
pub(crate) fn filter_in_toml(
    items: Vec<Completion>,
    text: &str,
    offset: u32,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(word) = items.first().map(|item| item.replace) else { return items };
    let cut = offset.clamp(word.start, word.end);
    let following = text.get(word.end as usize..).unwrap_or_default();
    let word = Word {
        before: Span::new(word.start, cut).text(text),
        after: Span::new(cut, word.end).text(text),
        ends_line: ends_line(following.chars()),
    };
    filter(items, word, trigger)
}

impl CompletionTrigger {
    /// Whether the list opens in a TOML file: automatically where a value is expected and in a header.
    pub(crate) fn opens_in_toml(self, cursor: &CursorContext) -> bool {
        match self {
            Self::Invoked | Self::Letter => true,
            Self::Character('[') => matches!(cursor.slot, Slot::Table { .. }),
            Self::Character(' ' | '"') => matches!(cursor.slot, Slot::Value { .. }),
            Self::Character(_) => false,
        }
    }
}
