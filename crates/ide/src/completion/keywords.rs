//! Keywords, with the ones that must follow them, and values.

use pydslrep_analysis::{EntityId, Target};
use pydslrep_syntax::ast::{Drive, Entity};
use pydslrep_syntax::{EntityKind, Expected, Span, TokenKind, expected_after};
use smol_str::SmolStr;

use super::context::CursorContext;
use super::defaults::likely_list;
use super::names::{MAX_RANKED, NEARBY_ENTITIES};
use super::snippets::tab_stop;
use super::{Completion, CompletionKind, Documentation, Rank};
use crate::keyword_pages::{KeywordPage, keyword_page};

impl CursorContext<'_> {
    /// An item that replaces the word at the cursor.
    pub(super) fn item(&self, label: &str, kind: CompletionKind, rank: Rank) -> Completion {
        Completion {
            insert: label.to_owned(),
            is_escaped: self.is_escaped,
            rank,
            ..Completion::new(label, kind, self.word)
        }
    }
}

/// A keyword with the ones that must follow it; `None` for the comma, which is always optional.
pub(super) fn keyword(context: &CursorContext<'_>, word: TokenKind) -> Option<Completion> {
    let spelling = word.spelling().filter(|_| word != TokenKind::Comma)?;
    let Continuation { insert, label, last } = continuation(context, word);
    let label = if word == TokenKind::OpenBrace { &label } else { label.trim_end_matches(" …") };
    // `with` and braces say little by themselves: the page of the last keyword is more helpful.
    let leads =
        matches!(word, TokenKind::With | TokenKind::Has | TokenKind::OpenBrace | TokenKind::CloseBrace);
    let page = keyword_page(if leads { last } else { word });
    let rank = match word {
        TokenKind::CloseBrace => Rank::Closing,
        // A condition is more likely to go on.
        TokenKind::OpenBrace if context.movement().is_some() => Rank::Closing,
        _ if matches_wheels(context, word) => Rank::Fitting,
        _ => Rank::Keyword,
    };
    Some(Completion {
        detail: page.map_or_else(String::new, |page| detail(word, &page)),
        documentation: Documentation::Text(
            page.map_or_else(|| format!("`{spelling}`"), |page| page.markdown()),
        ),
        is_snippet: insert.contains('$'),
        insert,
        ..context.item(label, CompletionKind::Keyword, rank)
    })
}

/// For the values of `type`, their meaning; otherwise the syntax.
fn detail(word: TokenKind, page: &KeywordPage) -> String {
    match word.drive() {
        Some(drive) => drive.row().label.to_owned(),
        None => page.syntax.lines().next().unwrap_or_default().to_owned(),
    }
}

/// Whether a keyword is the drive type that the robot's wheels imply.
fn matches_wheels(context: &CursorContext<'_>, word: TokenKind) -> bool {
    let (Some(drive), Some(Entity::Robot(robot))) = (word.drive(), context.tree) else { return false };
    let names = robot.wheels.iter().flat_map(|list| &list.names);
    let mecanum: Vec<bool> = names.filter_map(|name| is_mecanum(context, &name.text)).collect();
    Drive::from_wheels(&mecanum) == Some(drive)
}

/// Whether the wheel of this name is a mecanum wheel; `None` if there is no such wheel.
pub(super) fn is_mecanum(context: &CursorContext<'_>, name: &SmolStr) -> Option<bool> {
    let id = context.database.resolve(context.file, EntityKind::Wheel, name).entity()?;
    match context.database.tree(id)? {
        Entity::Wheel(wheel) => Some(wheel.mecanum),
        _ => None,
    }
}

/// A keyword with the ones that must follow it.
struct Continuation {
    insert: String,
    /// The same with `…` for placeholders.
    label: String,
    /// The last of the keywords.
    last: TokenKind,
}

impl Continuation {
    fn push(&mut self, insert: &str, label: &str) {
        self.insert.extend([" ", insert]);
        self.label.extend([" ", label]);
    }
}

/// `with` continues to `with port`, `has` to `has { … } wheels`, as long as only one keyword can follow and nothing is
/// there yet.
fn continuation(context: &CursorContext<'_>, word: TokenKind) -> Continuation {
    const MAX_KEYWORDS: usize = 6;
    let mut before = context.before.clone();
    let spelling = word.spelling().unwrap_or_default().to_owned();
    let mut continued = Continuation { insert: spelling.clone(), label: spelling, last: word };
    let most = if context.at_end { MAX_KEYWORDS } else { usize::from(leads_on(context, word)) };
    for _ in 0..most {
        let end = Span::at(before.last().map_or(0, |(_, span)| span.end));
        before.push((continued.last, end));
        let mut expected = expected_after(&context.text, &before);
        if let Some(kind) = listed_kind(continued.last, &expected) {
            continued.push(&tab_stop(1, &likely_list(context, kind)), "…");
            continued.push("}", "}");
            before.extend([(TokenKind::Name, end), (TokenKind::CloseBrace, end)]);
            expected = expected_after(&context.text, &before);
        }
        match expected[..] {
            // The block is a snippet of its own.
            [Expected::Word(TokenKind::OpenBrace)] if continued.last == TokenKind::Times => break,
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

/// Whether a keyword of a statement brings the next one, although more of the movement follows.
fn leads_on(context: &CursorContext<'_>, word: TokenKind) -> bool {
    let next = match word {
        TokenKind::With => TokenKind::Radius,
        TokenKind::In => TokenKind::Reverse,
        _ => return false,
    };
    context.movement().is_some() && context.next_token() != Some(next)
}

/// The kind of the references in a list that begins here.
fn listed_kind(last: TokenKind, expected: &[Expected]) -> Option<EntityKind> {
    let kind = expected.iter().find_map(|expected| match expected {
        Expected::ReferenceTo(kind) => Some(*kind),
        _ => None,
    });
    kind.filter(|_| last == TokenKind::OpenBrace)
}

/// Keywords without continuation.
pub(super) fn plain_keywords(context: &CursorContext<'_>, words: &[TokenKind]) -> Vec<Completion> {
    let word = |word: &TokenKind| {
        let page = keyword_page(*word)?;
        Some(Completion {
            detail: detail(*word, &page),
            documentation: Documentation::Text(page.markdown()),
            ..context.item(word.spelling()?, CompletionKind::Keyword, Rank::Keyword)
        })
    };
    words.iter().filter_map(word).collect()
}

/// A number or an address.
pub(super) fn value(context: &CursorContext<'_>, text: &str, detail: &str) -> Completion {
    Completion { detail: detail.to_owned(), ..context.item(text, CompletionKind::Value, Rank::Fitting) }
}

/// A port for the robot `own`, or for a new one: the port that all others share, as they may in CoppeliaSim; otherwise
/// the one after the highest, or the first free one.
pub(super) fn port(context: &CursorContext<'_>, own: Option<EntityId>) -> Option<String> {
    let target = context.database.target(context.file);
    let port = |id: EntityId| match context.database.tree(id)? {
        Entity::Robot(robot) if Some(id) != own => robot.port.as_ref()?.value,
        _ => None,
    };
    let mut taken: Vec<u16> = if context.database.count(context.file, EntityKind::Robot) as usize > MAX_RANKED
    {
        let near = context.database.entities_around(context.file, context.word.start, NEARBY_ENTITIES);
        near.filter_map(port).collect()
    } else {
        let robots = context.database.names_in_sight(context.file, EntityKind::Robot);
        let found = |name| context.database.resolve(context.file, EntityKind::Robot, name).entity();
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
