//! Changes of the database: what follows from an edit for the problems of entities.

use std::collections::hash_map::Entry;
use std::hash::Hash;
use std::sync::Arc;

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Parse, Span};
use ropey::Rope;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::{Database, EditCounts};
use crate::entity::{EntityId, FileId};
use crate::facts::file::fit;
use crate::facts::keys::{Key, defined_key, hidden_keys, used_keys, visible_keys};
use crate::facts::{Absence, Edited};
use crate::reads::Kinds;
use crate::signature::Signature;
use crate::summary::Summary;
use crate::{Edition, Target, diagnostics};

impl Database {
    /// Opens a file, or replaces its text if it is open.
    pub fn open(&mut self, path: &str, text: &str) -> FileId {
        self.open_rope(path, Rope::from_str(text))
    }

    /// As [`Database::open`], by a caller that has the text as a rope. It is kept, not copied, so that a text has one
    /// owner.
    pub fn open_rope(&mut self, path: &str, text: Rope) -> FileId {
        let file = self.facts.file_for(path);
        self.clear(file);
        let edited = self.facts.open(file, path, text);
        self.start_edit(file, &edited);
        self.check_with_importers(path);
        self.check_imported(file, edited.imports_before.as_deref().unwrap_or_default());
        file
    }

    /// Forgets a file.
    pub fn close(&mut self, file: FileId) {
        if self.text(file).is_none() {
            return;
        }
        let path = self.path(file).to_owned();
        self.touch(file);
        self.clear(file);
        let imports_before = self.facts.close(file);
        self.check_with_importers(&path);
        self.check_imported(file, &imports_before);
    }

    /// Replaces a range of bytes. A range that does not fit the text, or that cuts a character in two, is moved back
    /// to where it does.
    pub fn edit(&mut self, file: FileId, span: Span, text: &str) {
        let Some(open) = self.text(file) else { return };
        let span = fit(open, span);
        let mut after = open.clone();
        let start = after.byte_to_char(span.start as usize);
        after.remove(start..after.byte_to_char(span.end as usize));
        after.insert(start, text);
        self.edit_to(file, span, after);
    }

    /// As [`Database::edit`], by a caller that has edited the text already: `after` is the whole text, in which only
    /// `span` is replaced. It is kept, not copied.
    pub fn edit_to(&mut self, file: FileId, span: Span, after: Rope) {
        let Some(edited) = self.facts.edit(file, span, after) else { return };
        self.start_edit(file, &edited);
        let mut invalidated = self.invalidated(file, &edited);
        if let Some(before) = &edited.imports_before {
            let path = self.path(file).to_owned();
            self.check_with_importers(&path);
            self.check_imported(file, before);
        } else if edited.had_environments != (self.count(file, EntityKind::Environment) > 0) {
            // Unused declarations are only looked for where something could be used.
            self.check_file(file);
        }
        if self.moves_imports(&edited) {
            // An import that comes too late, and the place where it belongs, depend on the text before it.
            invalidated.entities.extend(self.facts.import_entities(file));
        }
        invalidated.entities.extend(edited.after);
        self.check_invalidated(invalidated);
    }

    /// Makes the scripts of a file for another target from now on; some rules depend on it.
    pub fn set_target(&mut self, file: FileId, target: Target) {
        if self.facts.set_target(file, target) {
            self.check_file(file);
        }
    }

    /// Allows a file the statements of another edition from now on.
    pub fn set_edition(&mut self, file: FileId, edition: Edition) {
        if self.facts.set_edition(file, edition) {
            self.check_file(file);
        }
    }

    /// Says why a path that a file imports leads nowhere, or (`None`) that nothing is known against it. It is kept
    /// until a file of that path is opened or the importing one closed; only [`Absence::Outside`] outlives the
    /// former.
    pub fn set_absence(&mut self, importer: FileId, path: &str, absence: Option<Absence>) {
        if !self.facts.set_absence(importer, path, absence) {
            return;
        }
        let importer = self.path(importer).to_owned();
        self.check_with_importers(&importer);
        if let Some(imported) = self.file(path) {
            self.check_file(imported);
        }
    }

