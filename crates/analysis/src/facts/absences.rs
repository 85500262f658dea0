//! Why files that are imported are not there.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::entity::FileId;

/// Why a file that is imported cannot be used. The database sees no disk: the caller that reads files for it says so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Absence {
    /// There is no such file.
    Missing,
    /// The path leads to where imports may not lead.
    Outside,
    /// The file is there and cannot be read; in words that go after "because".
    Unreadable(String),
}

/// The known reasons why imported files are absent.
#[derive(Debug, Clone, Default)]
pub(super) struct Absences {
    reasons: FxHashMap<FileId, FxHashMap<String, Absence>>,
    /// The files for which a path is absent, whether they import it now or did before.
    importers: FxHashMap<String, FxHashSet<FileId>>,
}

impl Absences {
    pub(super) fn get(&self, importer: FileId, path: &str) -> Option<&Absence> {
        self.reasons.get(&importer)?.get(path)
    }

    pub(super) fn insert(&mut self, importer: FileId, path: &str, absence: Absence) {
        self.reasons.entry(importer).or_default().insert(path.to_owned(), absence);
        self.importers.entry(path.to_owned()).or_default().insert(importer);
    }

    pub(super) fn remove(&mut self, importer: FileId, path: &str) {
        if let Some(reasons) = self.reasons.get_mut(&importer) {
            reasons.remove(path);
        }
        self.forget_importer(path, importer);
    }

    /// Forgets all that is known of what a file imports.
    pub(super) fn remove_importer(&mut self, importer: FileId) {
        for path in self.reasons.remove(&importer).unwrap_or_default().into_keys() {
            self.forget_importer(&path, importer);
        }
    }

    /// There is a file of this path: only the bounds of imports can keep it from others.
    pub(super) fn remove_path(&mut self, path: &str) {
        let Some(importers) = self.importers.get_mut(path) else { return };
        let reasons = &mut self.reasons;
        importers.retain(|importer| {
            let Some(reasons) = reasons.get_mut(importer) else { return false };
            let is_outside = reasons.get(path) == Some(&Absence::Outside);
            if !is_outside {
                reasons.remove(path);
            }
            is_outside
        });
        if importers.is_empty() {
            self.importers.remove(path);
        }
    }

    fn forget_importer(&mut self, path: &str, importer: FileId) {
        let Some(importers) = self.importers.get_mut(path) else { return };
        importers.remove(&importer);
        if importers.is_empty() {
            self.importers.remove(path);
        }
    }
}
