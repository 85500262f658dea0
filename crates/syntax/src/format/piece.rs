//! The units of the layout: entities, and stretches of text that have to stay as they are.

use super::gap::Gap;
use crate::ast::Entity;
use crate::{EntityKind, Parse, Span, Token, TokenKind};

/// The kind of an item, as far as blank lines depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ItemKind {
    Import,
    Declaration(EntityKind),
}

impl ItemKind {
    /// Returns whether neighbours of this kind are on adjacent lines.
    pub(super) fn stands_in_runs(self) -> bool {
        use EntityKind::{Ip, Sensor, Wheel};
        matches!(self, Self::Import | Self::Declaration(Wheel | Sensor | Ip))
    }
}

/// An entity, or a stretch of text with errors. Both ends are indices into the file's tokens.
#[derive(Debug, Clone)]
pub(super) struct Item {
    pub(super) first: usize,
    pub(super) last: usize,
    /// The kind at its start; `None` where no entity was understood.
    pub(super) first_kind: Option<ItemKind>,
    /// The kind at its end, which differs only in stretches of several broken entities.
    pub(super) last_kind: Option<ItemKind>,
    /// True if it has to stay byte for byte as it is.
    pub(super) broken: bool,
}

/// All tokens of a file, and the items among them.
pub(super) fn items<'a>(
    text: &str,
    pieces: impl IntoIterator<Item = (Span, &'a Parse)>,
) -> (Vec<Token>, Vec<Item>) {
    let mut tokens = Vec::with_capacity(text.len() / 6);
    let mut items: Vec<Item> = Vec::new();
    for (span, parse) in pieces {
        let offset = tokens.len();
        tokens.extend(parse.tokens.iter().map(|(token, place)| (*token, place.shifted(span.start))));
        let is_inside = |(token, _): &Token| !token.is_comment() || *token == TokenKind::UnterminatedComment;
        let first = parse.tokens.iter().position(is_inside);
        let last = parse.tokens.iter().rposition(is_inside);
        if let (Some(first), Some(last)) = (first, last) {
            let kind = parse.entity.as_ref().map(kind_of);
            items.push(Item {
                first: offset + first,
                last: offset + last,
                first_kind: kind,
                last_kind: kind,
                broken: kind.is_none() || !parse.errors.is_empty(),
            });
        }
    }
    let items = join_broken(text, &tokens, items);
    (tokens, items)
}

fn kind_of(entity: &Entity) -> ItemKind {
    entity.kind().map_or(ItemKind::Import, ItemKind::Declaration)
}

/// Broken neighbours stay as they are together with what is between them: a mistake may have cut one entity in
/// two. Comments after a broken entity may be part of it, so they stay too, unless they belong to the next one.
fn join_broken(text: &str, tokens: &[Token], items: Vec<Item>) -> Vec<Item> {
    let mut joined: Vec<Item> = Vec::with_capacity(items.len());
    for item in items {
        match joined.last_mut().filter(|previous| previous.broken) {
            Some(previous) if item.broken => {
                previous.last = item.last;
                previous.last_kind = item.last_kind;
            }
            Some(previous) => {
                previous.last = end_of_broken(text, tokens, previous.last, item.first);
                joined.push(item);
            }
            None => joined.push(item),
        }
    }
    if let Some(last) = joined.last_mut().filter(|item| item.broken) {
        last.last = tokens.len() - 1;
    }
    joined
}

fn end_of_broken(text: &str, tokens: &[Token], last: usize, next: usize) -> usize {
    let gap = Gap::new(text, tokens, Some(last), next);
    gap.first_attached().unwrap_or(next) - 1
}
