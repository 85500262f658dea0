//! The facts: the texts, entities, names, imports and scenes of all files, and what is asked of them alone. They know
//! no rule and no problem. How they change is in [`change`].

mod absences;
mod change;
mod edited;
pub(crate) mod file;
mod import_index;
mod imports;
pub(crate) mod keys;
mod names;
mod references;
mod scenes;
pub(crate) mod script_name;
mod scripts;
mod slots;
mod snapshot;

pub use self::absences::Absence;
pub(crate) use self::edited::Edited;
pub(crate) use self::slots::EntitySlot;
pub use self::snapshot::Snapshot;

use std::collections::BTreeMap;
use std::sync::Arc;

use pydslrep_syntax::ast::Entity;
use pydslrep_syntax::{EntityKind, Parse, Span, TokenKind};
use ropey::Rope;
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use self::absences::Absences;
use self::file::File;
use self::import_index::ImportIndex;
use self::keys::Key;
use self::names::Names;
use self::script_name::ScriptNames;
use crate::entity::{EntityId, EntityRef, FileId, Resolution};
use crate::{Edition, Target, check_cancelled};

#[derive(Debug, Clone)]
struct EntityData {
    file: FileId,
    /// Grows through the file; only its order means anything.
    order: u64,
    parse: Arc<Parse>,
}

/// Documents and what they say. A clone shares texts and trees.
#[derive(Debug, Clone, Default)]
pub struct Facts {
    files: Vec<Option<File>>,
    by_path: FxHashMap<String, FileId>,
    entities: Vec<Option<EntityData>>,
    free: Vec<EntityId>,
    names: Names,
    /// The number of entities of a kind in a file, named or not.
    counts: FxHashMap<(FileId, EntityKind), u32>,
    imports: ImportIndex,
    /// Why what a file imports is not there, as far as this is known.
    absences: Absences,
    /// The targets of scripts, as far as somebody chose them. Kept while a file is closed.
    targets: FxHashMap<FileId, Target>,
    /// Which statements a file may have, as far as somebody chose its edition. Kept while a file is closed.
    editions: FxHashMap<FileId, Edition>,
    /// The texts of scenes, by the names of their environments. Kept while a file is closed.
    scenes: BTreeMap<FileId, BTreeMap<SmolStr, Arc<str>>>,
    script_names: ScriptNames,
}

impl Facts {
    /// An open file by its path.
    pub fn file(&self, path: &str) -> Option<FileId> {
        self.by_path.get(path).copied().filter(|file| self.get(*file).is_some())
    }

    /// A file by its path, open or closed.
    pub(crate) fn file_of_path(&self, path: &str) -> Option<FileId> {
        self.by_path.get(path).copied()
    }

