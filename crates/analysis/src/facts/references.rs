//! Where names are used, asked of the index: the cost follows the number of uses, not the length of the files.

use pydslrep_syntax::{EntityKind, Span, TokenKind};
use smol_str::SmolStr;

use super::Facts;
use crate::entity::{EntityId, EntityRef, FileId, FileSpan};

impl Facts {
    /// Everything that a name could mean in a file: its own declarations, else those of every file that it imports, in
    /// the order of the imports. [`Self::resolve`] leads to the first.
    pub fn candidates(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> Vec<EntityId> {
        let own = self.definitions(file, kind, name);
        if !own.is_empty() {
            return own.to_vec();
        }
        let mut found = Vec::new();
        for imported in self.imported_files(file) {
            let declared = self.definitions(imported, kind, name);
            // A file may be imported twice.
            if !declared.iter().any(|id| found.contains(id)) {
                found.extend(declared);
            }
        }
        found
    }

    /// The open files that import a file, apart from itself, in the order of opening.
    pub fn importing(&self, file: FileId) -> Vec<FileId> {
        let imports_it = |importer: &FileId| {
            *importer != file && self.imported_files(*importer).any(|imported| imported == file)
        };
        let mut importers: Vec<FileId> = self.importers(self.path(file)).filter(imports_it).collect();
        importers.sort_unstable();
        importers
    }

    /// Where a file declares a name, in the order of the text.
    pub fn declarations(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> Vec<Span> {
        let declaring = self.located(self.definitions(file, kind, name));
        let place = |entity: EntityRef<'_>| {
            Some(entity.parse.entity.as_ref()?.name()?.span.shifted(entity.span.start))
        };
        declaring.into_iter().filter_map(place).collect()
    }

    /// Where a file uses a name, whatever it means there, in the order of the text.
    pub fn uses(&self, file: FileId, kind: EntityKind, name: &SmolStr) -> Vec<Span> {
        let users = self.located(self.users(file, kind, name));
        let places = |entity: EntityRef<'_>| {
            let references = entity.parse.entity.as_ref().map(|tree| tree.references()).unwrap_or_default();
            let same = references.into_iter().filter(|(other, found)| *other == kind && found.text == *name);
            same.map(|(_, found)| found.span.shifted(entity.span.start)).collect::<Vec<_>>()
        };
        users.into_iter().flat_map(places).collect()
    }

    /// All uses of what `home` declares under a name: in `home`, and in the files that import it and whose name resolves to
    /// what it declares. Where `home` declares nothing of that name these are the uses in it.
    pub fn references(&self, home: FileId, kind: EntityKind, name: &SmolStr) -> Vec<FileSpan> {
        let resolves_to_home = |file: &FileId| {
            let declaration = self.resolve(*file, kind, name).entity();
            declaration.and_then(|id| self.file_of(id)) == Some(home)
        };
        let importing = self.importing(home).into_iter().filter(resolves_to_home);
        std::iter::once(home)
            .chain(importing)
            .flat_map(|file| self.uses(file, kind, name).into_iter().map(move |span| FileSpan { file, span }))
            .collect()
    }

    /// Returns whether a name is in text of the file that was not understood, where it may be a declaration or a use:
    /// in skipped text, or in a comment that is never closed.
    pub fn may_hide(&self, file: FileId, name: &SmolStr) -> bool {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        self.is_skipped(file, name)
            || self
                .open_comment(file)
                .is_some_and(|span| self.slice(file, span).split(|c| !word(c)).any(|other| other == name))
    }

    /// The comment that reaches to the end of a file for want of its `*/`.
    fn open_comment(&self, file: FileId) -> Option<Span> {
        let open = self.get(file)?;
        let (token, span) = *self.data(open.slots.last()?.entity)?.parse.tokens.last()?;
        (token == TokenKind::UnterminatedComment)
            .then(|| span.shifted(open.slots.start_of(open.slots.len() - 1)))
    }

    /// The import statements of a file with the paths that they lead to, in the order of the text.
    pub fn import_statements(&self, file: FileId) -> Vec<(EntityRef<'_>, String)> {
        let statements = self.imports.entities(file);
        let located = self.located(statements).into_iter();
        located.filter_map(|entity| Some((entity, self.import_path(entity.id)?))).collect()
    }

    /// Entities with their places, each once, in the order of the text.
    fn located(&self, ids: &[EntityId]) -> Vec<EntityRef<'_>> {
        let mut wanted = ids.to_vec();
        wanted.sort_unstable_by_key(|id| self.order(*id));
        wanted.dedup();
        wanted.into_iter().filter_map(|id| self.entity(id)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Database;

    /// Three files: `a` and `b` both declare `w`, `main` imports both.
    fn three() -> (Database, [FileId; 3]) {
        let mut database = Database::new();
        let a = database.open("a.pyr", "wheel w with radius 4 robot p with port 1 has { w w } wheels");
        let b = database.open("b.pyr", "import \"b.pyr\" wheel w with radius 5 wheel w with radius 6");
        let main = database.open(
            "main.pyr",
            "import \"a.pyr\" import \"b.pyr\" import \"a.pyr\" robot r with port 1 has { w, ^w } wheels",
        );
        (database, [a, b, main])
    }

    #[test]
    fn uses_come_from_all_files_that_mean_the_declaration() {
        let (mut database, [a, b, main]) = three();
        let name = SmolStr::new("w");
        let texts = |database: &Database, home| -> Vec<(FileId, String)> {
            let found = database.references(home, EntityKind::Wheel, &name);
            found.iter().map(|place| (place.file, database.slice(place.file, place.span))).collect()
        };
        let used = |file, text: &str| (file, text.to_owned());
        let all = [used(a, "w"), used(a, "w"), used(main, "w"), used(main, "^w")];
        assert_eq!(texts(&database, a), all);
        assert_eq!(texts(&database, b), []);
        assert_eq!(database.candidates(main, EntityKind::Wheel, &name).len(), 3);
        database.edit(main, Span::new(0, 14), "");
        // Both are imported still, but now `b` comes first.
        assert_eq!(texts(&database, a), all[..2]);
        assert_eq!(texts(&database, b), all[2..]);
        database.edit(main, Span::at(0), "wheel w with radius 7 ");
        assert_eq!(texts(&database, b), []);
        assert_eq!(texts(&database, main), all[2..]);
    }

    #[test]
    fn what_is_not_understood_may_hide_names() {
        let mut database = Database::new();
        let file = database.open("a.pyr", "wheel a has b with radius 4 // c\n/* the d");
        let hidden = |name: &str| database.may_hide(file, &SmolStr::new(name));
        assert_eq!(["a", "b", "c", "d", "the d"].map(hidden), [false, true, false, true, false]);
    }

    #[test]
    fn imports_come_with_their_paths() {
        let mut database = Database::new();
        let file = database.open("d/a.pyr", "import import \"b.pyr\" wheel w import \"../c.pyr\"");
        let found: Vec<(u32, String)> = database
            .import_statements(file)
            .into_iter()
            .map(|(entity, path)| (entity.span.start, path))
            .collect();
        assert_eq!(found, [(7, "d/b.pyr".to_owned()), (30, "c.pyr".to_owned())]);
    }
}
