//! Changes of the database: the entities that an edit replaces, and those whose problems it invalidates.

use std::hash::Hash;
use std::ops::Range;
use std::sync::Arc;

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Parse, Span, Token, parse_each};
use ropey::Rope;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;
use smol_str::SmolStr;

use super::scenes::count_environment;
use super::{Database, EditCounts, EntityData, EntityId, FileId};
use crate::diagnostics::{self, Problem};
use crate::file::{File, Window};
use crate::names::Key;
use crate::reads::{Kinds, Reads};
use crate::signature::Signature;
use crate::slots::{EntitySlot, EntitySlots};
use crate::summary::Summary;
use crate::{Edition, Target};

/// The space between the orders of two neighbours in a fresh file.
const ORDER_STEP: u64 = 1 << 32;

impl Database {
    /// Opens a file, or replaces its text if it is open.
    pub fn open(&mut self, path: &str, text: &str) -> FileId {
        self.open_rope(path, Rope::from_str(text))
    }

    /// As [`Database::open`], by a caller that has the text as a rope. It is kept, not copied, so that a text has one
    /// owner.
    pub fn open_rope(&mut self, path: &str, text: Rope) -> FileId {
        let file = self.file_for(path);
        self.forget(file);
        let whole = text.to_string();
        self.files[file.0 as usize] =
            Some(File { path: path.to_owned(), text, slots: EntitySlots::default() });
        let before = self.imports(file).to_vec();
        let (mut slots, mut relexed) = (Vec::new(), 0);
        parse_each(&whole, |span, parse| {
            let order = (slots.len() as u64 + 1) * ORDER_STEP;
            relexed += parse.tokens.len();
            slots.push(self.add(file, span, parse, order));
        });
        self.last_edit = EditCounts { relexed, reparsed: slots.len(), revalidated: 0 };
        self.set_pieces(file, slots);
        self.touch(file);
        self.update_imports(file);
        self.absences.remove_path(path);
        self.validate_with_importers(path);
        self.validate_imported(file, &before);
        file
    }

    /// Forgets a file.
    pub fn close(&mut self, file: FileId) {
        if self.get(file).is_none() {
            return;
        }
        self.forget(file);
        let before = self.forget_imports(file);
        self.touch(file);
        self.absences.remove_importer(file);
        if let Some(closed) = self.files[file.0 as usize].take() {
            self.validate_with_importers(&closed.path);
        }
        self.validate_imported(file, &before);
    }

    /// Replaces a range of bytes. A range that does not fit the text, or that cuts a character in two, is moved back
    /// to where it does.
    pub fn edit(&mut self, file: FileId, span: Span, text: &str) {
        let Some(open) = self.get(file) else { return };
        let span = fit(&open.text, span);
        let mut after = open.text.clone();
        let start = after.byte_to_char(span.start as usize);
        after.remove(start..after.byte_to_char(span.end as usize));
        after.insert(start, text);
        self.edit_to(file, span, after);
    }

    /// As [`Database::edit`], by a caller that has edited the text already: `after` is the whole text, in which only
    /// `span` is replaced. It is kept, not copied.
    pub fn edit_to(&mut self, file: FileId, span: Span, after: Rope) {
        let entities = &self.entities;
        let tokens = |id: EntityId| -> &[Token] {
            entities[id.0 as usize].as_ref().map_or(&[], |data| &data.parse.tokens)
        };
        let Some(open) = self.files.get_mut(file.0 as usize).and_then(Option::as_mut) else { return };
        let window = open.edit(fit(&open.text, span), after, tokens);
        self.touch(file);
        self.apply(file, window);
    }

    fn file_for(&mut self, path: &str) -> FileId {
        if let Some(known) = self.by_path.get(path) {
            return *known;
        }
        let file = FileId(u32::try_from(self.files.len()).unwrap_or(u32::MAX));
        self.files.push(None);
        self.by_path.insert(path.to_owned(), file);
        file
    }

    /// Removes all entities of a file.
    fn forget(&mut self, file: FileId) {
        let slots = self.files[file.0 as usize].as_mut().map(|file| std::mem::take(&mut file.slots));
        for slot in slots.unwrap_or_default().iter() {
            self.remove(slot.entity);
        }
    }

    fn set_pieces(&mut self, file: FileId, slots: Vec<EntitySlot>) {
        if let Some(open) = self.files[file.0 as usize].as_mut() {
            open.slots = slots.into();
        }
    }

