//! The edits of fixes: which text one replaces, and where it is once the fix gets its place.

use pydslrep_syntax::ast::{Entity, References};
use pydslrep_syntax::{Span, Token, TokenKind, escape, offset};

use super::context::Context;
use super::problem::{ProblemFix, Renaming};
use crate::{Edit, EntityId, Facts, FileId, FileSpan, Fix};

/// A replacement of text in one entity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProblemEdit {
    pub(crate) entity: EntityId,
    pub(crate) span: Span,
    /// With `\n` for the end of a line, whatever the file uses; which it is may change with any edit.
    pub(crate) text: String,
    /// True if the text on both sides is to become one word; else words are kept apart.
    pub(crate) joins: bool,
    /// True for a declaration to insert before the entity, at the nearest place that cuts no other entity in two.
    pub(crate) declares: bool,
}

impl ProblemEdit {
    /// A replacement that keeps words apart.
    pub(super) fn new(entity: EntityId, span: Span, text: impl Into<String>) -> Self {
        Self { entity, span, text: text.into(), joins: false, declares: false }
    }
}

/// Characters that people write within a number or a name, such as `1'000`: the rest on both sides is one word.
const WITHIN_WORDS: [char; 4] = ['\'', '’', '$', '@'];

impl Context<'_> {
    /// A replacement of text in this entity.
    pub(super) fn replace(&self, span: Span, text: impl Into<String>) -> ProblemEdit {
        ProblemEdit::new(self.id, span, text)
    }

    /// A replacement that makes one word of what is on its sides.
    pub(super) fn join(&self, span: Span, text: impl Into<String>) -> ProblemEdit {
        ProblemEdit { joins: true, ..self.replace(span, text) }
    }

    /// A declaration before this entity.
    pub(super) fn declare(&self, text: impl Into<String>) -> ProblemEdit {
        ProblemEdit { declares: true, ..self.replace(Span::at(0), text) }
    }

    /// The smallest edit that removes `span` and the white space around it that would be left over. A comment that the
    /// end of its line ends would swallow what follows, and keeps it.
    pub(super) fn remove(&self, span: Span) -> ProblemEdit {
        let before = self.tokens.iter().rev().find(|(_, other)| other.end <= span.start);
        match before {
            Some((token, comment)) if token.ends_line() => self.remove_after_comment(*comment, span),
            Some((_, other)) => self.replace(Span::new(other.end, span.end), ""),
            None => self.replace(span, ""),
        }
    }

    /// Removes what a comment at the end of a line precedes: with its line, or as far as the line goes on.
    fn remove_after_comment(&self, comment: Span, span: Span) -> ProblemEdit {
        let rest = self.len().unwrap_or(span.end);
        let next = self.tokens.iter().find(|(_, other)| other.start >= span.end);
        let next = next.map_or(rest, |(_, other)| other.start);
        let gap = self.text(Span::new(comment.end, span.start));
        let last_line = gap.rfind(['\n', '\r']).map_or(0, |end| end + 1);
        let following = self.text(Span::new(span.end, next));
        match following.find(['\n', '\r']) {
            Some(end) => {
                let end = end + if following[end..].starts_with("\r\n") { 2 } else { 1 };
                self.replace(Span::new(comment.end + offset(last_line), span.end + offset(end)), "")
            }
            None => self.replace(Span::new(span.start, next), ""),
        }
    }

    /// Removes characters, with one space where they have one on both sides.
    pub(super) fn remove_character(&self, span: Span) -> ProblemEdit {
        let end = self.len().unwrap_or(span.end);
        let blank = |span: Span| [" ", "\t"].contains(&self.text(span));
        let before = span.start > 0 && blank(Span::new(span.start - 1, span.start));
        let following = self.text(Span::new(span.end, end.min(span.end + 1)));
        if before && (following.is_empty() || following.starts_with(char::is_whitespace)) {
            return self.replace(Span::new(span.start - 1, span.end), "");
        }
        let first = span.start == 0 && following.starts_with(' ');
        if self.text(span).contains(WITHIN_WORDS) {
            return self.join(span, "");
        }
        self.replace(Span::new(span.start, span.end + u32::from(first)), "")
    }

    /// Removes a word; what is on other lines stays there.
    pub(super) fn remove_word(&self, span: Span) -> ProblemEdit {
        let before = self.tokens.iter().rev().find(|(_, other)| other.end <= span.start);
        let start = before.map_or(0, |(_, other)| other.end);
        let first = self.text(Span::new(start, span.start)).contains(['\n', '\r']) || before.is_none();
        let following = self.tokens.iter().find(|(_, other)| other.start >= span.end);
        match following.map(|(_, other)| Span::new(span.end, other.start)) {
            Some(gap) if first && !self.text(gap).contains(['\n', '\r']) => self.replace(span.to(gap), ""),
            _ => self.remove(span),
        }
    }

    /// Removes what is on lines of its own together with the end of its line. Whether something else is
    /// before it on its line can change with any edit there, and is looked at when the edit gets its place.
    pub(super) fn remove_line(&self, span: Span) -> ProblemEdit {
        let end = self.len().unwrap_or(span.end);
        let following = self.text(Span::new(span.end, end));
        let blank = following.len() - following.trim_start_matches([' ', '\t']).len();
        let line_end = ["\r\n", "\n", "\r"].into_iter().find(|end| following[blank..].starts_with(end));
        let Some(line_end) = line_end else {
            let start = self.tokens.first().is_some_and(|(_, first)| first.start == span.start);
            let blank = offset(blank);
            return if start {
                self.replace(Span::new(span.start, span.end + blank), "")
            } else {
                self.remove(span)
            };
        };
        let taken = offset(blank + line_end.len());
        self.replace(Span::new(span.start, span.end + taken), "")
    }

    /// Removes one item of a list with the comma before it, or else, of the first item, the one after it.
    pub(super) fn remove_item(&self, item: Span) -> Vec<ProblemEdit> {
        let is_word = |(token, _): &&Token| !token.is_comment();
        let before = self.tokens.iter().rev().filter(is_word).find(|(_, span)| span.end <= item.start);
        let following = self.tokens.iter().filter(is_word).find(|(_, span)| span.start >= item.end);
        let is_comment_between = |comma: Span| {
            self.tokens.iter().any(|(token, span)| {
                token.is_comment() && comma.start <= span.start && span.end <= item.start
            })
        };
        match (before, following) {
            (Some((TokenKind::Comma, comma)), _) if is_comment_between(*comma) => {
                vec![self.replace(*comma, ""), self.remove(item)]
            }
            (Some((TokenKind::Comma, comma)), _) => vec![self.remove(comma.to(item))],
            (Some((TokenKind::OpenBrace, _)), Some((TokenKind::Comma, comma))) => {
                vec![self.remove(item), self.replace(*comma, "")]
            }
            _ => vec![self.remove(item)],
        }
    }

    /// Removes the whole entity, but not the comments after it.
    pub(super) fn whole(&self) -> Option<ProblemEdit> {
        let end = self.len()?;
        let is_word = |(token, _): &Token| !token.is_comment();
        let following = self.tokens.iter().rposition(is_word).map_or(0, |last| last + 1);
        let end = self.tokens.get(following).map_or(end, |(_, comment)| comment.start);
        Some(self.replace(Span::new(0, end), ""))
    }
}

