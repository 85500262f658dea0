//! The problems that rules report.

use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

use super::edits::ProblemEdit;
use super::rule::Rule;
use crate::{EntityId, EntityRef, Severity};

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
    /// The kind and the name of a reference that no declaration matches.
    pub(crate) undeclared: Option<(EntityKind, SmolStr)>,
    /// The kinds of entities that could have prevented it by using what it is about.
    pub(crate) users: &'static [EntityKind],
    /// The brace it is about, where another entity may have the other half.
    pub(crate) brace: Option<Brace>,
    pub(crate) fixes: Vec<ProblemFix>,
}

/// An entity with its problems.
pub(crate) struct EntityProblems<'a> {
    pub(crate) entity: EntityRef<'a>,
    pub(crate) problems: &'a [Problem],
}

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
    pub(crate) renames: Option<Renaming>,
}

/// New text for what the checked entity declares, and for all that refers to it, wherever that is then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Renaming {
    pub(crate) declared: EntityId,
    pub(crate) kind: EntityKind,
    pub(crate) name: SmolStr,
    pub(crate) text: String,
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
            undeclared: None,
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

    /// Returns whether a fix renames something wherever it is used.
    pub(crate) fn renames(&self) -> bool {
        self.fixes.iter().any(|fix| fix.renames.is_some())
    }

    /// A fix by another name.
    pub(super) fn renaming(mut self, title: String, safe: bool, renaming: Renaming) -> Self {
        self.fixes.push(ProblemFix { title, safe, edits: Vec::new(), renames: Some(renaming) });
        self
    }

    fn add_fix(mut self, title: String, safe: bool, edits: Vec<ProblemEdit>) -> Self {
        self.fixes.push(ProblemFix { title, safe, edits, renames: None });
        self
    }
}
