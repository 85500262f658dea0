//! Completion: what the grammar allows at the cursor, and only the names that fit there.
//!
//! The parser itself says which keywords fit ([`expected_after`]), so completion cannot drift from the language.

mod actions;
mod context;
mod defaults;
mod documentation;
mod edition;
pub(crate) mod filter;
mod item;
mod keywords;
mod names;
mod paths;
mod snippets;
#[cfg(test)]
mod testing;

use pydslrep_analysis::{Database, Edition};
use pydslrep_syntax::{Expected, Quantity, Span, TokenKind, expected_after};

use self::context::CompletionContext;
pub use self::documentation::completion_documentation;
pub(crate) use self::item::Rank;
pub use self::item::{Completion, CompletionKind, Documentation};
use crate::FilePosition;

/// The maximum number of items in a list: long lists are slow in editors, and nobody reads them.
const MAX_ITEMS: usize = 200;

/// The event that triggered a completion request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionTrigger {
    /// The user has asked for the list.
    Invoked,
    /// A letter of a word: the list opens automatically, or is open already.
    Letter,
    /// Punctuation or a space. A list opens automatically only where one of its items must come next.
    Character(char),
}

/// The completions at a position, best first; `speed` is the default for snippets, in centimetres per second.
///
/// Clients must request the list again after every typed character, since it depends on the typed prefix.
pub fn completions(
    database: &Database,
    position: FilePosition,
    trigger: CompletionTrigger,
    speed: f64,
) -> Vec<Completion> {
    if let Some(string) = paths::string_at(database, position) {
        let items = match trigger {
            _ if database.edition(position.file) == Edition::Article => Vec::new(),
            CompletionTrigger::Invoked
            | CompletionTrigger::Letter
            | CompletionTrigger::Character('"' | '/') => paths::paths(database, position.file, &string),
            CompletionTrigger::Character(_) => Vec::new(),
        };
        return filter_at(database, position, items, trigger);
    }
    let Some(context) = CompletionContext::find(database, position, speed) else { return Vec::new() };
    let expected = expected_after(&context.text, &context.before);
    let opens = match trigger {
        CompletionTrigger::Invoked => true,
        CompletionTrigger::Letter => !context.is_whole_name(&expected),
        CompletionTrigger::Character('^') => context.is_escaped,
        CompletionTrigger::Character(' ') => context.needs_name(),
        CompletionTrigger::Character(_) => false,
    };
    if !opens {
        return Vec::new();
    }
    let may_end =
        expected.iter().any(|expected| matches!(expected, Expected::Action | Expected::Declaration));
    let mut items: Vec<Completion> = Vec::new();
    for expected in expected {
        let is_clause = may_end && matches!(expected, Expected::Word(word) if word != TokenKind::CloseBrace);
        let is_name = matches!(expected, Expected::ReferenceTo(_));
        if is_name || matches!(trigger, CompletionTrigger::Invoked | CompletionTrigger::Letter) {
            let mut found = items_for(&context, expected);
            edition::retain(&context, expected, &mut found);
            if is_clause {
                // On the same line, continuing the statement is more likely; on a new line, starting another one.
                let rank = if context.begins_line() { Rank::Closing } else { Rank::Fitting };
                for item in &mut found {
                    item.rank = rank;
                }
            }
            items.extend(found);
        }
    }
    items.sort_by_key(|item| item.rank);
    filter_at(database, position, items, trigger)
}

/// Drops the items that would get in the way of typing. All of them replace the same word.
fn filter_at(
    database: &Database,
    position: FilePosition,
    items: Vec<Completion>,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(word) = items.first().map(|item| item.replace) else { return items };
    let slice = |start, end| database.slice(position.file, Span::new(start, end));
    let (before, after) = (slice(word.start, position.offset), slice(position.offset, word.end));
    let ends_line = database.text(position.file).is_none_or(|text| {
        let following = text.get_byte_slice(word.end as usize..);
        following.is_none_or(|following| filter::ends_line(following.chars()))
    });
    filter::filter(items, filter::Word { before: &before, after: &after, ends_line }, trigger)
}

fn items_for(context: &CompletionContext<'_>, expected: Expected) -> Vec<Completion> {
    match expected {
        Expected::Word(word) => {
            let mut found = clauses(context, word);
            found.extend(keywords::keyword(context, word));
            found
        }
        Expected::ReferenceTo(kind) => names::names(context, kind),
        Expected::Action => {
            let mut found = actions::actions(context);
            found.extend(keywords::plain_keywords(context, &TokenKind::ACTIONS));
            found
        }
        Expected::Declaration => {
            let mut found = snippets::entities(context);
            let words = TokenKind::DECLARATIONS.into_iter();
            let words: Vec<_> =
                words.filter(|word| *word != TokenKind::Import || context.may_import()).collect();
            found.extend(keywords::plain_keywords(context, &words));
            found
        }
        Expected::Port => {
            let port = keywords::port(context, context.entity);
            port.map(|port| keywords::value(context, &port, "simulator port")).into_iter().collect()
        }
        Expected::Address => vec![keywords::value(context, "127.0.0.1", "this machine")],
        Expected::Number(Quantity::Radius) => vec![keywords::value(context, "4.5", "centimetres")],
        Expected::Number(Quantity::Speed) => {
            vec![keywords::value(context, &format!("{:?}", context.speed), "centimetres per second")]
        }
        Expected::Path => paths::quoted_paths(context),
        Expected::Number(_) | Expected::NameOf(_) => Vec::new(),
    }
}

/// The clauses of actions that a keyword begins, with placeholders.
fn clauses(context: &CompletionContext<'_>, word: TokenKind) -> Vec<Completion> {
    match word {
        TokenKind::At => actions::speed(context),
        TokenKind::With if context.movement().is_some() => actions::circle(context),
        TokenKind::Until => actions::until(context),
        TokenKind::Else => actions::otherwise(context),
        TokenKind::Times => actions::rounds(context),
        _ => Vec::new(),
    }
}
