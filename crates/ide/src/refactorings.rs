//! Refactorings: other ways to write what a program says, offered where the cursor or the selection is.

mod actions;
mod drive_type;
mod extract;
mod parallel;
mod speed;
mod units;

#[cfg(test)]
mod testing;

use pydslrep_analysis::{Database, Edit, EntityRef, FileId};
use pydslrep_syntax::Span;

/// What kind of change it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefactoringKind {
    /// A part becomes a declaration of its own.
    Extract,
    /// What is said once for all is left out.
    Inline,
    /// The same in other words.
    Rewrite,
}

/// A change that is offered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refactoring {
    /// What it does, as an order.
    pub title: String,
    /// What kind of change it is.
    pub kind: RefactoringKind,
    /// The edits, apart from each other; or why it cannot be done here.
    pub edits: Result<Vec<Edit>, String>,
}

impl Refactoring {
    fn new(title: impl Into<String>, kind: RefactoringKind, edits: Vec<Edit>) -> Self {
        Self { title: title.into(), kind, edits: Ok(edits) }
    }

    fn refused(title: impl Into<String>, kind: RefactoringKind, reason: impl Into<String>) -> Self {
        Self { title: title.into(), kind, edits: Err(reason.into()) }
    }
}

/// What can be done with what a selection (or a cursor: an empty one) touches.
pub fn refactorings(database: &Database, file: FileId, range: Span) -> Vec<Refactoring> {
    let mut found = Vec::new();
    if let Some(place) = Place::find(database, file, range) {
        found.extend(units::convert(&place));
        found.extend(speed::spell(&place));
        found.extend(extract::extract(&place));
        found.extend(parallel::change(&place));
        found.extend(drive_type::add(&place));
    }
    found
}

/// The entity that a selection is about; it has no syntax errors.
#[derive(Clone, Copy)]
struct Place<'a> {
    database: &'a Database,
    file: FileId,
    entity: EntityRef<'a>,
    /// The selection, from the start of the entity.
    range: Span,
}

impl<'a> Place<'a> {
    fn find(database: &'a Database, file: FileId, range: Span) -> Option<Self> {
        let before = range.start.checked_sub(1).and_then(|offset| database.entity_at(file, offset));
        let at = database.entity_at(file, range.start);
        let touched = |entity: &EntityRef<'a>| {
            let body = crate::cursor::body(entity);
            body.start <= range.end && range.start <= body.end
        };
        let entity = at.into_iter().chain(before).find(touched)?;
        let from = |offset: u32| offset.clamp(entity.span.start, entity.span.end) - entity.span.start;
        let range = Span::new(from(range.start), from(range.end));
        entity.parse.errors.is_empty().then_some(Self { database, file, entity, range })
    }

    /// Whether something in the entity touches the selection.
    fn touches(&self, span: Span) -> bool {
        span.start <= self.range.end && self.range.start <= span.end
    }

    /// The text of a part of the entity.
    fn text(&self, span: Span) -> String {
        self.database.slice(self.file, span.shifted(self.entity.span.start))
    }

    /// An edit of the entity.
    fn edit(&self, span: Span, text: impl Into<String>) -> Edit {
        Edit { file: self.file, span: span.shifted(self.entity.span.start), text: text.into() }
    }
}
