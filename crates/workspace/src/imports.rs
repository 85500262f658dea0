//! The imports of programs, and the folders that they may lead to.

use std::path::Path;

use pydslrep_analysis::{Absence, FileId};

use crate::keys::path_of;
use crate::{Document, DocumentKind, ReadError, Workspace};

impl Workspace {
    /// Returns whether an import in one file may lead to another: within the folders of the workspace, or within the
    /// folder of the importing file's `pydslrep.toml`, or else its own.
    pub fn may_import(&self, importer: &str, path: &str) -> bool {
        (self.contains(importer) && self.contains(path)) || self.is_in_project(importer, path)
    }

    /// Reads what a document imports, where that has changed since it was last followed.
    pub(crate) fn follow_changed_imports(&mut self, key: &str) {
        let Some(document) = self.documents.get(key) else { return };
        let imports = document.file.map_or(&[][..], |file| self.database.imports(file));
        if imports != document.imports {
            self.batch(|this| {
                this.follow_imports(key);
                this.forget_unneeded();
            });
        }
    }

    /// Looks again for a file wherever it is imported.
    pub(crate) fn follow_importers(&mut self, key: &str) {
        for importer in self.database.importing_files(key) {
            let importer = self.database.path(importer).to_owned();
            self.follow_imports(&importer);
        }
        self.forget_unneeded();
    }

    /// Reads what a document imports, and what that imports; records why a file is absent.
    pub(crate) fn follow_imports(&mut self, key: &str) {
        let mut waiting = vec![key.to_owned()];
        while let Some(importer) = waiting.pop() {
            let Some((file, imports)) = self.imports_of(&importer) else { continue };
            for path in imports {
                let is_known = self.documents.contains_key(&path);
                let absence = self.find_import(&importer, &path).err();
                self.database.set_absence(file, &path, absence);
                if !is_known && self.documents.contains_key(&path) {
                    waiting.push(path);
                }
            }
        }
    }

    /// Returns whether a program that may import a file does.
    pub(crate) fn is_imported(&self, key: &str, document: &Document) -> bool {
        self.database.importing_files(key).into_iter().any(|importer| {
            Some(importer) != document.file && self.database.absence(importer, key) != Some(&Absence::Outside)
        })
    }

    /// Returns the imports of a document, which from now on count as followed.
    fn imports_of(&mut self, key: &str) -> Option<(FileId, Vec<String>)> {
        let document = self.documents.get_mut(key)?;
        let file = document.file?;
        let imports = self.database.imports(file).to_vec();
        document.imports.clone_from(&imports);
        Some((file, imports))
    }

    /// Adds a file that is imported, unless it is there already.
    fn find_import(&mut self, importer: &str, path: &str) -> Result<(), Absence> {
        // A buffer without a file has no folder to import from.
        if !Path::new(importer).has_root() {
            return Ok(());
        }
        if !self.may_import(importer, path) {
            return Err(Absence::Outside);
        }
        if DocumentKind::of_document(path) != DocumentKind::Program {
            return Err(Absence::Unreadable("not a program".to_owned()));
        }
        if self.documents.contains_key(path) {
            return Ok(());
        }
        match self.files.read(&path_of(path)) {
            Ok(text) => {
                self.insert_file(path, &text);
                Ok(())
            }
            Err(ReadError::Missing) => Err(Absence::Missing),
            Err(error) => Err(Absence::Unreadable(error.to_string())),
        }
    }
}
