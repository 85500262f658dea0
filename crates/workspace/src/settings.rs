//! Settings: what a `pydslrep.toml` says for the programs in its folder and below, and what a caller says over it.

use std::path::Path;
use std::sync::Arc;

use pydslrep_config::{Config, Settings};
use pydslrep_text::file_names::SETTINGS_FILE;
use rustc_hash::FxHashMap;

use crate::keys::path_of;
use crate::{DocumentKind, Workspace};

/// The settings and their sources.
#[derive(Debug, Clone, Default)]
pub(crate) struct SettingsStore {
    /// Settings from the caller: an editor, or the options of a command. It wins over any file.
    overrides: Config,
    /// The settings where no file holds.
    pub(crate) without_file: Arc<Settings>,
    /// The settings of each file, by its key.
    files: FxHashMap<String, Arc<Settings>>,
    /// The key of the settings file that holds for a folder.
    nearest: FxHashMap<String, Option<String>>,
}

impl SettingsStore {
    fn new(overrides: Config) -> Self {
        let without_file = Arc::new(overrides.clone().settings());
        Self { overrides, without_file, ..Self::default() }
    }
}

impl Workspace {
    /// Sets what wins over all settings files.
    pub fn set_overrides(&mut self, overrides: Config) {
        if self.settings.overrides != overrides {
            self.settings.overrides = overrides;
            self.reload_settings();
        }
    }

    /// The key of the settings file that holds for a program: the nearest one above it, readable or not.
    pub fn settings_file(&self, program: &str) -> Option<&str> {
        self.settings.nearest.get(folder(program)?)?.as_deref()
    }

    /// The folder for the scripts of a program: relative to the settings file that names it or, if the caller names
    /// it, to the folder of the workspace. `None` if neither does.
    pub fn output_folder(&self, program: &str) -> Option<String> {
        let own = folder(program)?;
        let output = self.documents.get(program)?.settings.output.as_deref()?;
        let base = if self.settings.overrides.sets_output() {
            let around = self.folders.iter().filter(|folder| program.starts_with(folder.as_str()));
            around.max_by_key(|folder| folder.len()).map_or(own, |folder| folder.trim_end_matches('/'))
        } else {
            folder(self.settings_file(program)?)?
        };
        Some(format!("{base}/{output}"))
    }

    /// Reads all settings files again and applies what they say.
    pub(crate) fn reload_settings(&mut self) {
        let overrides = std::mem::take(&mut self.settings.overrides);
        self.settings = SettingsStore::new(overrides);
        let is_settings = |key: &str| DocumentKind::of_document(key) == DocumentKind::Settings;
        let read = self.documents.iter().filter(|(key, document)| is_settings(key) && !document.is_open);
        let read: Vec<String> = read.map(|(key, _)| key.clone()).collect();
        for key in read {
            self.remove(&key);
        }
        self.unreadable.retain(|key, _| !is_settings(key));
        for key in self.programs() {
            self.apply_settings(&key);
        }
        self.changes.all = true;
    }

    /// Settings files may have come, gone or changed, which may change how far imports lead.
    pub fn settings_files_changed(&mut self) {
        self.reload_settings();
        for key in self.programs() {
            self.follow_imports(&key);
        }
        self.forget_unneeded();
    }

    /// Applies to a program what is set for its folder.
    pub(crate) fn apply_settings(&mut self, key: &str) {
        if !self.documents.get(key).is_some_and(crate::Document::is_program) {
            return;
        }
        let file = self.find_settings(key);
        let SettingsStore { without_file, files, .. } = &self.settings;
        let settings = file.and_then(|file| files.get(&file)).unwrap_or(without_file);
        let Some(document) = self.documents.get_mut(key) else { return };
        document.settings = Arc::clone(settings);
        if let Some(file) = document.file {
            self.database.set_target(file, settings.target);
            self.database.set_edition(file, settings.edition);
        }
    }

    /// Returns whether a path is in the folder of the importing file's settings or, without any, in its own.
    pub(crate) fn is_in_project(&self, importer: &str, path: &str) -> bool {
        let bound = self.settings_file(importer).and_then(folder).or_else(|| folder(importer));
        bound.and_then(|bound| path.strip_prefix(bound)).is_some_and(|rest| rest.starts_with('/'))
    }

    /// Finds the settings file of a program, and reads it if that is still to do.
    fn find_settings(&mut self, program: &str) -> Option<String> {
        let folder = folder(program)?;
        if let Some(known) = self.settings.nearest.get(folder) {
            return known.clone();
        }
        let candidates = Path::new(folder).ancestors().map(|folder| key_in(folder, SETTINGS_FILE));
        let file = { candidates }
            .find(|file| self.documents.contains_key(file) || self.files.is_file(&path_of(file)));
        self.settings.nearest.insert(folder.to_owned(), file.clone());
        if let Some(file) = &file {
            self.read_settings(file);
        }
        file
    }

    fn read_settings(&mut self, key: &str) {
        if self.settings.files.contains_key(key) || self.unreadable.contains_key(key) {
            return;
        }
        if !self.documents.contains_key(key) {
            match self.files.read(&path_of(key)) {
                Ok(text) => self.insert_file(key, &text),
                Err(error) => {
                    self.unreadable.insert(key.to_owned(), error);
                    return;
                }
            }
        }
        if let Some(document) = self.documents.get(key) {
            let (config, _) = Config::from_toml(&document.text.to_string());
            let settings = self.settings.overrides.clone().merged_over(config).settings();
            self.settings.files.insert(key.to_owned(), Arc::new(settings));
        }
    }
}

/// The folder of a file, without `/` at its end; `None` for a buffer without a file.
pub(crate) fn folder(key: &str) -> Option<&str> {
    let (folder, _) = key.rsplit_once('/')?;
    Path::new(key).has_root().then_some(folder)
}

fn key_in(folder: &Path, name: &str) -> String {
    format!("{}/{name}", folder.to_string_lossy().trim_end_matches('/'))
}
