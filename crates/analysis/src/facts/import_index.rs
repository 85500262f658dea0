//! The index of imports, in both directions.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::entity::{EntityId, FileId};

/// What files import, and the files that import a path.
#[derive(Debug, Clone, Default)]
pub(super) struct ImportIndex {
    /// Only of files that import anything.
    imports: FxHashMap<FileId, Imports>,
    /// The reverse of `imports`.
    importers: FxHashMap<String, FxHashSet<FileId>>,
}

/// The imports of a file, in order.
#[derive(Debug, Clone, Default)]
struct Imports {
    entities: Vec<EntityId>,
    /// Of those that name one.
    paths: Vec<String>,
}

impl ImportIndex {
    /// The import statements of a file.
    pub(super) fn entities(&self, file: FileId) -> &[EntityId] {
        self.imports.get(&file).map_or(&[], |imports| &imports.entities)
    }

    /// The paths that a file imports, whether or not there is such a file.
    pub(super) fn paths(&self, file: FileId) -> &[String] {
        self.imports.get(&file).map_or(&[], |imports| &imports.paths)
    }

    /// The files that import a path, in no order.
    pub(super) fn importers(&self, path: &str) -> impl Iterator<Item = FileId> + '_ {
        self.importers.get(path).into_iter().flatten().copied()
    }

    /// Replaces the imports of a file; returns the paths that it imported before.
    pub(super) fn set(&mut self, file: FileId, entities: Vec<EntityId>, paths: Vec<String>) -> Vec<String> {
        let before = self.forget(file);
        for path in &paths {
            self.importers.entry(path.clone()).or_default().insert(file);
        }
        if !entities.is_empty() {
            self.imports.insert(file, Imports { entities, paths });
        }
        before
    }

    /// Forgets what a file imports; returns the paths.
    pub(super) fn forget(&mut self, file: FileId) -> Vec<String> {
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
}
