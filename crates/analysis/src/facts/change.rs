//! Changes of the facts: the entities that an edit replaces, and their names.

use std::ops::Range;
use std::sync::Arc;

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Parse, Span, parse_each};
use ropey::Rope;

use super::edited::Edited;
use super::{EntityData, Facts};
use crate::entity::{EntityId, FileId};
use crate::facts::file::{File, Window, fit};
use crate::facts::keys::{defined_key, used_keys};
use crate::facts::slots::{EntitySlot, EntitySlots};
use crate::{Edition, Target};

/// The space between the orders of two neighbours in a fresh file.
const ORDER_STEP: u64 = 1 << 32;

impl Facts {
    /// Opens a file that is closed or [cleared](Self::clear).
    pub(crate) fn open(&mut self, file: FileId, path: &str, text: Rope) -> Edited {
        let whole = text.to_string();
        self.files[file.index()] = Some(File { path: path.to_owned(), text, slots: EntitySlots::default() });
        let (mut slots, mut relexed) = (Vec::new(), 0);
        parse_each(&whole, |span, parse| {
            let order = (slots.len() as u64 + 1) * ORDER_STEP;
            relexed += parse.tokens.len();
            slots.push(self.add(file, span, parse, order));
        });
        let after: Vec<EntityId> = slots.iter().map(|slot| slot.entity).collect();
        let reparsed = slots.len();
        if let Some(open) = self.files[file.index()].as_mut() {
            open.slots = slots.into();
        }
        let imports_before = Some(self.update_imports(file));
        self.absences.remove_path(path);
        Edited { after, imports_before, relexed, reparsed, ..Edited::default() }
    }

    /// Closes a file that is [cleared](Self::clear); returns the paths that it imported.
    pub(crate) fn close(&mut self, file: FileId) -> Vec<String> {
        self.absences.remove_importer(file);
        self.files[file.index()] = None;
        self.imports.forget(file)
    }

    /// Takes `after` as the text of an open file, in which only `span` is replaced.
    pub(crate) fn edit(&mut self, file: FileId, span: Span, after: Rope) -> Option<Edited> {
        let entities = &self.entities;
        let parse = |id: EntityId| entities[id.index()].as_ref().map(|data| &*data.parse);
        let open = self.files.get_mut(file.index()).and_then(Option::as_mut)?;
        let window = open.edit(fit(&open.text, span), after, parse);
        Some(self.apply(file, window))
    }

    /// The file of a path, which may be new.
    pub(crate) fn file_for(&mut self, path: &str) -> FileId {
        if let Some(known) = self.by_path.get(path) {
            return *known;
        }
        let file = FileId::new(self.files.len());
        self.files.push(None);
        self.by_path.insert(path.to_owned(), file);
        file
    }

    /// Removes all entities of a file; returns them.
    pub(crate) fn clear(&mut self, file: FileId) -> Vec<(EntityId, Arc<Parse>)> {
        let slots = self.files[file.index()].as_mut().map(|file| std::mem::take(&mut file.slots));
        slots.unwrap_or_default().iter().filter_map(|slot| self.remove(slot.entity)).collect()
    }

    fn has_environments(&self, file: FileId) -> bool {
        self.count(file, EntityKind::Environment) > 0
    }

