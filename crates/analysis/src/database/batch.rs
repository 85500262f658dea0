//! Batches of changes: files that belong together are checked once, however long the chains of their imports are.

use rustc_hash::FxHashSet;

use super::Database;
use super::postponed::Postponed;
use crate::entity::FileId;

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
            self.check_file(file);
        }
    }

    /// Checks all entities of a file again.
    pub(super) fn check_file(&mut self, file: FileId) {
        if let Some(postponed) = &mut self.postponed {
            postponed.alone.insert(file);
            return;
        }
        for index in 0..self.facts.slots(file).len() {
            self.check(self.facts.slots(file)[index].entity);
        }
    }

    /// Checks again a file and all that import it, near or far: a movement may have come with an import, and its robot
    /// with the import of that.
    pub(super) fn check_with_importers(&mut self, path: &str) {
        let direct = self.facts.file_of_path(path).into_iter().chain(self.facts.importers(path));
        if let Some(postponed) = &mut self.postponed {
            // Those that import these follow at the end, once for all.
            postponed.with_importers.extend(direct);
            return;
        }
        let direct = direct.collect();
        for file in self.with_importers(direct) {
            self.check_file(file);
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

    /// Checks again the files that a file imports now, or did before, but not both: it may use what nothing in them
    /// does.
    pub(super) fn check_imported(&mut self, file: FileId, before: &[String]) {
        let now = self.imports(file);
        let changed = before
            .iter()
            .filter(|path| !now.contains(path))
            .chain(now.iter().filter(|path| !before.contains(path)));
        for imported in changed.filter_map(|path| self.file(path)).collect::<Vec<_>>() {
            self.check_file(imported);
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
