//! The context of a completion: the entity before the cursor, as far as it is typed.

use pydslrep_analysis::{Database, EntityId, EntityRef, FileId};
use pydslrep_syntax::ast::{Drive, Entity, Movement};
use pydslrep_syntax::{Expected, Span, Token, TokenKind};
use smol_str::SmolStr;

use crate::FilePosition;
use crate::statements::Statements;

/// The entity before the cursor, as far as it is typed.
pub(super) struct CompletionContext<'a> {
    pub(super) database: &'a Database,
    pub(super) file: FileId,
    /// The entity that contains the cursor, if any.
    pub(super) entity: Option<EntityId>,
    /// Its tree; `None` at the start of a file.
    pub(super) tree: Option<&'a Entity>,
    /// Its start offset in the file.
    pub(super) start: u32,
    /// Its text.
    pub(super) text: String,
    /// Its tokens before the word at the cursor.
    pub(super) before: Vec<Token>,
    /// The tokens after that word up to the next entity, with their ranges in the file.
    after: Vec<Token>,
    /// True if no token of the entity follows the word at the cursor.
    pub(super) at_end: bool,
    /// The default speed in snippets, centimetres per second.
    pub(super) speed: f64,
    /// The range of the word at the cursor in the file.
    pub(super) word: Span,
    /// That word up to the cursor, without `^`.
    pub(super) written: SmolStr,
    /// The same in lower case.
    pub(super) typed: String,
    /// True if the word begins with `^`.
    pub(super) is_escaped: bool,
}

impl<'a> CompletionContext<'a> {
    pub(super) fn find(database: &'a Database, position: FilePosition, speed: f64) -> Option<Self> {
        let word = word_at(database, position)?;
        // A typed word that equals a keyword is parsed as a new entity, but still continues the one before.
        let own = database.entity_at(position.file, word.start)?;
        let at = match word.start.checked_sub(1) {
            Some(before) if own.span.start == word.start => database.entity_at(position.file, before)?,
            _ => own,
        };
        let (start, significant) = (at.span.start, significant(&at));
        let at_end = !significant.iter().any(|(_, span)| span.start + start >= word.end);
        let before: Vec<Token> =
            significant.into_iter().take_while(|(_, span)| span.end + start <= word.start).collect();
        let ends_number =
            before.last().is_some_and(|(token, span)| token.is_number() && span.end + start == word.start);
        if ends_number {
            return None;
        }
        let after =
            self::significant(&own).into_iter().map(|(token, span)| (token, span.shifted(own.span.start)));
        let typed = database.slice(position.file, Span::new(word.start, position.offset));
        Some(Self {
            database,
            file: position.file,
            entity: at.parse.entity.as_ref().map(|_| at.id),
            tree: at.parse.entity.as_ref(),
            start,
            text: database.slice(position.file, at.span),
            before,
            after: after.filter(|(_, span)| span.start >= word.end).collect(),
            at_end,
            speed,
            word,
            is_escaped: typed.starts_with('^'),
            written: name(&typed),
            typed: typed.trim_start_matches('^').to_lowercase(),
        })
    }

    /// The names already in the list around the cursor, without the word at the cursor.
    pub(super) fn listed(&self) -> Vec<SmolStr> {
        if self.is_after_do() {
            return Vec::new();
        }
        let in_list = |token: TokenKind| token == TokenKind::Comma || token.is_name();
        let before = self.before.iter().rev().take_while(|(token, _)| in_list(*token));
        let before = before.filter(|(token, _)| token.is_name()).map(|(_, span)| name(span.text(&self.text)));
        let after = self.after.iter().take_while(|(token, _)| in_list(*token));
        let after = after.filter(|(token, _)| token.is_name());
        let mut listed: Vec<SmolStr> = before.collect();
        listed.reverse();
        listed.extend(after.map(|(_, span)| name(&self.database.slice(self.file, *span))));
        listed
    }

