//! What happens around the documents: folders, files on the disk, settings.

use pydslrep_config::{FILE_NAME, SECTION};
use pydslrep_files::EXTENSION;
use pydslrep_scene::ENDING;
use serde_json::Value;
use tower_lsp::ls_types::{
    ConfigurationItem, DidChangeWatchedFilesParams, DidChangeWatchedFilesRegistrationOptions,
    DidChangeWorkspaceFoldersParams, FileSystemWatcher, GlobPattern, MessageType, Registration,
    ShowMessageParams,
};

use crate::message::Outbox;
use crate::state::State;
use crate::workspace::folders;

/// The section of the client's settings that is ours.
pub(crate) fn wanted_settings() -> Vec<ConfigurationItem> {
    vec![ConfigurationItem { scope_uri: None, section: Some(SECTION.to_owned()) }]
}

/// Takes in what the client has set; what is wrong with it is told.
pub(crate) fn set(state: &mut State, settings: &Value, outbox: &Outbox) {
    for problem in state.set_client_settings(settings) {
        let help = problem.help.map(|help| format!(" ({help})")).unwrap_or_default();
        let message = format!("settings of PyDSLRep: {}{help}", problem.message);
        outbox.notify("window/showMessage", &ShowMessageParams { typ: MessageType::WARNING, message });
    }
}

/// The request to be told when files change, and settings.
pub(crate) fn registrations(state: &State) -> Vec<Registration> {
    let mut wanted = Vec::new();
    if state.client.watched_files {
        let watch = |glob: String| FileSystemWatcher { glob_pattern: GlobPattern::String(glob), kind: None };
        let globs = [format!("**/*.{EXTENSION}"), format!("**/{FILE_NAME}"), format!("**/*{ENDING}")];
        let watchers = globs.map(watch).to_vec();
        let options = DidChangeWatchedFilesRegistrationOptions { watchers };
        wanted.push(Registration {
            id: "files".to_owned(),
            method: "workspace/didChangeWatchedFiles".to_owned(),
            register_options: serde_json::to_value(options).ok(),
        });
    }
    if state.client.registers_settings {
        wanted.push(Registration {
            id: "settings".to_owned(),
            method: "workspace/didChangeConfiguration".to_owned(),
            register_options: serde_json::to_value(serde_json::json!({ "section": SECTION })).ok(),
        });
    }
    wanted
}

/// `workspace/didChangeWatchedFiles`.
pub(crate) fn files_changed(state: &mut State, params: &DidChangeWatchedFilesParams) {
    for change in &params.changes {
        state.file_changed(&change.uri);
    }
}

/// `workspace/didChangeWorkspaceFolders`; returns the folders that are new.
pub(crate) fn folders_changed(state: &mut State, params: &DidChangeWorkspaceFoldersParams) -> Vec<String> {
    let of = |list: &[tower_lsp::ls_types::WorkspaceFolder]| folders(list.iter().map(|folder| &folder.uri));
    let (removed, added) = (of(&params.event.removed), of(&params.event.added));
    let mut now = std::mem::take(&mut state.folders);
    now.retain(|folder| !removed.contains(folder));
    now.extend(added.iter().cloned());
    state.set_folders(now);
    added
}
