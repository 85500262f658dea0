//! What files import.

use pydslrep_syntax::ast::Entity;

use super::{Absence, Facts};
use crate::entity::{EntityId, FileId};
use crate::path;

impl Facts {
    /// The paths a file imports, whether or not there is such a file.
    pub fn imports(&self, file: FileId) -> &[String] {
        self.imports.paths(file)
    }

    /// The files a file imports, as far as they are there.
    pub fn imported_files(&self, file: FileId) -> impl Iterator<Item = FileId> + '_ {
        let is_allowed = move |path: &&String| self.absence(file, path) != Some(&Absence::Outside);
        self.imports(file).iter().filter(is_allowed).filter_map(|path| self.file(path))
    }

    /// Why a path that a file imports leads nowhere, where this is known.
    pub fn absence(&self, importer: FileId, path: &str) -> Option<&Absence> {
        self.absences.get(importer, path)
    }

    /// Notes why a path that a file imports leads nowhere, or (`None`) that nothing is known against it. Returns whether
    /// that is new.
    pub(crate) fn set_absence(&mut self, importer: FileId, path: &str, absence: Option<Absence>) -> bool {
        if self.absence(importer, path) == absence.as_ref() || self.get(importer).is_none() {
            return false;
        }
        match absence {
            Some(absence) => self.absences.insert(importer, path, absence),
            None => self.absences.remove(importer, path),
        }
        true
    }

    /// Returns whether any file that a file imports is absent.
    pub(super) fn lacks_imports(&self, file: FileId) -> bool {
        let is_absent = |path: &String| self.file(path).is_none() || self.absence(file, path).is_some();
        self.imports(file).iter().any(is_absent)
    }

    /// The path that an import leads to, if it names one.
    pub fn import_path(&self, id: EntityId) -> Option<String> {
        match self.tree(id)? {
            Entity::Import(import) => Some(path::join(self.path(self.file_of(id)?), import.path.as_ref()?)),
            _ => None,
        }
    }

    /// Returns the path by which one file imports another; `None` where no path leads there.
    pub fn path_for_import(&self, importer: FileId, imported: FileId) -> Option<String> {
        path::relative(self.path(importer), self.path(imported))
    }

    /// The files that import a path, whether or not there is such a file, in the order of opening.
    pub fn importing_files(&self, path: &str) -> Vec<FileId> {
        let mut files: Vec<FileId> = self.importers(path).collect();
        files.sort_unstable();
        files
    }

    /// Returns whether another open file imports this one, and may use what is unused in it.
    pub(crate) fn is_imported(&self, file: FileId) -> bool {
        let path = self.path(file);
        let may = |importer: FileId| self.absence(importer, path) != Some(&Absence::Outside);
        self.importers(path).any(may)
    }

    /// Returns whether an import is after an entity of another kind.
    pub(crate) fn is_late_import(&self, id: EntityId) -> bool {
        let Some(data) = self.data(id) else { return false };
        let Some(open) = self.get(data.file) else { return false };
        let first_entity = open
            .slots
            .iter()
            .filter_map(|slot| self.data(slot.entity))
            .find(|data| !matches!(data.parse.entity, None | Some(Entity::Import(_))));
        first_entity.is_some_and(|first| first.order < data.order)
    }

    pub(super) fn any_import(&self, ids: &[EntityId]) -> bool {
        ids.iter().any(|id| matches!(self.tree(*id), Some(Entity::Import(_))))
    }

    /// The import statements of a file.
    pub(crate) fn import_entities(&self, file: FileId) -> &[EntityId] {
        self.imports.entities(file)
    }

    /// Looks the imports of a file up anew; returns the paths that it imported before.
    pub(super) fn update_imports(&mut self, file: FileId) -> Vec<String> {
        let entities = self.slots(file).iter().map(|slot| slot.entity);
        let entities: Vec<EntityId> = entities.filter(|id| self.any_import(&[*id])).collect();
        let paths: Vec<String> = entities.iter().filter_map(|id| self.import_path(*id)).collect();
        self.imports.set(file, entities, paths)
    }

    /// The files that import a path, in no order.
    pub(crate) fn importers(&self, path: &str) -> impl Iterator<Item = FileId> + '_ {
        self.imports.importers(path)
    }
}
