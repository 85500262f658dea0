//! What a check sees, and what it reports.

use pydslrep_syntax::ast::{Entity, Movement, Name, References, Robot, Wheel};
use pydslrep_syntax::{EntityKind, Span, SyntaxError, Token, TokenKind};
use pydslrep_text::closest_of_any_order;
use smol_str::SmolStr;

pub(crate) use pydslrep_syntax::escape;

use super::Rule;
use super::syntax_error::{self, Rewrite};
use crate::{Database, EntityId, FileId, Resolution, Severity};

/// A problem whose places count from the start of the entities they are in, so that it stays true wherever those
/// move.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Problem {
    pub(crate) rule: &'static Rule,
    pub(crate) severity: Severity,
    pub(crate) span: Span,
    pub(crate) message: String,
    pub(crate) help: Option<String>,
    pub(crate) note: Option<String>,
    pub(crate) related: Vec<ProblemPlace>,
    /// The declaration that the problem is about, where another problem could be about it too.
    pub(crate) about: Option<(EntityKind, SmolStr)>,
    /// The kind and the name that were looked for in vain.
    pub(crate) sought: Option<(EntityKind, SmolStr)>,
    /// The kinds of entities that could have prevented it by using what it is about.
    pub(crate) users: &'static [EntityKind],
    /// What it says of a brace, where another entity may have the other half.
    pub(crate) brace: Option<Brace>,
    pub(crate) fixes: Vec<ProblemFix>,
}

/// What people write within a number or a name, such as `1'000`: what is left on either side of it is one word.
const WITHIN_WORDS: [char; 4] = ['\'', '’', '$', '@'];

/// One half of a pair of braces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Brace {
    /// Nothing closes it.
    Unclosed,
    /// It closes nothing.
    Stray,
}

/// A second place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProblemPlace {
    pub(crate) entity: EntityId,
    pub(crate) span: Span,
    pub(crate) message: String,
}

/// A fix by edits in any entities.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProblemFix {
    pub(crate) title: String,
    pub(crate) safe: bool,
    pub(crate) edits: Vec<ProblemEdit>,
}

/// A replacement of text in one entity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ProblemEdit {
    pub(crate) entity: EntityId,
    pub(crate) span: Span,
    /// With `\n` for the end of a line, whatever the file uses; which it is may change with any edit.
    pub(crate) text: String,
    /// Whether what stands on its sides is to become one word; else words are kept apart.
    pub(crate) joins: bool,
    /// Whether it is a declaration to put before the entity: at the nearest place where no other one is cut in two.
    pub(crate) declares: bool,
}

impl ProblemEdit {
    /// A replacement that keeps words apart.
    pub(super) fn new(entity: EntityId, span: Span, text: impl Into<String>) -> Self {
        Self { entity, span, text: text.into(), joins: false, declares: false }
    }
}

impl Rule {
    /// A problem at `span` of the entity that is checked.
    pub(super) fn problem(&'static self, span: Span, message: impl Into<String>) -> Problem {
        Problem {
            rule: self,
            severity: self.severity,
            span,
            message: message.into(),
            help: None,
            note: None,
            related: Vec::new(),
            about: None,
            sought: None,
            users: &[],
            brace: None,
            fixes: Vec::new(),
        }
    }
}

impl Problem {
    pub(super) fn severity(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub(super) fn note(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }

    pub(super) fn related(mut self, entity: EntityId, span: Span, message: impl Into<String>) -> Self {
        self.related.push(ProblemPlace { entity, span, message: message.into() });
        self
    }

    pub(super) fn about(mut self, kind: EntityKind, name: impl Into<SmolStr>) -> Self {
        self.about = Some((kind, name.into()));
        self
    }

    pub(super) fn sought(mut self, kind: EntityKind, name: &SmolStr) -> Self {
        self.sought = Some((kind, name.clone()));
        self
    }

    pub(super) fn users(mut self, kinds: &'static [EntityKind]) -> Self {
        self.users = kinds;
        self
    }

    pub(super) fn brace(mut self, brace: Brace) -> Self {
        self.brace = Some(brace);
        self
    }

    /// A fix that can be applied without asking.
    pub(super) fn fix(self, title: impl Into<String>, edits: impl Into<Vec<ProblemEdit>>) -> Self {
        self.add_fix(title.into(), true, edits.into())
    }

    /// A fix that is only offered.
    pub(super) fn suggestion(self, title: impl Into<String>, edits: impl Into<Vec<ProblemEdit>>) -> Self {
        self.add_fix(title.into(), false, edits.into())
    }

    fn add_fix(mut self, title: String, safe: bool, edits: Vec<ProblemEdit>) -> Self {
        self.fixes.push(ProblemFix { title, safe, edits });
        self
    }
}

/// The entity that is checked, with the database around it.
pub(super) struct Context<'a> {
    pub(super) database: &'a Database,
    pub(super) file: FileId,
    pub(super) id: EntityId,
    /// `None` for what stands before the first entity.
    pub(super) tree: Option<&'a Entity>,
    pub(super) errors: &'a [SyntaxError],
    pub(super) tokens: &'a [Token],
    /// The statements that are one problem each, whatever their syntax errors are.
    pub(super) rewrites: Vec<Rewrite>,
}

