//! The entity, name or token at a position.

use pydslrep_analysis::{Database, EntityId, EntityRef, FileId};
use pydslrep_syntax::ast::{Entity, Movement, Name};
use pydslrep_syntax::{EntityKind, Span, Token, TokenKind};
use smol_str::SmolStr;

use crate::FilePosition;

/// A name at the cursor.
#[derive(Debug, Clone)]
pub(crate) struct NameAt {
    pub(crate) kind: EntityKind,
    pub(crate) name: Name,
    /// Its range in the file.
    pub(crate) span: Span,
}

/// The name that touches the cursor.
pub(crate) fn name_at(database: &Database, position: FilePosition) -> Option<NameAt> {
    entities_at(database, position).into_iter().find_map(|entity| name_in(&entity, position.offset))
}

fn name_in(entity: &EntityRef<'_>, offset: u32) -> Option<NameAt> {
    let tree = entity.parse.entity.as_ref()?;
    let touches = |name: &Name| name.span.shifted(entity.span.start).touches(offset);
    let found =
        |kind, name: &Name| NameAt { kind, span: name.span.shifted(entity.span.start), name: name.clone() };
    if let (Some(kind), Some(name)) = (tree.kind(), tree.name().filter(|name| touches(name))) {
        return Some(found(kind, name));
    }
    let mut references = tree.references().into_iter();
    references.find(|(_, name)| touches(name)).map(|(kind, name)| found(kind, name))
}

/// The referent of the name at the cursor: all declarations of that name in one file. Two of the same kind are an
/// error, and a reference could mean either.
#[derive(Debug, Clone)]
pub(crate) struct Referent {
    pub(crate) kind: EntityKind,
    pub(crate) name: SmolStr,
    /// The declaring file, or the cursor's file if there are no declarations.
    pub(crate) home: FileId,
}

/// The referent of the name that touches the cursor.
pub(crate) fn referent_at(database: &Database, position: FilePosition) -> Option<Referent> {
    let at = name_at(database, position)?;
    let declared = database.resolve(position.file, at.kind, &at.name.text).entity();
    let home = declared.and_then(|id| database.file_of(id)).unwrap_or(position.file);
    Some(Referent { kind: at.kind, name: at.name.text, home })
}

/// The entity that contains the cursor, then the one that ends right before it.
pub(crate) fn entities_at(database: &Database, position: FilePosition) -> Vec<EntityRef<'_>> {
    let at = database.entity_at(position.file, position.offset);
    let before = position.offset.checked_sub(1).and_then(|offset| database.entity_at(position.file, offset));
    let before = before.filter(|before| at.is_none_or(|at| at.id != before.id));
    at.into_iter().chain(before).collect()
}

/// The tokens of an entity, with their ranges in the file.
pub(crate) fn tokens<'a>(entity: &EntityRef<'a>) -> impl Iterator<Item = Token> + use<'a> {
    let start = entity.span.start;
    entity.parse.tokens.iter().map(move |(token, span)| (*token, span.shifted(start)))
}

/// The token that touches the cursor, with its range in the file.
pub(crate) fn token_at(database: &Database, position: FilePosition) -> Option<Token> {
    touching(entities_at(database, position).iter().flat_map(tokens), position.offset)
}

/// The token that touches an offset; of two, a word or number rather than punctuation.
pub(crate) fn touching(tokens: impl Iterator<Item = Token>, offset: u32) -> Option<Token> {
    let touching: Vec<Token> = tokens.filter(|(_, span)| span.touches(offset)).collect();
    touching.iter().find(|(token, _)| is_word(*token)).or(touching.first()).copied()
}

/// True for a token that another letter or digit may continue.
pub(crate) fn is_word(token: TokenKind) -> bool {
    token.is_name() || token.is_keyword() || token.is_number()
}

/// The range of an entity from its keyword to its last token, without trailing comments.
pub(crate) fn body(entity: &EntityRef<'_>) -> Span {
    let last = entity.parse.tokens.iter().rev().find(|(token, _)| !token.is_comment());
    let end = last.map_or(entity.span.start, |(_, span)| entity.span.start + span.end);
    Span::new(entity.span.start, end)
}

/// The robot that a movement names, as seen from a file.
pub(crate) fn named_robot(database: &Database, file: FileId, movement: &Movement) -> Option<EntityId> {
    database.resolve(file, EntityKind::Robot, &movement.robot.as_ref()?.text).entity()
}

/// Returns whether the wheel of this name is a mecanum wheel; `None` if a file sees no such wheel.
pub(crate) fn is_mecanum(database: &Database, file: FileId, wheel: &SmolStr) -> Option<bool> {
    let id = database.resolve(file, EntityKind::Wheel, wheel).entity()?;
    match database.tree(id)? {
        Entity::Wheel(wheel) => Some(wheel.mecanum),
        _ => None,
    }
}
