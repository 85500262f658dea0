//! What is set for each document: by the client, and by the `pydslrep.toml` that is nearest to it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pydslrep_config::{Config, FILE_NAME, Problem};
use pydslrep_files::project_folder;
use rustc_hash::FxHashMap;
use serde_json::Value;

use tower_lsp::ls_types::Uri;

use super::State;
use crate::documents::{Sort, key};

/// What is set, and where.
#[derive(Debug, Default)]
pub(crate) struct SettingsStore {
    /// What the client says; it counts more than any file.
    client: Config,
    /// What the files say, by their keys.
    files: FxHashMap<String, Config>,
    /// The key of the file that is nearest to a folder.
    nearest: FxHashMap<String, Option<String>>,
}

impl State {
    /// Takes in what the client says; returns what is wrong with it.
    pub(crate) fn set_client_settings(&mut self, value: &Value) -> Vec<Problem> {
        let (config, problems) = Config::from_json(value);
        if self.settings.client != config {
            self.settings.client = config;
            self.reload_settings();
        }
        problems
    }

    /// Reads all settings files again and applies what they say.
    pub(crate) fn reload_settings(&mut self) {
        let client = std::mem::take(&mut self.settings.client);
        self.settings = SettingsStore { client, ..SettingsStore::default() };
        let read = self.documents.iter();
        let read: Vec<String> = read
            .filter(|(_, document)| document.sort() == Sort::Settings && document.version.is_none())
            .map(|(key, _)| key.clone())
            .collect();
        for key in read {
            self.remove(&key);
        }
        let programs = self.documents.iter().filter(|(_, document)| document.is_program());
        let programs: Vec<String> = programs.map(|(key, _)| key.clone()).collect();
        for key in programs {
            self.apply_settings(&key);
        }
        self.stale.all = true;
        // They may say where an environment stands.
        for watched in &mut self.watched {
            watched.fingerprint = None;
        }
    }

    /// Sets for a program what is set for its folder.
    pub(crate) fn apply_settings(&mut self, key: &str) {
        let file = self.settings_file(key);
        let config = file.and_then(|file| self.settings.files.get(&file).cloned()).unwrap_or_default();
        let settings = self.settings.client.clone().merged_over(config).settings();
        let Some(document) = self.documents.get_mut(key) else { return };
        if let Some(file) = document.file {
            self.database.set_target(file, settings.target);
        }
        if *document.settings != settings {
            document.settings = Arc::new(settings);
        }
    }

    /// The folder for the scripts of a program: beside the file that says so, or in the client's folder if the client
    /// does. `None` if nobody does.
    pub(crate) fn output_folder(&self, program: &Uri) -> Option<PathBuf> {
        let key = key(program);
        let folder = key.rsplit_once('/').filter(|_| key.starts_with('/'))?.0;
        let output = self.documents.get(&key)?.settings.output.clone()?;
        let base = if self.settings.client.sets_output() {
            let open = self.folders.iter().filter(|open| key.starts_with(open.as_str()));
            open.max_by_key(|open| open.len()).map_or(folder, String::as_str)
        } else {
            let file = self.settings.nearest.get(folder)?.as_ref()?;
            file.rsplit_once('/')?.0
        };
        Some(Path::new(base).join(output))
    }

    /// The key of the settings file that a program belongs to; it is read if it was not yet.
    fn settings_file(&mut self, key: &str) -> Option<String> {
        let folder = key.rsplit_once('/').filter(|_| key.starts_with('/'))?.0;
        if let Some(known) = self.settings.nearest.get(folder) {
            return known.clone();
        }
        let file = project_folder(Path::new(key)).map(|folder| folder.join(FILE_NAME));
        let file = file.and_then(|file| self.read_settings(&file));
        self.settings.nearest.insert(folder.to_owned(), file.clone());
        file
    }

    /// Reads a settings file, from the client if it is open there; returns its key.
    fn read_settings(&mut self, path: &Path) -> Option<String> {
        let key = path.to_str()?.to_owned();
        if self.settings.files.contains_key(&key) {
            return Some(key);
        }
        if !self.documents.contains_key(&key) {
            let text = pydslrep_files::read(path).ok()?;
            self.add_found(path, &text);
        }
        let text = self.documents.get(&key)?.text.to_string();
        self.settings.files.insert(key.clone(), Config::from_toml(&text).0);
        Some(key)
    }
}
