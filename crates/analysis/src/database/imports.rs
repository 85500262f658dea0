//! The imports of files.

use pydslrep_syntax::ast::Entity;
use rustc_hash::FxHashSet;

use super::absences::Absence;
use super::{Database, EntityId, FileId};
use crate::path;

/// The imports of a file, in order.
#[derive(Debug, Clone, Default)]
pub(super) struct Imports {
    pub(super) entities: Vec<EntityId>,
    /// Of those that name one.
    pub(super) paths: Vec<String>,
}

/// Files whose problems are to be asked again.
#[derive(Debug, Clone, Default)]
pub(super) struct Postponed {
    /// These with all that import them, near or far.
    with_importers: FxHashSet<FileId>,
    /// Only these.
    pub(super) alone: FxHashSet<FileId>,
}

impl Database {
    /// Starts a batch of changes to files that belong together, such as a program and all that it imports. The entities
    /// that they invalidate are checked once, in [`Self::end_batch`], however long the chains of imports are; until
    /// then, problems are those from before the batch.
    pub fn begin_batch(&mut self) {
        self.postponed.get_or_insert_default();
    }

    /// Returns whether a batch begun by [`Self::begin_batch`] is still open.
    pub fn is_in_batch(&self) -> bool {
        self.postponed.is_some()
    }

    /// Ends the batch that [`Self::begin_batch`] began, and checks what it invalidated.
    pub fn end_batch(&mut self) {
        let Some(Postponed { with_importers, alone }) = self.postponed.take() else { return };
        let mut files = self.with_importers(with_importers);
        files.extend(alone);
        for file in files {
            self.validate_file(file);
        }
    }

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
        self.absences.get(importer, path)
    }

    /// Says why a path that a file imports leads nowhere, or (`None`) that nothing is known against it. It is kept
    /// until a file of that path is opened or the importing one closed; only [`Absence::Outside`] outlives the
    /// former.
    pub fn set_absence(&mut self, importer: FileId, path: &str, absence: Option<Absence>) {
        if self.absence(importer, path) == absence.as_ref() || self.get(importer).is_none() {
            return;
        }
        match absence {
            Some(absence) => self.absences.insert(importer, path, absence),
            None => self.absences.remove(importer, path),
        }
        let importer = self.path(importer).to_owned();
        self.validate_with_importers(&importer);
        if let Some(imported) = self.file(path) {
            self.validate_file(imported);
        }
    }

    /// Returns whether any file that a file imports is absent.
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
    /// import it; and places at which what it imports would be renamed.
    pub(super) fn touch(&mut self, file: FileId) {
        self.touched.insert(file);
        let importers = self.importers.get(self.path(file));
        let importers: Vec<FileId> = importers.into_iter().flatten().copied().collect();
        self.touched.extend(importers);
        let is_renamed = |imported: &FileId| self.renamed.get(imported).is_some_and(|ids| !ids.is_empty());
        let renamed: Vec<FileId> = self.imported_files(file).filter(is_renamed).collect();
        self.touched.extend(renamed);
    }

    /// Asks again a file and all that import it, near or far: a movement may have come with an import, and its robot
    /// with the import of that.
    pub(super) fn validate_with_importers(&mut self, path: &str) {
        if let Some(postponed) = &mut self.postponed {
            // Those that import these follow at the end, once for all.
            postponed.with_importers.extend(self.by_path.get(path));
            postponed.with_importers.extend(self.importers.get(path).into_iter().flatten());
            return;
        }
        let direct = self.file(path).into_iter().chain(self.importers(path)).collect();
        for file in self.with_importers(direct) {
            self.validate_file(file);
        }
    }

    /// Some files and all that import one of them, near or far.
    fn with_importers(&self, files: FxHashSet<FileId>) -> FxHashSet<FileId> {
        let mut reached: Vec<FileId> = files.iter().copied().collect();
        let mut seen = files;
        while let Some(file) = reached.pop() {
            reached.extend(self.importers(self.path(file)).filter(|importer| seen.insert(*importer)));
        }
        seen
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

#[cfg(test)]
mod tests {
    use pydslrep_syntax::Span;

    use crate::Database;

    #[test]
    fn files_are_touched_whose_fixes_edit_what_has_moved() {
        let mut database = Database::new();
        let parts = database.open("parts.pyr", "wheel moves with radius 4.5\n");
        let main =
            database.open("main.pyr", "import \"parts.pyr\"\nrobot r with port 1 has { ^moves } wheels\n");
        let place = |database: &Database| {
            let edits = database.diagnostics(parts).into_iter().flat_map(|problem| problem.fixes);
            let edits = edits.flat_map(|fix| fix.edits).filter(|edit| edit.file == main);
            edits.map(|edit| edit.span.start).next()
        };
        let before = place(&database);
        assert!(before.is_some(), "the fix renames the wheel in both files");
        database.take_touched();
        database.edit(main, Span::at(0), "// A comment.\n");
        assert_eq!(place(&database), before.map(|place| place + 14));
        assert_eq!(database.take_touched(), [parts, main]);
    }
}
