//! Documents come, change and go.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use pydslrep_analysis::{Database, EditCounts, FileId};
use pydslrep_config::{Config, Problem};
use ropey::Rope;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::keys::path_of;
use crate::scenes::SceneUsers;
use crate::settings::SettingsStore;
use crate::{Document, DocumentKind, FileSystem, ReadError, TextChange, without_byte_order_mark};

/// All documents, their analysis and their settings. A clone shares texts and trees.
#[derive(Debug, Clone)]
pub struct Workspace {
    pub(crate) files: Arc<dyn FileSystem>,
    pub(crate) database: Database,
    pub(crate) documents: FxHashMap<String, Document>,
    /// The folders whose files all belong to the workspace, as keys with `/` at their end.
    pub(crate) folders: Vec<String>,
    pub(crate) settings: SettingsStore,
    pub(crate) scenes: SceneUsers,
    /// Why scenes and settings that exist are not among the documents.
    pub(crate) unreadable: FxHashMap<String, ReadError>,
    pub(crate) changes: Changes,
}

/// Changes that have not been taken yet.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Changes {
    /// Settings changed: nothing is certain.
    pub all: bool,
    /// The keys of documents whose diagnostics may have changed, in order. Some may be gone.
    pub documents: BTreeSet<String>,
}

impl Changes {
    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        !self.all && self.documents.is_empty()
    }
}

impl Workspace {
    /// An empty workspace that reads its files there.
    pub fn new(files: Arc<dyn FileSystem>) -> Self {
        Self {
            files,
            database: Database::new(),
            documents: FxHashMap::default(),
            folders: Vec::new(),
            settings: SettingsStore::default(),
            scenes: SceneUsers::default(),
            unreadable: FxHashMap::default(),
            changes: Changes::default(),
        }
    }

    /// Where files come from; to be asked without holding on to the workspace.
    pub fn files(&self) -> Arc<dyn FileSystem> {
        Arc::clone(&self.files)
    }

    /// The analysis of all programs.
    pub fn database(&self) -> &Database {
        &self.database
    }

    /// A document by its key.
    pub fn document(&self, key: &str) -> Option<&Document> {
        self.documents.get(key)
    }

    /// The document that the database knows as `file`.
    pub fn document_of(&self, file: FileId) -> Option<&Document> {
        self.documents.get(self.database.path(file))
    }

    /// All documents, in no order.
    pub fn documents(&self) -> impl Iterator<Item = &Document> {
        self.documents.values()
    }