    fn start_edit(&mut self, file: FileId, edited: &Edited) {
        self.last_edit = EditCounts { relexed: edited.relexed, reparsed: edited.reparsed, revalidated: 0 };
        self.touch(file);
        self.note_environments(file, edited);
    }

    /// The text of a file changed: so may the places in it that its own diagnostics name, and those of the files that
    /// import it; and places at which what it imports would be renamed.
    fn touch(&mut self, file: FileId) {
        let facts = &self.facts;
        self.touched.insert(file);
        self.touched.extend(facts.importers(facts.path(file)));
        self.touched
            .extend(facts.imported_files(file).filter(|imported| self.problems.any_renames(*imported)));
    }

    /// Removes all entities of a file, before another text takes as much memory as they do.
    fn clear(&mut self, file: FileId) {
        let before = self.facts.clear(file);
        self.note_gone_environments(file, &before);
        self.forget(file, &before);
    }

    /// Keeps account of the environments that come and go with a declaration of theirs.
    fn note_environments(&mut self, file: FileId, edited: &Edited) {
        self.note_gone_environments(file, &edited.before);
        for parse in edited.after.iter().filter_map(|id| self.facts.parse(*id)) {
            count_environment(&mut self.changed_environments, defined_key(file, parse), 1);
        }
    }

    fn note_gone_environments(&mut self, file: FileId, gone: &[(EntityId, Arc<Parse>)]) {
        for (_, parse) in gone {
            count_environment(&mut self.changed_environments, defined_key(file, parse), -1);
        }
    }

    /// What an edit invalidates, beside the entities that it brought.
    fn invalidated(&mut self, file: FileId, edited: &Edited) -> Invalidated {
        let mut invalidated = Invalidated::default();
        if edited.is_update {
            for (id, before) in &edited.before {
                self.compare(file, *id, before, &mut invalidated);
            }
            return invalidated;
        }
        for (id, before) in &edited.before {
            invalidated.add_entity(file, before);
            let readers = self.dependencies.readers(*id).iter();
            invalidated.entities.extend(readers.chain(self.dependencies.summary_readers(*id)));
        }
        for parse in edited.after.iter().filter_map(|id| self.facts.parse(*id)) {
            invalidated.add_entity(file, parse);
        }
        self.forget(file, &edited.before);
        invalidated
    }

    /// What is invalidated by an entity that was read anew.
    fn compare(&self, file: FileId, id: EntityId, before: &Parse, invalidated: &mut Invalidated) {
        let Some(after) = self.facts.parse(id) else { return };
        invalidated.uses.extend(only_in_one(used_keys(file, before), used_keys(file, after)));
        let (hidden, hidden_now) = (before.skipped_names.iter(), after.skipped_names.iter());
        invalidated.names.extend(hidden_keys(file, only_in_one(hidden, hidden_now)));
        let (name, name_now) = (defined_key(file, before), defined_key(file, after));
        if name != name_now {
            invalidated.names.extend(name.into_iter().chain(name_now));
        }
        let readers = self.dependencies.readers(id);
        if !readers.is_empty() && Signature::of(before) != Signature::of(after) {
            invalidated.entities.extend(readers);
        }
        let readers = self.dependencies.summary_readers(id);
        let summary = |parse: &Parse| parse.entity.as_ref().and_then(Summary::of);
        if !readers.is_empty() && summary(before) != summary(after) {
            invalidated.entities.extend(readers);
        }
    }

    /// Returns whether an edit changes which of the entities at its place are imports.
    fn moves_imports(&self, edited: &Edited) -> bool {
        let is_import = |tree: Option<&Entity>| tree.map(|tree| matches!(tree, Entity::Import(_)));
        let before = edited.before.iter().map(|(_, parse)| is_import(parse.entity.as_ref()));
        before.ne(edited.after.iter().map(|id| is_import(self.tree(*id))))
    }

    /// Forgets what is known about entities that are gone.
    fn forget(&mut self, file: FileId, gone: &[(EntityId, Arc<Parse>)]) {
        for (id, _) in gone {
            self.dependencies.remove(*id);
            self.problems.set(*id, file, Vec::new());
        }
    }

