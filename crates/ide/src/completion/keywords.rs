//! Keywords, with those that must follow them, and values.

use pydslrep_analysis::{EntityId, Target};
use pydslrep_syntax::ast::{DriveWord, Entity};
use pydslrep_syntax::{EntityKind, Expected, Span, TokenKind, expected_after};
use smol_str::SmolStr;

use super::defaults::likely_list;
use super::names::{FEW, NEAR};
use super::snippets::stop;
use super::context::CursorContext;
use super::{Completion, CompletionKind, Documentation, Rank};
use crate::keyword_pages::{KeywordPage, keyword_page};

impl CursorContext<'_> {
    /// A completion of the word at the cursor.
    pub(super) fn item(&self, label: &str, kind: CompletionKind, rank: Rank) -> Completion {
        Completion {
            insert: label.to_owned(),
            is_escaped: self.is_escaped,
            rank,
            ..Completion::new(label, kind, self.word)
        }
    }
}

/// A word, followed by those that can only follow it; `None` for the comma, which is never needed.
pub(super) fn word(place: &CursorContext<'_>, word: TokenKind) -> Option<Completion> {
    let spelling = word.spelling().filter(|_| word != TokenKind::Comma)?;
    let Continued { insert, label, last } = continued(place, word);
    let label = if word == TokenKind::OpenBrace { &label } else { label.trim_end_matches(" …") };
    // `with` and braces say little by themselves; the word they lead to says it.
    let leads =
        matches!(word, TokenKind::With | TokenKind::Has | TokenKind::OpenBrace | TokenKind::CloseBrace);
    let page = keyword_page(if leads { last } else { word });
    let rank = match word {
        TokenKind::CloseBrace => Rank::Closing,
        _ if suits(place, word) => Rank::Fitting,
        _ => Rank::Word,
    };
    Some(Completion {
        detail: page.map_or_else(String::new, |page| detail(word, &page)),
        documentation: Documentation::Text(
            page.map_or_else(|| format!("`{spelling}`"), |page| page.markdown()),
        ),
        is_snippet: insert.contains('$'),
        insert,
        ..place.item(label, CompletionKind::Keyword, rank)
    })
}

/// What a value of `type` stands for says more than where it stands.
fn detail(word: TokenKind, page: &KeywordPage) -> String {
    let text = match word {
        TokenKind::Tw | TokenKind::Fw | TokenKind::Fwh => page.meaning.split(':').next(),
        _ => page.syntax.lines().next(),
    };
    text.unwrap_or_default().to_owned()
}

/// Whether it is the type of a robot with the wheels that this one has.
fn suits(place: &CursorContext<'_>, word: TokenKind) -> bool {
    let (TokenKind::Tw | TokenKind::Fw | TokenKind::Fwh, Some(Entity::Robot(robot))) = (word, place.tree)
    else {
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
pub(super) fn is_mecanum(place: &CursorContext<'_>, name: &SmolStr) -> Option<bool> {
    let id = place.database.resolve(place.file, EntityKind::Wheel, name).entity()?;
    match place.database.tree(id)? {
        Entity::Wheel(wheel) => Some(wheel.mecanum),
        _ => None,
    }
}

/// A word with those that can only follow it.
struct Continued {
    insert: String,
    /// The same with `…` for what the person fills in.
    label: String,
    /// The last of the words.
    last: TokenKind,
}

impl Continued {
    fn push(&mut self, insert: &str, label: &str) {
        self.insert.extend([" ", insert]);
        self.label.extend([" ", label]);
    }
}

/// `with` continues to `with port`, `has` to `has { … } wheels`: as long as only one word can follow, and nothing
/// is written there yet.
fn continued(place: &CursorContext<'_>, word: TokenKind) -> Continued {
    const MOST: usize = 6;
    let mut before = place.before.clone();
    let spelling = word.spelling().unwrap_or_default().to_owned();
    let mut continued = Continued { insert: spelling.clone(), label: spelling, last: word };
    for _ in 0..if place.at_end { MOST } else { 0 } {
        let end = Span::at(before.last().map_or(0, |(_, span)| span.end));
        before.push((continued.last, end));
        let mut expected = expected_after(&place.text, &before);
        if let Some(kind) = listed_kind(continued.last, &expected) {
            continued.push(&stop(1, &likely_list(place, kind)), "…");
            continued.push("}", "}");
            before.extend([(TokenKind::Name, end), (TokenKind::CloseBrace, end)]);
            expected = expected_after(&place.text, &before);
        }
        match expected[..] {
            [Expected::Word(word)] if word != TokenKind::Comma && word != TokenKind::CloseBrace => {
                let spelling = word.spelling().unwrap_or_default();
                continued.push(spelling, spelling);
                continued.last = word;
            }
            _ => break,
        }
    }
    continued
}

/// What a list that begins here has references to.
fn listed_kind(last: TokenKind, expected: &[Expected]) -> Option<EntityKind> {
    let kind = expected.iter().find_map(|expected| match expected {
        Expected::ReferenceTo(kind) => Some(*kind),
        _ => None,
    });
    kind.filter(|_| last == TokenKind::OpenBrace)
}

/// Words after which a person goes on.
pub(super) fn plain_words(place: &CursorContext<'_>, words: &[TokenKind]) -> Vec<Completion> {
    let word = |word: &TokenKind| {
        let page = keyword_page(*word)?;
        Some(Completion {
            detail: detail(*word, &page),
            documentation: Documentation::Text(page.markdown()),
            ..place.item(word.spelling()?, CompletionKind::Keyword, Rank::Word)
        })
    };
    words.iter().filter_map(word).collect()
}

/// A number or an address.
pub(super) fn value(place: &CursorContext<'_>, text: &str, detail: &str) -> Completion {
    Completion { detail: detail.to_owned(), ..place.item(text, CompletionKind::Value, Rank::Fitting) }
}

/// A port for a robot: `own`, or a new one. Where all robots share one port, as they may in CoppeliaSim, it is theirs; else it is the one
/// after the highest, or the first that is free.
pub(super) fn port(place: &CursorContext<'_>, own: Option<EntityId>) -> Option<String> {
    let target = place.database.target(place.file);
    let port = |id: EntityId| match place.database.tree(id)? {
        Entity::Robot(robot) if Some(id) != own => robot.port.as_ref()?.value,
        _ => None,
    };
    let mut taken: Vec<u16> = if place.database.count(place.file, EntityKind::Robot) as usize > FEW {
        let near = place.database.entities_around(place.file, place.word.start, NEAR);
        near.filter_map(port).collect()
    } else {
        let robots = place.database.names_in_sight(place.file, EntityKind::Robot);
        let found = |name| place.database.resolve(place.file, EntityKind::Robot, name).entity();
        robots.filter_map(found).filter_map(port).collect()
    };
    taken.sort_unstable();
    taken.dedup();
    let first = target.default_port();
    let port = match taken[..] {
        [] => Some(first),
        [shared] if target == Target::CoppeliaSim => Some(shared),
        [.., highest] => highest.checked_add(1),
    };
    let free = |port: &u16| taken.binary_search(port).is_err();
    port.or_else(|| (first..=u16::MAX).chain(1..first).find(free)).map(|port| port.to_string())
}