    /// Keys in the order in which diagnostics are reported: programs, scenes, settings, each by path.
    pub fn in_order<'a>(keys: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
        let mut keys: Vec<&str> = keys.into_iter().collect();
        keys.sort_unstable_by_key(|key| (DocumentKind::of_document(key), *key));
        keys
    }

    /// Returns the problems of a scene or a `pydslrep.toml`, in the order of the text. For programs ask the database.
    pub fn problems(&self, key: &str) -> Vec<Problem> {
        let Some(document) = self.documents.get(key) else { return Vec::new() };
        match document.kind {
            DocumentKind::Program => Vec::new(),
            DocumentKind::Scene => {
                self.database.scene_problems(self.environment_of_scene(key), &document.text.to_string())
            }
            DocumentKind::Settings => Config::from_toml(&document.text.to_string()).1,
        }
    }

    /// Why a scene or a `pydslrep.toml` that exists is not among the documents.
    pub fn read_error(&self, key: &str) -> Option<&ReadError> {
        self.unreadable.get(key)
    }

    /// Opens a document, or replaces the text of one that is open; from now on its file does not count.
    pub fn open(&mut self, key: &str, text: Rope) {
        self.open_all([(key.to_owned(), text)]);
    }

    /// Opens documents that belong together: none is read from a file because another imports it.
    pub fn open_all(&mut self, documents: impl IntoIterator<Item = (String, Rope)>) {
        self.batch(|this| {
            let mut keys = Vec::new();
            for (key, text) in documents {
                this.insert(&key, text, true);
                keys.push(key);
            }
            for key in &keys {
                match DocumentKind::of_document(key) {
                    DocumentKind::Settings => this.settings_files_changed(),
                    DocumentKind::Scene => this.share_scene(key),
                    DocumentKind::Program => this.follow_imports(key),
                }
            }
            this.forget_unneeded();
        });
        self.follow_scenes();
    }

    /// Makes changes that belong together: problems are looked for once, after all of them.
    pub(crate) fn batch<R>(&mut self, change: impl FnOnce(&mut Self) -> R) -> R {
        if self.database.is_in_batch() {
            return change(self);
        }
        self.database.begin_batch();
        let result = change(self);
        self.database.end_batch();
        result
    }

    /// Makes changes to an open document, one after the other; returns what each of them cost.
    pub fn change(&mut self, key: &str, changes: Vec<TextChange>) -> Vec<EditCounts> {
        let Some(last) = changes.last() else { return Vec::new() };
        let Some(document) = self.documents.get_mut(key) else { return Vec::new() };
        // All of the text before any of the analysis: should that fail, the text is still right.
        document.text = last.after.clone();
        match document.kind {
            DocumentKind::Settings => self.reload_settings(),
            DocumentKind::Scene => {
                self.changes.documents.insert(key.to_owned());
                self.share_scene(key);
            }
            DocumentKind::Program => {
                let Some(file) = document.file else { return Vec::new() };
                let costs = changes.into_iter().map(|TextChange { span, after }| {
                    match span {
                        Some(span) => self.database.edit_to(file, span, after),
                        None => drop(self.database.open_rope(key, after)),
                    }
                    self.database.last_edit()
                });
                let costs = costs.collect();
                self.follow_changed_imports(key);
                self.follow_scenes();
                return costs;
            }
        }
        Vec::new()
    }

    /// Closes a document: from now on its file counts, if there is one. False if it was not open.
    pub fn close(&mut self, key: &str) -> bool {
        let Some(document) = self.documents.get(key).filter(|document| document.is_open) else {
            return false;
        };
        let kind = document.kind;
        self.remove(key);
        match kind {
            DocumentKind::Program | DocumentKind::Scene => self.file_changed(key),
            DocumentKind::Settings => self.settings_files_changed(),
        }
        true
    }

    /// Adds a file that was found on the disk, unless it is there already.
    pub fn add(&mut self, key: &str, text: &str) {
        if !self.documents.contains_key(key) {
            self.batch(|this| {
                this.insert_file(key, text);
                this.follow_imports(key);
            });
            self.follow_scenes();
        }
    }

    /// A file was created, changed or deleted.
    pub fn file_changed(&mut self, key: &str) {
        let is_open = self.documents.get(key).is_some_and(|document| document.is_open);
        match DocumentKind::of_document(key) {
            DocumentKind::Settings => return self.settings_files_changed(),
            DocumentKind::Scene if is_open => return,
            DocumentKind::Scene => return self.scene_file_changed(key),
            DocumentKind::Program => {}
        }
        self.batch(|this| {
            if !is_open {
                this.remove(key);
                if this.is_listed(key)
                    && let Ok(text) = this.files.read(&path_of(key))
                {
                    this.insert_file(key, &text);
                    this.follow_imports(key);
                }
            }
            this.follow_importers(key);
        });
        self.follow_scenes();
    }

    /// Returns whether there is a file with a key, readable or not.
    pub fn is_file(&self, key: &str) -> bool {
        self.files.is_file(&path_of(key))
    }

    /// The folders of the workspace, as keys with `/` at their end.
    pub fn folders(&self) -> &[String] {
        &self.folders
    }

    /// Sets the folders of the workspace; files of others are forgotten unless they are open or imported.
    pub fn set_folders(&mut self, folders: Vec<String>) {
        self.folders = folders;
        self.settings_files_changed();
        self.follow_scenes();
    }

    /// Returns whether a file is in a folder of the workspace.
    pub fn contains(&self, key: &str) -> bool {
        self.folders.iter().any(|folder| key.starts_with(folder.as_str()))
    }

    /// Returns whether a listing of the workspace's folders would find a file.
    pub fn is_listed(&self, key: &str) -> bool {
        let mut folders = self.folders.iter().filter(|folder| key.starts_with(folder.as_str()));
        folders.any(|folder| self.files.lists(&path_of(folder), &path_of(key)))
    }

    /// Changes programs in the database, and follows what they import then.
    pub fn update<R>(&mut self, change: impl FnOnce(&mut Database) -> R) -> R {
        let result = change(&mut self.database);
        for key in self.programs() {
            if let Some(document) = self.documents.get_mut(&key)
                && let Some(text) = document.file.and_then(|file| self.database.text(file))
            {
                document.text = text.clone();
            }
            self.follow_changed_imports(&key);
        }
        self.follow_scenes();
        result
    }

    /// Returns whether [`Self::take_changes`] would return anything.
    pub fn has_changes(&self) -> bool {
        !self.changes.is_empty() || self.database.is_touched()
    }

    /// Returns the changes since the last call.
    pub fn take_changes(&mut self) -> Changes {
        let mut changes = std::mem::take(&mut self.changes);
        for file in self.database.take_touched() {
            let path = self.database.path(file);
            if !path.is_empty() {
                changes.documents.insert(path.to_owned());
            }
            // The problems of a scene depend on the robots in it.
            changes.documents.extend(self.scenes_of(file));
        }
        changes
    }

    /// Analyses all programs again, after a panic that may have left the database half changed. A program that
    /// causes the panic again stays without analysis until it is opened again.
    pub fn rebuild(&mut self) {
        let mut left_out = FxHashSet::default();
        while let Some(failed) = self.try_rebuild(&left_out) {
            left_out.insert(failed);
        }
        self.reload_settings();
        self.batch(|this| {
            for key in this.programs() {
                this.follow_imports(&key);
            }
        });
        self.follow_scenes();
    }

    /// The key of a program that cannot be analysed, if there is one.
    fn try_rebuild(&mut self, left_out: &FxHashSet<String>) -> Option<String> {
        self.database = Database::new();
        self.scenes = SceneUsers::default();
        for (key, document) in &mut self.documents {
            document.file = None;
            if left_out.contains(key) || !document.is_program() {
                continue;
            }
            let text = document.text.clone();
            match catch_unwind(AssertUnwindSafe(|| self.database.open_rope(key, text))) {
                Ok(file) => document.file = Some(file),
                Err(_) => return Some(key.clone()),
            }
        }
        None
    }

    /// The keys of all programs.
    pub(crate) fn programs(&self) -> Vec<String> {
        let programs = self.documents.iter().filter(|(_, document)| document.is_program());
        programs.map(|(key, _)| key.clone()).collect()
    }

    /// Takes in the text of a file.
    pub(crate) fn insert_file(&mut self, key: &str, text: &str) {
        self.insert(key, Rope::from_str(without_byte_order_mark(text)), false);
    }

    /// Takes in a document; what it imports is not followed yet.
    fn insert(&mut self, key: &str, text: Rope, is_open: bool) {
        let settings = Arc::clone(&self.settings.without_file);
        let mut document = Document::new(key, text, is_open, settings);
        if document.is_program() {
            document.file = Some(self.database.open_rope(key, document.text.clone()));
        }
        self.unreadable.remove(key);
        self.changes.documents.insert(key.to_owned());
        self.documents.insert(key.to_owned(), document);
        self.apply_settings(key);
    }

    /// Forgets a document, open or not.
    pub(crate) fn remove(&mut self, key: &str) {
        if let Some(document) = self.documents.remove(key) {
            self.changes.documents.insert(key.to_owned());
            if let Some(file) = document.file {
                self.database.close(file);
            }
        }
    }

    /// Forgets files that are neither open, nor in the workspace, nor needed by a file that is.
    pub(crate) fn forget_unneeded(&mut self) {
        loop {
            let unneeded = self.documents.iter().filter(|(key, document)| !self.is_needed(key, document));
            let unneeded: Vec<String> = unneeded.map(|(key, _)| key.clone()).collect();
            if unneeded.is_empty() {
                return;
            }
            for key in unneeded {
                self.remove(&key);
            }
        }
    }

    fn is_needed(&self, key: &str, document: &Document) -> bool {
        document.is_open
            || self.contains(key)
            || match document.kind {
                DocumentKind::Program => self.is_imported(key, document),
                DocumentKind::Scene => self.scenes.has_users(key),
                DocumentKind::Settings => true,
            }
    }
}