    /// All open files, in the order of opening.
    pub fn files(&self) -> impl Iterator<Item = FileId> + '_ {
        (0..).map(FileId::new).zip(&self.files).filter(|(_, file)| file.is_some()).map(|(id, _)| id)
    }

    /// The path a file was opened by; empty for a closed file.
    pub fn path(&self, file: FileId) -> &str {
        self.get(file).map_or("", |file| &file.path)
    }

    /// The text of a file; `None` for a closed one.
    pub fn text(&self, file: FileId) -> Option<&Rope> {
        self.get(file).map(|file| &file.text)
    }

    /// A part of a file's text; empty where it does not fit.
    pub fn slice(&self, file: FileId, span: Span) -> String {
        self.text(file).map_or_else(String::new, |text| span.slice(text))
    }

    /// The line ending a file uses.
    pub fn line_ending(&self, file: FileId) -> &'static str {
        self.get(file).map_or("\n", File::line_ending)
    }

    /// Returns the target of a file's scripts.
    pub fn target(&self, file: FileId) -> Target {
        self.targets.get(&file).copied().unwrap_or_default()
    }

    /// Which statements a file may have.
    pub fn edition(&self, file: FileId) -> Edition {
        self.editions.get(&file).copied().unwrap_or_default()
    }

    /// The entities of a file in the order of the text; also what is before the first.
    pub fn entities(&self, file: FileId) -> impl Iterator<Item = EntityRef<'_>> {
        self.entities_from(file, 0)
    }

    /// The entities of a file from the one that holds an offset on, in the order of the text.
    pub fn entities_from(&self, file: FileId, offset: u32) -> impl Iterator<Item = EntityRef<'_>> {
        let (index, mut start) = self.slot_at(file, offset);
        let slots = self.slots(file).get(index..).unwrap_or_default();
        slots.iter().filter_map(move |slot| {
            check_cancelled();
            let entity = self.located_slot(*slot, start);
            start += slot.len;
            entity
        })
    }

    /// The entity that holds an offset: at a boundary the one after it, at the end of the text the last one.
    pub fn entity_at(&self, file: FileId, offset: u32) -> Option<EntityRef<'_>> {
        let (index, start) = self.slot_at(file, offset);
        self.located_slot(*self.slots(file).get(index)?, start)
    }

    /// The entities next to an offset, at most so many on either side of the one that holds it, in the order of the text:
    /// their number does not follow the length of the file.
    pub fn entities_around(&self, file: FileId, offset: u32, reach: usize) -> impl Iterator<Item = EntityId> {
        let (index, _) = self.slot_at(file, offset);
        let slots = self.slots(file);
        let around = index.saturating_sub(reach)..(index + reach + 1).min(slots.len());
        slots.get(around).unwrap_or_default().iter().map(|slot| slot.entity)
    }

    /// An entity with its place.
    pub fn entity(&self, id: EntityId) -> Option<EntityRef<'_>> {
        check_cancelled();
        let data = self.data(id)?;
        let open = self.get(data.file)?;
        let index = open.slots.partition_point(|slot| self.order(slot.entity) < data.order);
        let slot = open.slots.get(index).filter(|slot| slot.entity == id)?;
        self.located_slot(*slot, open.slots.start_of(index))
    }

    /// The entity of a slot that starts there.
    fn located_slot(&self, slot: EntitySlot, start: u32) -> Option<EntityRef<'_>> {
        let EntityData { file, parse, .. } = self.data(slot.entity)?;
        Some(EntityRef { id: slot.entity, file: *file, span: Span::new(start, start + slot.len), parse })
    }

    pub(crate) fn parse(&self, id: EntityId) -> Option<&Parse> {
        self.data(id).map(|data| &*data.parse)
    }

    pub(crate) fn shared_parse(&self, id: EntityId) -> Option<&Arc<Parse>> {
        self.data(id).map(|data| &data.parse)
    }

    /// The slot that holds an offset, and where it starts.
    pub(crate) fn slot_at(&self, file: FileId, offset: u32) -> (usize, u32) {
        self.get(file).map_or((0, 0), |file| file.slots.at(offset))
    }

    pub(crate) fn slots(&self, file: FileId) -> &[EntitySlot] {
        self.get(file).map_or(&[], |file| &file.slots)
    }

    /// An entity's tree, without its place.
    pub fn tree(&self, id: EntityId) -> Option<&Entity> {
        self.data(id)?.parse.entity.as_ref()
    }

    /// The file an entity is in.
    pub fn file_of(&self, id: EntityId) -> Option<FileId> {
        self.data(id).map(|data| data.file)
    }

    /// Resolves a name in a file: to its first declaration in it, else to one in the files it imports.
    pub fn resolve(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> Resolution {
        if let Some(first) = self.names.defined(&(file, kind, name.clone())).first() {
            return Resolution::To(*first);
        }
        let mut unknown = self.names.is_skipped(file, name) || self.lacks_imports(file);
        for imported in self.imported_files(file) {
            if let Some(first) = self.names.defined(&(imported, kind, name.clone())).first() {
                return Resolution::To(*first);
            }
            unknown |= self.names.is_skipped(imported, name);
        }
        if unknown { Resolution::Unknown } else { Resolution::Nothing }
    }

    /// All declarations of a name in one file, in the order of the text.
    pub fn definitions(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> &[EntityId] {
        self.names.defined(&(file, kind, name.clone()))
    }

    /// The entities of one file that use a name, in no order.
    pub fn users(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> &[EntityId] {
        self.names.used(&(file, kind, name.clone()))
    }

    /// The entities of one file that declare or use a name, in no order.
    pub(crate) fn mentions(&self, key: &Key) -> impl Iterator<Item = EntityId> {
        self.names.mentions(key)
    }

    /// Every name of a kind that a file sees, in no order, some perhaps more than once.
    pub fn names_in_sight(&self, file: FileId, kind: EntityKind) -> impl Iterator<Item = &SmolStr> {
        let files = std::iter::once(file).chain(self.imported_files(file));
        files.flat_map(move |file| self.names.all(file, kind))
    }

    /// Returns whether a file or one of its imports declares a name of a kind.
    pub(crate) fn is_in_sight(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> bool {
        let mut files = std::iter::once(file).chain(self.imported_files(file));
        files.any(|file| !self.definitions(file, kind, name).is_empty())
    }

    /// The declared names of a kind in a file, in no order.
    pub fn names(&self, file: FileId, kind: EntityKind) -> impl Iterator<Item = &SmolStr> {
        self.names.all(file, kind)
    }

    /// The names of environments of a file that are the same as `name` except for case, itself included, in no order.
    pub(crate) fn environments_but_for_case(&self, file: FileId, name: &SmolStr) -> &[SmolStr] {
        self.names.environments_but_for_case(file, name)
    }

    /// Returns the number of entities of a kind in a file.
    pub fn count(&self, file: FileId, kind: EntityKind) -> u32 {
        self.counts.get(&(file, kind)).copied().unwrap_or(0)
    }

    /// Returns whether a name is in text of the file that had to be skipped.
    pub(crate) fn is_skipped(&self, file: FileId, name: &SmolStr) -> bool {
        self.names.is_skipped(file, name)
    }

    /// Returns whether skipped text of the file contains names that may be declarations.
    pub(crate) fn has_skipped_names(&self, file: FileId) -> bool {
        self.names.any_skipped(file)
    }

    /// Returns whether the file ends inside a comment, which may hide declarations.
    pub(crate) fn has_open_comment(&self, file: FileId) -> bool {
        let last = self.get(file).and_then(|file| file.slots.last()).and_then(|slot| self.data(slot.entity));
        last.and_then(|data| data.parse.tokens.last())
            .is_some_and(|(token, _)| *token == TokenKind::UnterminatedComment)
    }

    pub(crate) fn order(&self, id: EntityId) -> u64 {
        self.data(id).map_or(0, |data| data.order)
    }

    fn get(&self, file: FileId) -> Option<&File> {
        self.files.get(file.index())?.as_ref()
    }

    fn data(&self, id: EntityId) -> Option<&EntityData> {
        self.entities.get(id.index())?.as_ref()
    }
}
