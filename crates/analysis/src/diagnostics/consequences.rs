//! Problems that are not reported, because the problem that causes them is.

use pydslrep_syntax::EntityKind;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::problem::{EntityProblems, Problem};
use super::{syntax_error, unresolved_reference, unused_declaration};
use crate::entity::FileId;
use crate::facts::Facts;

/// Decides which problems of a file only follow from others of it, which are reported.
pub(super) struct Consequences<'a> {
    /// A comment that never ends may hide declarations and uses of any name.
    hidden: bool,
    /// The names that misspelt references are suggested to be changed to: they are not reported as unused.
    intended: FxHashSet<&'a (EntityKind, SmolStr)>,
    /// The kinds of entities with syntax errors: such an entity may use any name of the kinds that it can refer to.
    broken: Vec<EntityKind>,
    /// Names without a declaration, where at least as many declarations of their kind lack a name.
    nameless: FxHashSet<&'a (EntityKind, SmolStr)>,
}

impl<'a> Consequences<'a> {
    /// `entities` are those of the file that have problems, which are `problems`.
    pub(super) fn new(
        facts: &Facts,
        file: FileId,
        entities: &[EntityProblems<'_>],
        problems: &[(u32, &'a Problem)],
    ) -> Self {
        let unresolved =
            || problems.iter().filter(|(_, problem)| problem.rule == &unresolved_reference::RULE);
        let slips = unresolved().filter_map(|(_, problem)| problem.about.as_ref());
        let mut consequences = Self {
            hidden: has_hidden_text(facts, file),
            intended: slips.collect(),
            broken: Vec::new(),
            nameless: FxHashSet::default(),
        };
        if problems.iter().any(|(_, problem)| problem.rule == &syntax_error::RULE) {
            consequences.add_broken(entities, problems);
        }
        consequences
    }

    fn add_broken(&mut self, entities: &[EntityProblems<'_>], problems: &[(u32, &'a Problem)]) {
        let mut nameless = Vec::new();
        for parse in entities.iter().map(|found| found.entity.parse) {
            if parse.errors.is_empty() {
                continue;
            }
            let Some((tree, kind)) = parse.entity.as_ref().and_then(|tree| Some((tree, tree.kind()?))) else {
                continue;
            };
            if !self.broken.contains(&kind) {
                self.broken.push(kind);
            }
            if tree.name().is_none() {
                nameless.push(kind);
            }
        }
        for kind in EntityKind::ALL {
            let lacking = nameless.iter().filter(|other| **other == kind).count();
            let mut undeclared: Vec<&(EntityKind, SmolStr)> =
                problems.iter().filter_map(|(_, problem)| problem.undeclared.as_ref()).collect();
            undeclared.retain(|(other, _)| *other == kind);
            undeclared.sort_unstable();
            undeclared.dedup();
            if undeclared.len() <= lacking {
                self.nameless.extend(undeclared);
            }
        }
    }

    pub(super) fn include(&self, problem: &Problem) -> bool {
        if problem.rule == &unused_declaration::RULE {
            let named = problem.about.as_ref().is_some_and(|name| self.intended.contains(name));
            return self.hidden || named || problem.users.iter().any(|kind| self.broken.contains(kind));
        }
        if problem.rule == &unresolved_reference::RULE {
            let named = problem.undeclared.as_ref().is_some_and(|name| self.nameless.contains(name));
            return self.hidden || named;
        }
        false
    }
}

/// Returns whether declarations may be hidden in a comment that never ends.
fn has_hidden_text(facts: &Facts, file: FileId) -> bool {
    std::iter::once(file).chain(facts.imported_files(file)).any(|file| facts.has_open_comment(file))
}