/// The edit that adds a name to a list in braces, which may be in another entity.
pub(super) fn append(entity: EntityId, list: &References, name: &str, separator: &str) -> ProblemEdit {
    let (offset, text) = match list.names.last() {
        Some(last) => (last.span.end, format!("{separator}{}", escape(name))),
        None => (list.span.start + 1, format!(" {} ", escape(name))),
    };
    ProblemEdit::new(entity, Span::at(offset), text)
}

/// A fix with its edits where their entities are now.
pub(super) fn located(facts: &Facts, fix: &ProblemFix) -> Option<Fix> {
    let edits = fix.edits.iter().map(|edit| {
        let entity = if edit.declares { declared_before(facts, edit.entity)? } else { edit.entity };
        let (file, span) = absolute(facts, entity, edit.span)?;
        let span = if edit.text.is_empty() { tidy_removal(facts, file, span) } else { span };
        let text = if edit.joins { edit.text.clone() } else { kept_apart(facts, file, span, &edit.text) };
        Some(Edit { file, span, text: text.replace('\n', facts.line_ending(file)) })
    });
    let mut edits = edits.collect::<Option<Vec<Edit>>>()?;
    edits.extend(fix.renames.iter().flat_map(|renaming| renamed(facts, renaming)));
    Some(Fix { title: fix.title.clone(), safe: fix.safe, edits })
}