impl<'a> Context<'a> {
    pub(super) fn new(database: &'a Database, id: EntityId) -> Option<Self> {
        let parse = database.parse(id)?;
        let file = database.file_of(id)?;
        let mut context = Self {
            database,
            file,
            id,
            tree: parse.entity.as_ref(),
            errors: &parse.errors,
            tokens: &parse.tokens,
            rewrites: Vec::new(),
        };
        context.rewrites = syntax_error::rewrites(&context);
        Some(context)
    }

    /// Whether a place is in a statement that is one problem as a whole.
    pub(super) fn is_rewritten(&self, span: Span) -> bool {
        self.rewrites.iter().any(|rewrite| rewrite.covers(span))
    }

    /// What a reference in this entity leads to.
    pub(super) fn resolve(&self, kind: EntityKind, name: &Name) -> Resolution {
        self.database.resolve(self.file, kind, &name.text)
    }

    /// The wheel a reference leads to.
    pub(super) fn wheel(&self, name: &Name) -> Option<(EntityId, &'a Wheel)> {
        let id = self.resolve(EntityKind::Wheel, name).entity()?;
        match self.database.tree(id)? {
            Entity::Wheel(wheel) => Some((id, wheel)),
            _ => None,
        }
    }

    /// The robot a reference leads to.
    pub(super) fn robot(&self, name: &Name) -> Option<(EntityId, &'a Robot)> {
        let id = self.resolve(EntityKind::Robot, name).entity()?;
        match self.database.tree(id)? {
            Entity::Robot(robot) => Some((id, robot)),
            _ => None,
        }
    }

    /// Whether an entity was read without a syntax error, so that others may conclude something from what it lacks.
    pub(super) fn is_sound(&self, id: EntityId) -> bool {
        self.database.parse(id).is_some_and(|parse| parse.errors.is_empty())
    }

    /// The movement a reference leads to.
    pub(super) fn movement(&self, name: &Name) -> Option<(EntityId, &'a Movement)> {
        let id = self.resolve(EntityKind::Movement, name).entity()?;
        match self.database.tree(id)? {
            Entity::Movement(movement) => Some((id, movement)),
            _ => None,
        }
    }

    /// The robot of a movement that may stand in another file.
    pub(super) fn robot_of(&self, id: EntityId, movement: &Movement) -> Option<EntityId> {
        let file = self.database.file_of(id)?;
        self.database.resolve(file, EntityKind::Robot, &movement.robot.as_ref()?.text).entity()
    }

    /// The text of a range of this entity.
    pub(super) fn text(&self, span: Span) -> String {
        self.place()
            .map_or_else(String::new, |place| self.database.slice(self.file, span.shifted(place.start)))
    }

    /// Where the entity stands in its file.
    fn place(&self) -> Option<Span> {
        self.database.entity(self.id).map(|entity| entity.span)
    }

    /// A replacement of text in this entity.
    pub(super) fn replace(&self, span: Span, text: impl Into<String>) -> ProblemEdit {
        ProblemEdit::new(self.id, span, text)
    }