    fn check_invalidated(&mut self, invalidated: Invalidated) {
        let Invalidated { mut entities, names, uses } = invalidated;
        let kinds = names.iter().fold(Kinds::default(), |kinds, (_, kind, _)| kinds.with(*kind));
        entities.extend(self.dependencies.readers_of_kinds(kinds));
        for key in &names {
            entities.extend(self.dependents(key));
        }
        for key in &uses {
            self.add_concerned_by_uses(key, &mut entities);
        }
        for id in entities {
            self.check(id);
        }
    }

    /// Adds the entities to check again when `entities`, which are checked anyway, use a name more or less than before:
    /// those that declare it, because nothing may use it now. Those that use it ask only whether others do, too, which
    /// two that go on using it answer; so in a long file an edit in one of many users does not ask the rest. Nobody else
    /// asks for the users of a name.
    fn add_concerned_by_uses(&self, key: &Key, entities: &mut FxHashSet<EntityId>) {
        let (file, kind, name) = key;
        let mut others = self.users(*file, *kind, name).iter().filter(|user| !entities.contains(user));
        let first = others.next();
        if others.any(|user| Some(user) != first) {
            entities.extend(self.definitions(*file, *kind, name));
        } else {
            entities.extend(self.facts.mentions(key));
        }
    }

    /// Returns the entities to check again when the meaning of a name changes: all that declare it, use it or looked it
    /// up, here and in the files that import this one.
    fn dependents(&self, key: &Key) -> Vec<EntityId> {
        let (file, kind, name) = key;
        let mut ids: Vec<EntityId> = self.mentions(key).collect();
        for importer in self.importers(self.path(*file)) {
            ids.extend(self.mentions(&(importer, *kind, name.clone())));
        }
        if *kind == EntityKind::Environment {
            // Two environments whose names differ by case only cannot both have a script of their name.
            let twins = self.environments_but_for_case(*file, name).iter();
            ids.extend(twins.flat_map(|other| self.definitions(*file, *kind, other)));
        }
        ids
    }

    /// The entities that declare a name, use it or looked it up.
    fn mentions(&self, key: &Key) -> impl Iterator<Item = EntityId> {
        self.facts.mentions(key).chain(self.dependencies.readers_of_name(key))
    }

    /// Finds the problems of an entity anew.
    pub(super) fn check(&mut self, id: EntityId) {
        let Some(file) = self.file_of(id) else { return };
        let (problems, reads) = diagnostics::in_entity(&self.facts, id);
        self.dependencies.set_reads(id, reads);
        self.problems.set(id, file, problems);
        self.touched.insert(file);
        self.last_edit.revalidated += 1;
    }
}

/// Keeps account of environments that come (1) or go (-1) with a declaration of theirs.
fn count_environment(changed: &mut FxHashMap<(FileId, SmolStr), i32>, declared: Option<Key>, by: i32) {
    let Some((file, EntityKind::Environment, name)) = declared else { return };
    match changed.entry((file, name)) {
        Entry::Occupied(entry) if *entry.get() + by == 0 => {
            entry.remove();
        }
        Entry::Occupied(mut entry) => *entry.get_mut() += by,
        Entry::Vacant(entry) => {
            entry.insert(by);
        }
    }
}

/// The entities and names that an edit invalidates.
#[derive(Debug, Default)]
struct Invalidated {
    entities: FxHashSet<EntityId>,
    /// Names whose meaning changed.
    names: Vec<Key>,
    /// Names that are used more, less or otherwise than before.
    uses: Vec<Key>,
}

impl Invalidated {
    /// Adds the names of an entity that came or went.
    fn add_entity(&mut self, file: FileId, parse: &Parse) {
        self.names.extend(visible_keys(file, parse));
        self.uses.extend(used_keys(file, parse));
    }
}

/// Returns the items that one of two lists has and the other has not, or less often.
fn only_in_one<T: Eq + Hash>(
    before: impl Iterator<Item = T>,
    after: impl Iterator<Item = T>,
) -> impl Iterator<Item = T> {
    let mut more: FxHashMap<T, i32> = FxHashMap::default();
    for item in before {
        *more.entry(item).or_default() += 1;
    }
    for item in after {
        *more.entry(item).or_default() -= 1;
    }
    more.into_iter().filter(|(_, more)| *more != 0).map(|(item, _)| item)
}
