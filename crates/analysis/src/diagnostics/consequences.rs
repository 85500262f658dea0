//! Problems that nobody has to hear of, because the one they follow from is reported.

use pydslrep_syntax::EntityKind;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::problem::Problem;
use super::{syntax_error, unresolved_reference, unused_declaration};
use crate::{Database, EntityId, FileId};

/// Problems that only follow from others of the file, which are reported.
pub(super) struct Consequences<'a> {
    /// Text that may declare or use anything is hidden in a comment.
    hidden: bool,
    /// The names that misspelt references were meant to be: they are not reported as unused.
    meant: FxHashSet<&'a (EntityKind, SmolStr)>,
    /// The kinds of entities that did not read well: they may use anything of the kinds below them.
    broken: Vec<EntityKind>,
    /// The names nobody declares, where as many declarations of their kind lack a name.
    nameless: FxHashSet<&'a (EntityKind, SmolStr)>,
}

impl<'a> Consequences<'a> {
    /// `troubled` are the entities that have problems.
    pub(super) fn new(
        database: &Database,
        file: FileId,
        troubled: &[EntityId],
        problems: &[(u32, &'a Problem)],
    ) -> Self {
        let unresolved =
            || problems.iter().filter(|(_, problem)| problem.rule == &unresolved_reference::RULE);
        let slips = unresolved().filter_map(|(_, problem)| problem.about.as_ref());
        let mut consequences = Self {
            hidden: has_hidden_text(database, file),
            meant: slips.collect(),
            broken: Vec::new(),
            nameless: FxHashSet::default(),
        };
        if problems.iter().any(|(_, problem)| problem.rule == &syntax_error::RULE) {
            consequences.look_at_broken(database, troubled, problems);
        }
        consequences
    }

    fn look_at_broken(
        &mut self,
        database: &Database,
        troubled: &[EntityId],
        problems: &[(u32, &'a Problem)],
    ) {
        let mut nameless = Vec::new();
        for id in troubled {
            let Some(parse) = database.parse(*id).filter(|parse| !parse.errors.is_empty()) else {
                continue;
            };
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
            let mut sought: Vec<&(EntityKind, SmolStr)> =
                problems.iter().filter_map(|(_, problem)| problem.sought.as_ref()).collect();
            sought.retain(|(sought, _)| *sought == kind);
            sought.sort_unstable();
            sought.dedup();
            if sought.len() <= lacking {
                self.nameless.extend(sought);
            }
        }
    }

    pub(super) fn include(&self, problem: &Problem) -> bool {
        if problem.rule == &unused_declaration::RULE {
            let named = problem.about.as_ref().is_some_and(|meant| self.meant.contains(meant));
            return self.hidden || named || problem.users.iter().any(|kind| self.broken.contains(kind));
        }
        if problem.rule == &unresolved_reference::RULE {
            let named = problem.sought.as_ref().is_some_and(|sought| self.nameless.contains(sought));
            return self.hidden || named;
        }
        false
    }
}

/// Returns whether declarations may be hidden in a comment that never ends.
fn has_hidden_text(database: &Database, file: FileId) -> bool {
    std::iter::once(file).chain(database.imported_files(file)).any(|file| database.has_open_comment(file))
}
