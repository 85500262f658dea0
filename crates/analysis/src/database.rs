//! The database: files in, answers out. It keeps true what rules conclude from the [facts](Facts): the problems of all
//! entities and the planned runs. How it changes is in [`change`].

mod batch;
mod change;
#[cfg(test)]
mod counts;
mod dependencies;
mod environments;
mod postponed;
mod problems;
mod scene_run;
mod scenes;

use std::collections::BTreeMap;
use std::ops::Deref;

use pydslrep_syntax::Span;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use self::dependencies::Dependencies;
use self::postponed::Postponed;
use self::problems::Problems;
use self::scene_run::SceneRun;
use crate::diagnostics::{self, EntityProblems, Extent, Rule};
use crate::entity::{EntityId, FileId};
use crate::facts::Facts;
use crate::{Diagnostic, Severity};

/// Documents and everything known about them. A clone shares texts and trees, so that something can be tried on it.
#[derive(Debug, Clone, Default)]
pub struct Database {
    facts: Facts,
    problems: Problems,
    dependencies: Dependencies,
    /// The planned runs of the environments that have a scene, by their names.
    runs: BTreeMap<FileId, BTreeMap<SmolStr, SceneRun>>,
    /// Changes in the number of declarations of an environment's name since they were last read; no entry is 0.
    changed_environments: FxHashMap<(FileId, SmolStr), i32>,
    last_edit: EditCounts,
    /// The files whose diagnostics may have changed since they were last asked for.
    touched: FxHashSet<FileId>,
    /// The files to check once all that come together are open; `None` while each is checked as it comes.
    postponed: Option<Postponed>,
}

/// The cost of the latest edit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EditCounts {
    /// Tokens read again, each as often as it was; also those after the edit that show where its effect ends.
    pub relexed: usize,
    /// Entities read again.
    pub reparsed: usize,
    /// Entities whose problems were looked for again.
    pub revalidated: usize,
}

/// Whatever can be asked of the facts can be asked of the database; they change through it alone.
impl Deref for Database {
    type Target = Facts;

    fn deref(&self) -> &Facts {
        &self.facts
    }
}

impl Database {
    /// An empty database.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the cost of the latest edit (or opening).
    pub fn last_edit(&self) -> EditCounts {
        self.last_edit
    }

    /// Returns the diagnostics of a file, in the order of the text.
    pub fn diagnostics(&self, file: FileId) -> Vec<Diagnostic> {
        self.diagnostics_as_far_as(file, Extent::All)
    }

    /// Returns the diagnostics of a file to be shown, in the order of the text: fixes may be left out, which take most of the
    /// time where there are many.
    pub fn shown_diagnostics(&self, file: FileId) -> Vec<Diagnostic> {
        self.diagnostics_as_far_as(file, Extent::WithoutFixes)
    }

    /// Returns the diagnostics of a file that touch a range, in the order of the text.
    pub fn diagnostics_at(&self, file: FileId, range: Span) -> Vec<Diagnostic> {
        self.diagnostics_as_far_as(file, Extent::Touching(range))
    }

    fn diagnostics_as_far_as(&self, file: FileId, extent: Extent) -> Vec<Diagnostic> {
        let (problems, runs) = (self.problems_in(file), self.planned_runs(file));
        diagnostics::in_file(&self.facts, file, &problems, &runs, extent)
    }

    /// Calls `visit` with the rule, the severity and the start of all [diagnostics](Self::diagnostics) of a file, in no
    /// order; their places and fixes, which take much longer, are not looked for.
    pub(crate) fn visit_diagnostics(&self, file: FileId, visit: impl FnMut(&'static Rule, Severity, u32)) {
        let runs = self.planned_runs(file);
        diagnostics::visit_in_file(&self.facts, file, &self.problems_in(file), &runs, visit);
    }

    /// The files whose diagnostics, or places named in them, may have changed since this was last asked; in the order
    /// of opening. Also files that were closed.
    pub fn take_touched(&mut self) -> Vec<FileId> {
        self.touch_in_scenes();
        let mut touched: Vec<FileId> = std::mem::take(&mut self.touched).into_iter().collect();
        touched.sort_unstable();
        touched
    }

    /// Returns whether [`Self::take_touched`] would return any file.
    pub fn is_touched(&self) -> bool {
        !self.touched.is_empty()
    }

    /// The environments whose names came or went since this was last asked: each by its file and name. Also those of
    /// files that were closed.
    pub fn take_changed_environments(&mut self) -> Vec<(FileId, SmolStr)> {
        let changed = std::mem::take(&mut self.changed_environments);
        let mut changed: Vec<(FileId, SmolStr)> = changed.into_keys().collect();
        changed.sort_unstable();
        changed
    }

    /// Returns the number of entities of a file that have problems.
    pub fn count_with_problems(&self, file: FileId) -> usize {
        self.problems.count(file)
    }

    /// The entities of a file that have problems, with these, in the order of the text.
    fn problems_in(&self, file: FileId) -> Vec<EntityProblems<'_>> {
        let mut located = self.located_problems(self.problems.in_file(file));
        located.sort_unstable_by_key(|located| located.entity.span.start);
        located
    }

    /// Some entities with their problems.
    fn located_problems(&self, ids: impl IntoIterator<Item = EntityId>) -> Vec<EntityProblems<'_>> {
        let located = |id| Some(EntityProblems { entity: self.entity(id)?, problems: self.problems.of(id) });
        ids.into_iter().filter_map(located).collect()
    }
}
