//! What a rule is: a row of the catalogue.

use std::sync::Arc;

use super::context::Context;
use super::planned_run::PlannedRun;
use super::problem::Problem;
use crate::{Diagnostic, Facts, FileId, Severity};

/// A row of the catalogue.
#[derive(Debug)]
pub struct Rule {
    /// Its stable name.
    pub code: &'static str,
    /// Its usual severity.
    pub severity: Severity,
    /// A summary of what it finds, in one sentence.
    pub summary: &'static str,
    /// The way in which an editor may show the text it is about.
    pub tag: Option<Tag>,
    /// The best fix it may offer.
    pub applicability: Applicability,
    /// The manual page, which says more than its messages.
    pub page: Page,
    pub(super) checks: Checks,
}

impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.code == other.code
    }
}

/// What a rule looks at: most look at one entity after the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Checks {
    /// Finds the problems of an entity.
    pub(super) entity: Option<fn(&Context<'_>, &mut Vec<Problem>)>,
    /// Finds the problem of a whole file.
    pub(super) file: Option<fn(&Facts, FileId) -> Option<Diagnostic>>,
    /// Finds the problems that the actions of a file have in the planned runs of its environments.
    pub(super) runs: Option<CheckRuns>,
}

type CheckRuns = fn(&Facts, FileId, &[Arc<PlannedRun>]) -> Vec<Diagnostic>;

impl Checks {
    pub(super) const fn of_entity(check: fn(&Context<'_>, &mut Vec<Problem>)) -> Self {
        Self { entity: Some(check), file: None, runs: None }
    }

    pub(super) const fn of_file(check: fn(&Facts, FileId) -> Option<Diagnostic>) -> Self {
        Self { entity: None, file: Some(check), runs: None }
    }

    pub(super) const fn of_runs(check: CheckRuns) -> Self {
        Self { entity: None, file: None, runs: Some(check) }
    }

    pub(super) const fn and_runs(self, check: CheckRuns) -> Self {
        Self { runs: Some(check), ..self }
    }
}

/// A way to show text besides underlining it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tag {
    /// It does nothing; shown faded.
    Unnecessary,
    /// An older spelling; shown struck through.
    Deprecated,
}

/// The manual page of a rule, for a person who wants to know more than its message says.
#[derive(Debug)]
pub struct Page {
    /// A description of what the rule finds.
    pub what: &'static str,
    /// Why that matters.
    pub why: &'static str,
    /// The files that the two programs import, or their scenes: names and texts.
    pub imports: &'static [(&'static str, &'static str)],
    /// A program with this problem, once, and with no other.
    pub example: &'static str,
    /// The corrected program, without any problem.
    pub fixed: &'static str,
}

/// The best fix that a rule may offer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Applicability {
    /// None: only the author knows the intention.
    Never,
    /// One that a person should look at first.
    Suggested,
    /// One that can be applied without asking.
    Safe,
}

impl Applicability {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Never => "no",
            Self::Suggested => "suggested",
            Self::Safe => "safe",
        }
    }
}
