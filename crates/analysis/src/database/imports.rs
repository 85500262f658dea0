//! What files import, and why some of it is not there.

use pydslrep_syntax::ast::Entity;
use rustc_hash::FxHashSet;

use super::{Database, EntityId, FileId};
use crate::path;

/// Why a file that is imported cannot be used. The database sees no disk: whoever reads files for it says so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Absence {
    /// There is no such file.
    Missing,
    /// The path leads to where imports may not lead.
    Outside,
    /// The file is there and cannot be read; in words that go after "because".
    Unreadable(String),
}

/// The imports of a file, in order.
#[derive(Debug, Clone, Default)]
pub(super) struct Imports {
    pub(super) entities: Vec<EntityId>,
    /// Of those that name one.
    pub(super) paths: Vec<String>,
}

impl Database {
    /// The paths a file imports, whether or not there is such a file.
    pub fn imports(&self, file: FileId) -> &[String] {
        self.imports.get(&file).map_or(&[], |imports| &imports.paths)
    }

    /// The files a file imports, as far as they are there.
    pub fn imported_files(&self, file: FileId) -> impl Iterator<Item = FileId> + '_ {
        let is_allowed = move |path: &&String| self.absence(file, path) != Some(&Absence::Outside);
        self.imports(file).iter().filter(is_allowed).filter_map(|path| self.file(path))
    }

    /// Why a path that a file imports leads nowhere, where this is known.
    pub fn absence(&self, importer: FileId, path: &str) -> Option<&Absence> {
        self.absences.get(&importer)?.get(path)
    }

    /// Says why a path that a file imports leads nowhere, or (`None`) that nothing is known against it. It is kept
    /// until a file of that path is opened or the importing one closed; only [`Absence::Outside`] outlives the
    /// former.
    pub fn set_absence(&mut self, importer: FileId, path: &str, absence: Option<Absence>) {
        if self.absence(importer, path) == absence.as_ref() || self.get(importer).is_none() {
            return;
        }
        let absences = self.absences.entry(importer).or_default();
        match absence {
            Some(absence) => absences.insert(path.to_owned(), absence),
            None => absences.remove(path),
        };
        let importer = self.path(importer).to_owned();
        self.validate_with_importers(&importer);
        if let Some(imported) = self.file(path) {
            self.validate_file(imported);
        }
    }

    /// Whether anything that a file imports is not there.
    pub(super) fn lacks_imports(&self, file: FileId) -> bool {
        self.imports.get(&file).is_some_and(|imports| {
            let is_absent = |path: &String| self.file(path).is_none() || self.absence(file, path).is_some();
            imports.paths.iter().any(is_absent)
        })
    }

    /// The path that an import leads to, if it names one.
    pub fn import_path(&self, id: EntityId) -> Option<String> {
        match self.tree(id)? {
            Entity::Import(import) => Some(path::join(self.path(self.file_of(id)?), import.path.as_ref()?)),
            _ => None,
        }
    }

    /// How an import in one file has to name another one; `None` where no path leads there.
    pub fn path_for_import(&self, importer: FileId, imported: FileId) -> Option<String> {
        path::relative(self.path(importer), self.path(imported))
    }

    /// The files that import a path, whether or not there is such a file, in the order of opening.
    pub fn importing_files(&self, path: &str) -> Vec<FileId> {
        let mut files: Vec<FileId> = self.importers(path).collect();
        files.sort_unstable();
        files
    }

    /// Whether another open file imports this one, and may use what nothing in it does.
    pub(crate) fn is_imported(&self, file: FileId) -> bool {
        let path = self.path(file);
        let may = |importer: FileId| self.absence(importer, path) != Some(&Absence::Outside);
        self.importers(path).any(may)
    }

    /// Whether an import is after an entity of another kind.
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

    pub(super) fn update_imports(&mut self, file: FileId) {
        self.forget_imports(file);
        let is_import = |id: &EntityId| matches!(self.tree(*id), Some(Entity::Import(_)));
        let entities: Vec<EntityId> =
            self.slots(file).iter().map(|slot| slot.entity).filter(is_import).collect();
        let paths: Vec<String> = entities.iter().filter_map(|id| self.import_path(*id)).collect();
        for path in &paths {
            self.importers.entry(path.clone()).or_default().insert(file);
        }
        if !entities.is_empty() {
            self.imports.insert(file, Imports { entities, paths });
        }
    }

    /// Forgets what a file imports; returns it.
    pub(super) fn forget_imports(&mut self, file: FileId) -> Vec<String> {
        let paths = self.imports.remove(&file).unwrap_or_default().paths;
        for path in &paths {
            if let Some(importers) = self.importers.get_mut(path) {
                importers.remove(&file);
                if importers.is_empty() {
                    self.importers.remove(path);
                }
            }
        }
        paths
    }

    pub(super) fn any_import(&self, ids: &[EntityId]) -> bool {
        ids.iter().any(|id| matches!(self.tree(*id), Some(Entity::Import(_))))
    }

    /// Of entities in a row, whether each is an import; `None` for the text before the first entity.
    pub(super) fn which_are_imports(&self, ids: &[EntityId]) -> Vec<Option<bool>> {
        ids.iter().map(|id| self.tree(*id).map(|tree| matches!(tree, Entity::Import(_)))).collect()
    }

    /// The files that import a path, in no order.
    pub(super) fn importers(&self, path: &str) -> impl Iterator<Item = FileId> + '_ {
        self.importers.get(path).into_iter().flatten().copied()
    }

    /// The text of a file changed: so may the places in it that its own diagnostics name, and those of the files that
    /// import it.
    pub(super) fn touch(&mut self, file: FileId) {
        self.touched.insert(file);
        let importers = self.importers.get(self.path(file));
        let importers: Vec<FileId> = importers.into_iter().flatten().copied().collect();
        self.touched.extend(importers);
    }

    /// A file of this path is there: nothing but the bounds of imports can be said against it.
    pub(super) fn forget_absence(&mut self, path: &str) {
        for absences in self.absences.values_mut() {
            if absences.get(path).is_some_and(|absence| *absence != Absence::Outside) {
                absences.remove(path);
            }
        }
    }

    /// Asks again a file and all that import it, near or far: a movement may have come with an import, and its robot
    /// with the import of that.
    pub(super) fn validate_with_importers(&mut self, path: &str) {
        let mut reached = vec![path.to_owned()];
        let mut seen: FxHashSet<FileId> = self.file(path).into_iter().collect();
        while let Some(path) = reached.pop() {
            for importer in self.importers(&path) {
                if seen.insert(importer) {
                    reached.push(self.path(importer).to_owned());
                }
            }
        }
        for file in seen {
            self.validate_file(file);
        }
    }

    /// Files that a file imports, or did before, may use what nothing in them does.
    pub(super) fn validate_imported(&mut self, file: FileId, before: &[String]) {
        let now = self.imports(file);
        let changed = before
            .iter()
            .filter(|path| !now.contains(path))
            .chain(now.iter().filter(|path| !before.contains(path)));
        for imported in changed.filter_map(|path| self.file(path)).collect::<Vec<_>>() {
            self.validate_file(imported);
        }
    }
}