    fn apply(&mut self, file: FileId, window: Window) {
        self.last_edit =
            EditCounts { relexed: window.relexed, reparsed: window.parses.len(), revalidated: 0 };
        let Window { replaced, parses, .. } = self.without_unchanged_ends(file, window);
        let old: Vec<EntityId> = self.slots(file)[replaced.clone()].iter().map(|slot| slot.entity).collect();
        let had_imports = self.any_import(&old);
        let imports_before = self.which_are_imports(&old);
        let had_environments = self.count(file, EntityKind::Environment) > 0;
        let mut invalidated = Invalidated::default();
        let new: Vec<EntitySlot> = if old.len() == parses.len() {
            old.iter().zip(parses).map(|(id, parsed)| self.update(*id, parsed, &mut invalidated)).collect()
        } else {
            self.exchange(file, &replaced, parses, &mut invalidated)
        };
        let ids: Vec<EntityId> = new.iter().map(|slot| slot.entity).collect();
        if let Some(open) = self.files[file.0 as usize].as_mut() {
            open.slots.replace(replaced, new);
        }
        let has_environments = self.count(file, EntityKind::Environment) > 0;
        if had_imports || self.any_import(&ids) {
            let before = self.imports(file).to_vec();
            self.update_imports(file);
            let path = self.path(file).to_owned();
            self.validate_with_importers(&path);
            self.validate_imported(file, &before);
        } else if had_environments != has_environments {
            // Unused declarations are only looked for where something could be used.
            self.validate_file(file);
        }
        if let Some(imports) = self.imports.get(&file)
            && self.which_are_imports(&ids) != imports_before
        {
            // An import that comes too late, and the place where it belongs, depend on the text before it.
            invalidated.entities.extend(&imports.entities);
        }
        invalidated.entities.extend(ids);
        self.validate_invalidated(invalidated);
    }

    /// Slots at either end of a window that the edit did not touch and that read as before keep their entities and
    /// all their answers.
    fn without_unchanged_ends(&self, file: FileId, window: Window) -> Window {
        let Window { replaced, untouched, relexed, mut parses } = window;
        let old = &self.slots(file)[replaced.clone()];
        let same = |(slot, (span, parse)): &(&EntitySlot, &(Span, Parse))| {
            slot.len == span.len() && self.data(slot.entity).is_some_and(|data| *data.parse == *parse)
        };
        let head = old.iter().zip(&parses).take(untouched.0).take_while(same).count();
        let (old, rest) = (&old[head..], &parses[head..]);
        let tail = old.iter().rev().zip(rest.iter().rev()).take(untouched.1).take_while(same).count();
        parses.truncate(parses.len() - tail);
        parses.drain(..head);
        Window { replaced: replaced.start + head..replaced.end - tail, untouched: (0, 0), relexed, parses }
    }

    /// Reads an entity anew in its place.
    fn update(
        &mut self,
        id: EntityId,
        (span, parse): (Span, Parse),
        invalidated: &mut Invalidated,
    ) -> EntitySlot {
        let Some(file) = self.file_of(id) else { return EntitySlot { entity: id, len: span.len() } };
        self.unregister(id, file);
        if let Some(data) = self.entities[id.0 as usize].as_mut() {
            invalidated.uses.extend(only_in_one(used_keys(file, &data.parse), used_keys(file, &parse)));
            let (before, after) = (data.parse.skipped_names.iter(), parse.skipped_names.iter());
            invalidated.names.extend(hidden_keys(file, only_in_one(before, after)));
            let (before, after) = (defined_key(file, &data.parse), defined_key(file, &parse));
            if before != after {
                invalidated.names.extend(before.into_iter().chain(after));
            }
            if Signature::of(&data.parse) != Signature::of(&parse) {
                invalidated.entities.extend(&data.readers);
            }
            let summary = |parse: &Parse| parse.entity.as_ref().and_then(Summary::of);
            if !data.summary_readers.is_empty() && summary(&data.parse) != summary(&parse) {
                invalidated.entities.extend(&data.summary_readers);
            }
            data.parse = Arc::new(parse);
        }
        self.register(id, file);
        EntitySlot { entity: id, len: span.len() }
    }

    /// Removes the entities of a range of slots and adds others.
    fn exchange(
        &mut self,
        file: FileId,
        replaced: &Range<usize>,
        parses: Vec<(Span, Parse)>,
        invalidated: &mut Invalidated,
    ) -> Vec<EntitySlot> {
        for id in self.slots(file)[replaced.clone()].iter().map(|slot| slot.entity).collect::<Vec<_>>() {
            if let Some(data) = self.data(id) {
                invalidated.names.extend(visible_keys(file, &data.parse));
                invalidated.uses.extend(used_keys(file, &data.parse));
                invalidated.entities.extend(data.readers.iter().chain(&data.summary_readers));
            }
            self.remove(id);
        }
        let orders = self.orders_between(file, replaced, parses.len());
        invalidated.names.extend(parses.iter().flat_map(|(_, parse)| visible_keys(file, parse)));
        invalidated.uses.extend(parses.iter().flat_map(|(_, parse)| used_keys(file, parse)));
        parses
            .into_iter()
            .zip(orders)
            .map(|((span, parse), order)| self.add(file, span, parse, order))
            .collect()
    }