    fn apply(&mut self, file: FileId, window: Window) -> Edited {
        let (relexed, reparsed) = (window.relexed, window.parses.len());
        let Window { replaced, parses, .. } = self.without_unchanged_ends(file, window);
        let old: Vec<EntityId> = self.slots(file)[replaced.clone()].iter().map(|slot| slot.entity).collect();
        let had_imports = self.any_import(&old);
        let had_environments = self.has_environments(file);
        let is_update = old.len() == parses.len();
        let (before, new) = if is_update {
            self.update(file, &old, parses)
        } else {
            self.exchange(file, &replaced, &old, parses)
        };
        let after: Vec<EntityId> = new.iter().map(|slot| slot.entity).collect();
        if let Some(open) = self.files[file.index()].as_mut() {
            open.slots.replace(replaced, new);
        }
        let imports_before = (had_imports || self.any_import(&after)).then(|| self.update_imports(file));
        Edited { before, after, is_update, imports_before, had_environments, relexed, reparsed }
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

    /// Reads entities anew in their places; returns how they were.
    fn update(
        &mut self,
        file: FileId,
        ids: &[EntityId],
        parses: Vec<(Span, Parse)>,
    ) -> (Vec<(EntityId, Arc<Parse>)>, Vec<EntitySlot>) {
        let (mut before, mut slots) = (Vec::with_capacity(ids.len()), Vec::with_capacity(ids.len()));
        for (&id, (span, parse)) in ids.iter().zip(parses) {
            self.unregister(id, file);
            if let Some(data) = self.entities[id.index()].as_mut() {
                before.push((id, std::mem::replace(&mut data.parse, Arc::new(parse))));
            }
            self.register(id, file);
            slots.push(EntitySlot { entity: id, len: span.len() });
        }
        (before, slots)
    }

    /// Removes entities in a row, which have a range of slots, and adds others; returns those that were removed.
    fn exchange(
        &mut self,
        file: FileId,
        replaced: &Range<usize>,
        ids: &[EntityId],
        parses: Vec<(Span, Parse)>,
    ) -> (Vec<(EntityId, Arc<Parse>)>, Vec<EntitySlot>) {
        let before = ids.iter().filter_map(|id| self.remove(*id)).collect();
        let orders = self.orders_between(file, replaced, parses.len());
        let new = parses.into_iter().zip(orders);
        let slots = new.map(|((span, parse), order)| self.add(file, span, parse, order)).collect();
        (before, slots)
    }

    /// Orders for new entities in place of `replaced`. Where there is no room left the whole file is numbered anew.
    fn orders_between(&mut self, file: FileId, replaced: &Range<usize>, count: usize) -> Vec<u64> {
        let count = count as u64;
        let neighbour = |facts: &Self, index: Option<usize>| {
            let slot = index.and_then(|index| facts.slots(file).get(index).copied());
            slot.map(|slot| facts.order(slot.entity))
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
            if let Some(data) = self.entities[slot.entity.index()].as_mut() {
                data.order = order;
            }
        }
        new
    }

    fn add(&mut self, file: FileId, span: Span, parse: Parse, order: u64) -> EntitySlot {
        let data = Some(EntityData { file, order, parse: Arc::new(parse) });
        let id = if let Some(id) = self.free.pop() {
            self.entities[id.index()] = data;
            id
        } else {
            self.entities.push(data);
            EntityId::new(self.entities.len() - 1)
        };
        self.register(id, file);
        EntitySlot { entity: id, len: span.len() }
    }

    fn remove(&mut self, id: EntityId) -> Option<(EntityId, Arc<Parse>)> {
        self.unregister(id, self.file_of(id)?);
        let data = self.entities[id.index()].take()?;
        self.free.push(id);
        Some((id, data.parse))
    }

    fn register(&mut self, id: EntityId, file: FileId) {
        let entities = &self.entities;
        let Some(data) = entities[id.index()].as_ref() else { return };
        if let Some(kind) = data.parse.entity.as_ref().and_then(Entity::kind) {
            *self.counts.entry((file, kind)).or_default() += 1;
        }
        let order = |id: EntityId| entities[id.index()].as_ref().map_or(0, |data| data.order);
        if let Some(key) = defined_key(file, &data.parse) {
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
        let Some(data) = self.entities[id.index()].as_ref() else { return };
        if let Some(kind) = data.parse.entity.as_ref().and_then(Entity::kind)
            && let Some(count) = self.counts.get_mut(&(file, kind))
        {
            *count -= 1;
        }
        if let Some(key) = defined_key(file, &data.parse) {
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

    /// Makes the scripts of a file for a target from now on; returns whether that is new.
    pub(crate) fn set_target(&mut self, file: FileId, target: Target) -> bool {
        self.targets.insert(file, target).unwrap_or_default() != target
    }

    /// Allows a file the statements of an edition from now on; returns whether that is new.
    pub(crate) fn set_edition(&mut self, file: FileId, edition: Edition) -> bool {
        self.editions.insert(file, edition).unwrap_or_default() != edition
    }
}