/// The edits that give a declaration and all references to it another text.
fn renamed(facts: &Facts, Renaming { declared, kind, name, text }: &Renaming) -> Vec<Edit> {
    let Some(home) = facts.file_of(*declared) else { return Vec::new() };
    let declarations = facts.declarations(home, *kind, name).into_iter();
    let declarations = declarations.map(|span| FileSpan { file: home, span });
    let mut places: Vec<FileSpan> = declarations.chain(facts.references(home, *kind, name)).collect();
    places.sort_unstable();
    let edit = |FileSpan { file, span }| Edit { file, span, text: kept_apart(facts, file, span, text) };
    places.into_iter().map(edit).collect()
}

/// The entity, it or one before it, that a declaration can precede without cutting another one in two: what comes
/// before it is complete, and ends on a line before.
fn declared_before(facts: &Facts, id: EntityId) -> Option<EntityId> {
    /// How far before the entity to look: longer invalid text is no place for a declaration.
    const MAX_SLOTS_BEFORE: usize = 64;
    let entity = facts.entity(id)?;
    let (index, _) = facts.slot_at(entity.file, entity.span.start);
    let slots = facts.slots(entity.file).get(..=index)?;
    let is_free =
        |at: &usize| *at == 0 || slots.get(at - 1).is_some_and(|before| is_over(facts, before.entity));
    let at = (index.saturating_sub(MAX_SLOTS_BEFORE)..=index).rev().find(is_free)?;
    slots.get(at).map(|slot| slot.entity)
}

/// Returns whether an entity is complete, and the next one starts on another line.
fn is_over(facts: &Facts, id: EntityId) -> bool {
    let Some(entity) = facts.entity(id) else { return false };
    let last = entity.parse.tokens.iter().rev().find(|(token, _)| !token.is_comment());
    let Some((_, last)) = last else { return true };
    let rest = facts.slice(entity.file, Span::new(entity.span.start + last.end, entity.span.end));
    let is_import = matches!(entity.parse.entity, Some(Entity::Import(_)));
    (is_import || entity.parse.errors.is_empty()) && rest.contains(['\n', '\r'])
}

/// Returns the span to remove so that the lines around it stay as they are: where something else is before it on its
/// line, the end of that line is not part of it, but the space between the two is.
fn tidy_removal(facts: &Facts, file: FileId, span: Span) -> Span {
    /// Longer white space between two things of one line may stay.
    const FAR: u32 = 256;
    let removed = facts.slice(file, span);
    if !removed.ends_with(['\n', '\r']) || span.start == 0 {
        return span;
    }
    let before = (1..=FAR.min(span.start))
        .map(|back| (back, facts.slice(file, Span::new(span.start - back, span.start - back + 1))));
    let Some((back, text)) = before.into_iter().find(|(_, text)| text != " " && text != "\t") else {
        return span;
    };
    if text == "\n" || text == "\r" {
        return span;
    }
    let trailing = removed.len() - removed.trim_end().len();
    Span::new(span.start + 1 - back, span.end - offset(trailing))
}

/// The text of an edit, with a space where a word in it, or beside a gap it leaves, would run into another one: before
/// `^` or a sign, a number or a name needs none.
fn kept_apart(facts: &Facts, file: FileId, span: Span, text: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let first = |text: &str| text.chars().next().is_some_and(is_word);
    let last = |text: &str| text.chars().next_back().is_some_and(is_word);
    // Texts are cut between characters, and no character is longer than this.
    let beside = |start: u32, end: u32| facts.slice(file, Span::new(start, end));
    let before = (1..=4_u32.min(span.start)).map(|back| beside(span.start - back, span.start));
    let runs_in = before.into_iter().find(|text| !text.is_empty()).is_some_and(|text| last(&text));
    let following = (1..=4).map(|ahead| beside(span.end, span.end + ahead)).find(|text| !text.is_empty());
    let runs_on = following.is_some_and(|text| first(&text));
    let replaced = facts.slice(file, span);
    if text.is_empty() {
        return if runs_in && runs_on { " ".to_owned() } else { String::new() };
    }
    let left = if runs_in && first(text) && !first(&replaced) { " " } else { "" };
    let right = if runs_on && last(text) && !last(&replaced) { " " } else { "" };
    format!("{left}{text}{right}")
}

/// Where a part of an entity is.
pub(super) fn absolute(facts: &Facts, id: EntityId, span: Span) -> Option<(FileId, Span)> {
    let entity = facts.entity(id)?;
    Some((entity.file, span.shifted(entity.span.start)))
}