    /// Orders for new entities in place of `replaced`. Where there is no room left the whole file is numbered anew.
    fn orders_between(&mut self, file: FileId, replaced: &Range<usize>, count: usize) -> Vec<u64> {
        let count = count as u64;
        let neighbour = |database: &Self, index: Option<usize>| {
            let slot = index.and_then(|index| database.slots(file).get(index).copied());
            slot.map(|slot| database.order(slot.entity))
        };
        let before = neighbour(self, replaced.start.checked_sub(1)).unwrap_or(0);
        let after = neighbour(self, Some(replaced.end)).unwrap_or(before + (count + 1) * ORDER_STEP);
        let step = (after - before) / (count + 1);
        if step > 0 {
            return (1..=count).map(|index| before + index * step).collect();
        }
        let slots: Vec<EntitySlot> = self.slots(file).to_vec();
        let mut order = 0;
        let mut new = Vec::new();
        for (index, slot) in slots.iter().enumerate() {
            if index == replaced.start {
                new = (1..=count).map(|index| order + index * ORDER_STEP).collect();
                order += count * ORDER_STEP;
            }
            order += ORDER_STEP;
            if let Some(data) = self.entities[slot.entity.0 as usize].as_mut() {
                data.order = order;
            }
        }
        new
    }

    fn add(&mut self, file: FileId, span: Span, parse: Parse, order: u64) -> EntitySlot {
        let data = Some(EntityData {
            file,
            order,
            parse: Arc::new(parse),
            problems: Vec::new(),
            reads: Reads::default(),
            readers: SmallVec::new(),
            summary_readers: SmallVec::new(),
        });
        let id = if let Some(index) = self.free.pop() {
            self.entities[index as usize] = data;
            EntityId(index)
        } else {
            self.entities.push(data);
            EntityId(u32::try_from(self.entities.len() - 1).unwrap_or(u32::MAX))
        };
        self.register(id, file);
        EntitySlot { entity: id, len: span.len() }
    }

    fn remove(&mut self, id: EntityId) {
        if let Some(file) = self.file_of(id) {
            self.unregister(id, file);
            self.forget_reads(id);
            self.update_problem_sets(id, file, &[]);
            self.entities[id.0 as usize] = None;
            self.free.push(id.0);
        }
    }

    fn register(&mut self, id: EntityId, file: FileId) {
        let entities = &self.entities;
        let Some(data) = entities[id.0 as usize].as_ref() else { return };
        if let Some(kind) = data.parse.entity.as_ref().and_then(Entity::kind) {
            *self.counts.entry((file, kind)).or_default() += 1;
        }
        let order = |id: EntityId| entities[id.0 as usize].as_ref().map_or(0, |data| data.order);
        if let Some(key) = defined_key(file, &data.parse) {
            count_environment(&mut self.changed_environments, &key, 1);
            self.script_names.forget(&key);
            self.names.define(key, id, order);
        }
        for key in used_keys(file, &data.parse) {
            self.names.reference(key, id);
        }
        for name in &data.parse.skipped_names {
            self.names.skip(file, name.clone());
        }
    }

    fn unregister(&mut self, id: EntityId, file: FileId) {
        let Some(data) = self.entities[id.0 as usize].as_ref() else { return };
        if let Some(kind) = data.parse.entity.as_ref().and_then(Entity::kind)
            && let Some(count) = self.counts.get_mut(&(file, kind))
        {
            *count -= 1;
        }
        if let Some(key) = defined_key(file, &data.parse) {
            count_environment(&mut self.changed_environments, &key, -1);
            self.script_names.forget(&key);
            self.names.undefine(&key, id);
        }
        for key in used_keys(file, &data.parse) {
            self.names.unreference(&key, id);
        }
        for name in &data.parse.skipped_names {
            self.names.unskip(file, name);
        }
    }

    /// Makes the scripts of a file for another target from now on; some rules depend on it.
    pub fn set_target(&mut self, file: FileId, target: Target) {
        if self.target(file) != target {
            self.targets.insert(file, target);
            self.validate_file(file);
        }
    }

