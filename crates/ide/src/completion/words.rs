//! Words of the language, whole patterns of them, and values.

use pydslrep_syntax::ast::{DriveWord, Entity};
use pydslrep_syntax::{EntityKind, Expected, Span, Token, expected_after};
use smol_str::SmolStr;

use super::place::Place;
use super::snippets::{Snippet, without_stops};
use super::{Completion, CompletionKind, Documentation, Rank};
use crate::reference::{KeywordPage, keyword_page};

impl Place<'_> {
    /// A completion of the word at the cursor.
    pub(super) fn item(&self, label: &str, kind: CompletionKind, rank: Rank) -> Completion {
        Completion {
            insert: self.apart(label),
            is_escaped: self.is_escaped,
            rank,
            ..Completion::new(label, kind, self.word)
        }
    }

    /// Text to insert so that it does not run into what stands before it.
    fn apart(&self, text: &str) -> String {
        if self.needs_space { format!(" {text}") } else { text.to_owned() }
    }
}

/// A word, followed by those that can only follow it; `None` for the comma, which is never needed.
pub(super) fn word(place: &Place<'_>, word: Token) -> Option<Completion> {
    let spelling = word.spelling().filter(|_| word != Token::Comma)?;
    let Continued { insert, is_snippet, last } = continued(place, word);
    let label =
        insert.replace(" $0 ", " … ").replace("$0", "…").split_whitespace().collect::<Vec<_>>().join(" ");
    let label = if word == Token::OpenBrace { &label } else { label.trim_end_matches(" …") };
    // `with` and braces say little by themselves; the word they lead to says it.
    let leads = matches!(word, Token::With | Token::Has | Token::OpenBrace | Token::CloseBrace);
    let page = keyword_page(if leads { last } else { word });
    let rank = match word {
        Token::CloseBrace => Rank::Closing,
        _ if suits(place, word) => Rank::Fitting,
        _ => Rank::Word,
    };
    Some(Completion {
        detail: page.map_or_else(String::new, |page| detail(word, &page)),
        documentation: Documentation::Text(
            page.map_or_else(|| format!("`{spelling}`"), |page| page.markdown()),
        ),
        insert: place.apart(&insert),
        is_snippet,
        ..place.item(label, CompletionKind::Keyword, rank)
    })
}

/// What a value of `type` stands for says more than where it stands.
fn detail(word: Token, page: &KeywordPage) -> String {
    let text = match word {
        Token::Tw | Token::Fw | Token::Fwh => page.meaning.split(':').next(),
        _ => page.syntax.lines().next(),
    };
    text.unwrap_or_default().to_owned()
}

/// Whether it is the type of a robot with the wheels that this one has.
fn suits(place: &Place<'_>, word: Token) -> bool {
    let (Token::Tw | Token::Fw | Token::Fwh, Some(Entity::Robot(robot))) = (word, place.tree) else {
        return false;
    };
    let names = robot.wheels.iter().flat_map(|list| &list.names);
    let mecanum: Vec<bool> = names.filter_map(|name| is_mecanum(place, &name.text)).collect();
    let drive = match mecanum[..] {
        [false, false] => DriveWord::Tw,
        [false, false, false, false] => DriveWord::Fw,
        [true, true, true, true] => DriveWord::Fwh,
        _ => return false,
    };
    word.spelling() == Some(drive.spelling())
}

/// Whether the wheel of this name is a mecanum wheel; `None` where there is none.
pub(super) fn is_mecanum(place: &Place<'_>, name: &SmolStr) -> Option<bool> {
    let id = place.database.resolve(place.file, EntityKind::Wheel, name).entity()?;
    match place.database.tree(id)? {
        Entity::Wheel(wheel) => Some(wheel.mecanum),
        _ => None,
    }
}

/// A word with those that can only follow it.
struct Continued {
    insert: String,
    is_snippet: bool,
    /// The last of the words.
    last: Token,
}

/// `with` continues to `with port`, `has` to `has { $0 } wheels`: as long as only one word can follow, and nothing
/// is written there yet.
fn continued(place: &Place<'_>, word: Token) -> Continued {
    const MOST: usize = 6;
    let mut before = place.before.clone();
    let insert = word.spelling().unwrap_or_default().to_owned();
    let mut continued = Continued { insert, is_snippet: false, last: word };
    for _ in 0..if place.at_end { MOST } else { 0 } {
        let end = Span::at(before.last().map_or(0, |(_, span)| span.end));
        before.push((continued.last, end));
        let mut expected = expected_after(&place.text, &before);
        if continued.last == Token::OpenBrace
            && expected.iter().any(|expected| matches!(expected, Expected::ReferenceTo(_)))
        {
            continued.insert += " $0 }";
            continued.is_snippet = true;
            before.extend([(Token::Name, end), (Token::CloseBrace, end)]);
            expected = expected_after(&place.text, &before);
        }
        match expected[..] {
            [Expected::Word(word)] if word != Token::Comma && word != Token::CloseBrace => {
                continued.insert = format!("{} {}", continued.insert, word.spelling().unwrap_or_default());
                continued.last = word;
            }
            _ => break,
        }
    }
    continued
}

/// Words behind which a person goes on.
pub(super) fn plain_words(place: &Place<'_>, words: &[Token]) -> Vec<Completion> {
    let word = |word: &Token| {
        let page = keyword_page(*word)?;
        Some(Completion {
            detail: detail(*word, &page),
            documentation: Documentation::Text(page.markdown()),
            ..place.item(word.spelling()?, CompletionKind::Keyword, Rank::Word)
        })
    };
    words.iter().filter_map(word).collect()
}

/// Whole patterns.
pub(super) fn patterns(place: &Place<'_>, snippets: &[Snippet]) -> Vec<Completion> {
    let pattern = |snippet: &Snippet| {
        let insert = snippet.filled_in(place.speed);
        Completion {
            detail: snippet.detail.to_owned(),
            documentation: Documentation::Text(format!("```pydslrep\n{}\n```", without_stops(&insert))),
            insert: place.apart(&insert),
            is_snippet: true,
            ..place.item(snippet.label, CompletionKind::Snippet, Rank::Pattern)
        }
    };
    snippets.iter().map(pattern).collect()
}

/// A number or an address.
pub(super) fn value(place: &Place<'_>, text: &str, detail: &str) -> Completion {
    Completion { detail: detail.to_owned(), ..place.item(text, CompletionKind::Value, Rank::Fitting) }
}

/// The first port offered: V-REP's.
const FIRST_PORT: u16 = 19999;

/// A port that no robot in sight has: behind the highest, else the first that is free.
pub(super) fn free_port(place: &Place<'_>) -> Option<String> {
    let robots = place.database.names_in_sight(place.file, EntityKind::Robot);
    let port = |name: &SmolStr| {
        let id = place.database.resolve(place.file, EntityKind::Robot, name).entity()?;
        match place.database.tree(id)? {
            Entity::Robot(robot) => robot.port.as_ref()?.value,
            _ => None,
        }
    };
    let mut taken: Vec<u16> = robots.filter_map(port).collect();
    taken.sort_unstable();
    let next = taken.last().map_or(Some(FIRST_PORT), |highest| highest.checked_add(1));
    let free = |port: &u16| taken.binary_search(port).is_err();
    next.or_else(|| (FIRST_PORT..=u16::MAX).chain(1..FIRST_PORT).find(free)).map(|port| port.to_string())
}