    /// The movement being typed.
    pub(super) fn movement(&self) -> Option<&'a Movement> {
        match self.tree {
            Some(Entity::Movement(movement)) => Some(movement),
            _ => None,
        }
    }

    /// Returns whether the cursor is in an action that begins with one of these keywords.
    pub(super) fn statement_begins_with(&self, keywords: &[TokenKind]) -> bool {
        let statements = Statements::read(&self.before);
        let first = statements.as_ref().and_then(|statements| statements.latest().first());
        first.is_some_and(|(token, _)| keywords.contains(token))
    }

    /// Returns whether the cursor is where `do` names its movement.
    pub(super) fn is_after_do(&self) -> bool {
        let statements = Statements::read(&self.before);
        matches!(statements.as_ref().map(Statements::latest), Some([.., (TokenKind::Do, _)]))
    }

    /// The first token after the word at the cursor.
    pub(super) fn next_token(&self) -> Option<TokenKind> {
        self.after.first().map(|(token, _)| *token)
    }

    /// Returns whether the word at the cursor is the first on its line.
    pub(super) fn begins_line(&self) -> bool {
        let end = self.before.last().map_or(0, |(_, span)| self.start + span.end);
        self.database.slice(self.file, Span::new(end, self.word.start)).contains(['\n', '\r'])
    }

    /// Returns whether only a name can come next: after `of`, `ip` and `do`, and in a list that is empty, ends with a
    /// comma, or has fewer wheels than its robot needs.
    pub(super) fn needs_name(&self) -> bool {
        let is_there = self.after.first().is_some_and(|(token, _)| token.is_name());
        let Some((last, _)) = self.before.last().filter(|_| !is_there) else { return false };
        match last {
            TokenKind::Of | TokenKind::Ip | TokenKind::Comma => true,
            TokenKind::OpenBrace => self.listed().is_empty(),
            TokenKind::Do if self.is_after_do() => true,
            token if token.is_name() => self.lacks_wheels(),
            _ => false,
        }
    }

    /// Returns whether the cursor is in the wheel list of a robot that needs another wheel.
    fn lacks_wheels(&self) -> bool {
        let Some(Entity::Robot(robot)) = self.tree else { return false };
        let in_wheels =
            !self.before.iter().any(|(token, _)| matches!(token, TokenKind::Wheels | TokenKind::Sensors));
        let wanted = robot.drive.and_then(|clause| clause.word).map_or(2, Drive::wheel_count);
        in_wheels && self.listed().len() < wanted
    }

    /// Returns whether the word up to the cursor is a name that can be referred to here, even if it fits less well than
    /// others.
    pub(super) fn is_whole_name(&self, expected: &[Expected]) -> bool {
        let is_visible = |kind| self.database.resolve(self.file, kind, &self.written).entity().is_some();
        expected.iter().any(|expected| matches!(expected, Expected::ReferenceTo(kind) if is_visible(*kind)))
    }

    /// Returns whether an import is allowed here: only other imports precede the cursor.
    pub(super) fn may_import(&self) -> bool {
        let is_entity =
            |entity: &EntityRef<'_>| !matches!(entity.parse.entity, None | Some(Entity::Import(_)));
        let first = self.database.entities(self.file).find(is_entity);
        first.is_none_or(|first| self.word.start <= first.span.start)
    }
}

fn name(written: &str) -> SmolStr {
    written.trim_start_matches('^').into()
}

/// The tokens of an entity without comments.
fn significant(entity: &EntityRef<'_>) -> Vec<Token> {
    entity.parse.tokens.iter().filter(|(token, _)| !token.is_comment()).copied().collect()
}

/// The word around the cursor; `None` inside comments, strings and numbers.
fn word_at(database: &Database, position: FilePosition) -> Option<Span> {
    let entity = database.entity_at(position.file, position.offset)?;
    let start = entity.span.start;
    let offset = position.offset - start;
    // At the start of an entity, the word before the cursor belongs to the previous one.
    let before = position.offset.checked_sub(1).filter(|_| offset == 0);
    if let Some(before) = before.and_then(|before| database.entity_at(position.file, before)) {
        return word_in(database, &before, position.offset);
    }
    word_in(database, &entity, position.offset)
}

fn word_in(database: &Database, entity: &EntityRef<'_>, offset: u32) -> Option<Span> {
    let start = entity.span.start;
    let covering = |(_, span): &&Token| span.start + start < offset && offset <= span.end + start;
    let Some((token, span)) = entity.parse.tokens.iter().find(covering) else {
        return Some(Span::at(offset));
    };
    let span = span.shifted(start);
    let inside = offset < span.end;
    match token {
        TokenKind::BlockComment | TokenKind::String if !inside => Some(Span::at(offset)),
        TokenKind::String | TokenKind::UnterminatedString => None,
        token if token.is_comment() => None,
        token if token.is_name() || token.is_keyword() => Some(span),
        token if token.is_number() && inside => None,
        // The start of an escaped name.
        TokenKind::Invalid if database.slice(entity.file, Span::new(span.start, offset)).ends_with('^') => {
            Some(Span::new(offset - 1, offset))
        }
        _ => Some(Span::at(offset)),
    }
}