    /// A replacement that makes one word of what stands on its sides.
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
            Some((token, comment)) if token.ends_line() => self.remove_behind(*comment, span),
            Some((_, other)) => self.replace(Span::new(other.end, span.end), ""),
            None => self.replace(span, ""),
        }
    }

    /// Removes what a comment of the line before stands before: with its line, or as far as the line goes on.
    fn remove_behind(&self, comment: Span, span: Span) -> ProblemEdit {
        let rest = self.place().map_or(span.end, Span::len);
        let next = self.tokens.iter().find(|(_, other)| other.start >= span.end);
        let next = next.map_or(rest, |(_, other)| other.start);
        let gap = self.text(Span::new(comment.end, span.start));
        let last_line = gap.rfind(['\n', '\r']).map_or(0, |end| end + 1);
        let behind = self.text(Span::new(span.end, next));
        match behind.find(['\n', '\r']) {
            Some(end) => {
                let end = end + if behind[end..].starts_with("\r\n") { 2 } else { 1 };
                let length = |bytes: usize| u32::try_from(bytes).unwrap_or_default();
                self.replace(Span::new(comment.end + length(last_line), span.end + length(end)), "")
            }
            None => self.replace(Span::new(span.start, next), ""),
        }
    }

    /// Removes characters, with one space where they have one on both sides.
    pub(super) fn remove_character(&self, span: Span) -> ProblemEdit {
        let end = self.place().map_or(span.end, Span::len);
        let blank = |span: Span| [" ", "\t"].contains(&self.text(span).as_str());
        let before = span.start > 0 && blank(Span::new(span.start - 1, span.start));
        let behind = self.text(Span::new(span.end, end.min(span.end + 1)));
        if before && (behind.is_empty() || behind.starts_with(char::is_whitespace)) {
            return self.replace(Span::new(span.start - 1, span.end), "");
        }
        let first = span.start == 0 && behind.starts_with(' ');
        if self.text(span).contains(WITHIN_WORDS) {
            return self.join(span, "");
        }
        self.replace(Span::new(span.start, span.end + u32::from(first)), "")
    }

    /// Removes a word; what stands on other lines stays there.
    pub(super) fn remove_word(&self, span: Span) -> ProblemEdit {
        let before = self.tokens.iter().rev().find(|(_, other)| other.end <= span.start);
        let start = before.map_or(0, |(_, other)| other.end);
        let first = self.text(Span::new(start, span.start)).contains(['\n', '\r']) || before.is_none();
        let behind = self.tokens.iter().find(|(_, other)| other.start >= span.end);
        match behind.map(|(_, other)| Span::new(span.end, other.start)) {
            Some(gap) if first && !self.text(gap).contains(['\n', '\r']) => self.replace(span.to(gap), ""),
            _ => self.remove(span),
        }
    }

    /// Removes what stands on lines of its own together with the end of its line. Whether something else stands
    /// before it on its line can change with any edit there, and is looked at when the edit gets its place.
    pub(super) fn remove_line(&self, span: Span) -> ProblemEdit {
        let end = self.place().map_or(span.end, Span::len);
        let behind = self.text(Span::new(span.end, end));
        let blank = behind.len() - behind.trim_start_matches([' ', '\t']).len();
        let line_end = ["\r\n", "\n", "\r"].into_iter().find(|end| behind[blank..].starts_with(end));
        let Some(line_end) = line_end else {
            let start = self.tokens.first().is_some_and(|(_, first)| first.start == span.start);
            let blank = u32::try_from(blank).unwrap_or_default();
            return if start {
                self.replace(Span::new(span.start, span.end + blank), "")
            } else {
                self.remove(span)
            };
        };
        let taken = u32::try_from(blank + line_end.len()).unwrap_or_default();
        self.replace(Span::new(span.start, span.end + taken), "")
    }

    /// Removes one item of a list with the comma before it, or else, of the first item, the one behind it.
    pub(super) fn remove_item(&self, item: Span) -> Vec<ProblemEdit> {
        let is_word = |(token, _): &&Token| !token.is_comment();
        let before = self.tokens.iter().rev().filter(is_word).find(|(_, span)| span.end <= item.start);
        let behind = self.tokens.iter().filter(is_word).find(|(_, span)| span.start >= item.end);
        let is_comment_between = |comma: Span| {
            self.tokens.iter().any(|(token, span)| {
                token.is_comment() && comma.start <= span.start && span.end <= item.start
            })
        };
        match (before, behind) {
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

    /// Removes the whole entity, but not the comments behind it.
    pub(super) fn whole(&self) -> Option<ProblemEdit> {
        let end = self.place()?.len();
        let is_word = |(token, _): &Token| !token.is_comment();
        let behind = self.tokens.iter().rposition(is_word).map_or(0, |last| last + 1);
        let end = self.tokens.get(behind).map_or(end, |(_, comment)| comment.start);
        Some(self.replace(Span::new(0, end), ""))
    }

    /// The visible name of a kind that `name` is most likely a slip for: a near one, else the only one there is. None of
    /// those `taken` already.
    pub(super) fn nearest(&self, kind: EntityKind, name: &Name, taken: &[&str]) -> Option<SmolStr> {
        let names = || self.database.names_in_sight(self.file, kind);
        let free = names().map(SmolStr::as_str).filter(|other| !taken.contains(other));
        let near = closest_of_any_order(&name.text, free).map(SmolStr::new);
        near.or_else(|| {
            let first = names().next().filter(|first| !taken.contains(&first.as_str()))?;
            names().all(|other| other == first).then(|| first.clone())
        })
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