    /// Allows a file the statements of another edition from now on.
    pub fn set_edition(&mut self, file: FileId, edition: Edition) {
        if self.edition(file) != edition {
            self.editions.insert(file, edition);
            self.validate_file(file);
        }
    }

    pub(super) fn validate_file(&mut self, file: FileId) {
        if let Some(postponed) = &mut self.postponed {
            postponed.alone.insert(file);
            return;
        }
        for index in 0..self.slots(file).len() {
            self.validate(self.slots(file)[index].entity);
        }
    }

    fn validate_invalidated(&mut self, invalidated: Invalidated) {
        let Invalidated { mut entities, names, uses } = invalidated;
        let kinds = names.iter().fold(Kinds::default(), |kinds, (_, kind, _)| kinds.with(*kind));
        let looked_through =
            |id: &&EntityId| self.data(**id).is_some_and(|data| data.reads.kinds().meets(kinds));
        entities.extend(self.name_dependents.iter().filter(looked_through));
        for key in &names {
            entities.extend(self.dependents(key));
        }
        for key in &uses {
            entities.extend(self.names.mentions(key));
        }
        for id in entities {
            self.validate(id);
        }
    }

    /// Returns the entities to check again when the meaning of a name changes: all that declare it, use it or looked it
    /// up, here and in the files that import this one.
    fn dependents(&self, key: &Key) -> Vec<EntityId> {
        let (file, kind, name) = key;
        let mut ids: Vec<EntityId> = self.names.mentions(key).collect();
        for importer in self.importers(self.path(*file)) {
            ids.extend(self.names.mentions(&(importer, *kind, name.clone())));
        }
        if *kind == EntityKind::Environment {
            // Two environments whose names differ by case only cannot both have a script of their name.
            let twins = self.names.environments_but_for_case(*file, name).iter();
            ids.extend(twins.flat_map(|other| self.names.defined(&(*file, *kind, other.clone()))));
        }
        ids
    }

    fn validate(&mut self, id: EntityId) {
        let Some(file) = self.file_of(id) else { return };
        let (problems, reads) = diagnostics::in_entity(self, id);
        self.set_reads(id, reads);
        self.update_problem_sets(id, file, &problems);
        self.touched.insert(file);
        self.last_edit.revalidated += 1;
        if let Some(data) = self.entities[id.0 as usize].as_mut() {
            data.problems = problems;
        }
    }

    fn update_problem_sets(&mut self, id: EntityId, file: FileId, problems: &[Problem]) {
        set_member(&mut self.with_problems, file, id, !problems.is_empty());
        set_member(&mut self.renamed, file, id, problems.iter().any(Problem::renames));
    }
}

/// Adds an entity to the set of its file, or removes it.
fn set_member(
    sets: &mut FxHashMap<FileId, FxHashSet<EntityId>>,
    file: FileId,
    id: EntityId,
    is_member: bool,
) {
    if is_member {
        sets.entry(file).or_default().insert(id);
    } else if let Some(members) = sets.get_mut(&file) {
        members.remove(&id);
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

fn defined_key(file: FileId, parse: &Parse) -> Option<Key> {
    let entity = parse.entity.as_ref()?;
    Some((file, entity.kind()?, entity.name()?.text.clone()))
}

fn used_keys(file: FileId, parse: &Parse) -> impl Iterator<Item = Key> {
    let references = parse.entity.as_ref().map(Entity::references).unwrap_or_default();
    references.into_iter().map(move |(kind, name)| (file, kind, name.text.clone()))
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

/// The names whose meaning depends on an entity: the one it declares, and those that may be hidden in skipped text.
fn visible_keys(file: FileId, parse: &Parse) -> impl Iterator<Item = Key> {
    hidden_keys(file, parse.skipped_names.iter()).chain(defined_key(file, parse))
}

/// Returns the keys that names in skipped text may declare.
fn hidden_keys<'a>(file: FileId, names: impl Iterator<Item = &'a SmolStr>) -> impl Iterator<Item = Key> {
    names.flat_map(move |name| EntityKind::ALL.map(|kind| (file, kind, name.clone())))
}

/// The nearest range that fits the text and cuts no character.
fn fit(text: &Rope, span: Span) -> Span {
    let whole = Span::of_rope(text);
    let snap = |offset: u32| {
        let offset = offset.min(whole.end) as usize;
        let character = text.byte_to_char(offset);
        u32::try_from(text.char_to_byte(character)).unwrap_or(whole.end)
    };
    let start = snap(span.start);
    Span::new(start, snap(span.end.max(span.start)))
}
