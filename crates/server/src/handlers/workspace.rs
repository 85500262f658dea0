//! What happens around the documents: folders, files on the disk, settings.

use std::path::Path;

use pydslrep_config::{FILE_NAME, SECTION};
use pydslrep_files::EXTENSION;
use serde_json::Value;
use tower_lsp::ls_types::{
    ConfigurationItem, DidChangeWatchedFilesParams, DidChangeWatchedFilesRegistrationOptions,
    DidChangeWorkspaceFoldersParams, FileSystemWatcher, GlobPattern, MessageType, Registration,
    ShowMessageParams,
};

use crate::log::log;
use crate::message::Outbox;
use crate::server::Server;
use crate::state::State;
use crate::workspace::{MOST_ENTRIES, MOST_PROGRAMS, folders};

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
        let watchers = vec![watch(format!("**/*.{EXTENSION}")), watch(format!("**/{FILE_NAME}"))];
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

/// Takes in all programs of folders; says so in words. To be run beside the message loop: each file is a step of its
/// own, between which messages are handled.
pub(crate) fn index(server: &Server, folders: &[String]) -> String {
    let (mut programs, mut left_out) = (0, false);
    for folder in folders {
        let found = pydslrep_files::find(Path::new(folder), MOST_ENTRIES);
        left_out |= !found.complete;
        for failure in found.failures {
            log(format_args!("cannot look into {failure}"));
        }
        // A folder in another may be left out there.
        let is_open = server.state().folders.contains(folder);
        for path in found.programs {
            if !is_open && !server.state().is_part_of_workspace(&path.to_string_lossy()) {
                continue;
            }
            if programs == MOST_PROGRAMS {
                left_out = true;
                break;
            }
            match pydslrep_files::read(&path) {
                Ok(text) => {
                    server.state().add_found(&path, &text);
                    programs += 1;
                }
                Err(unread) => log(format_args!("cannot read {}: {unread}", path.display())),
            }
        }
    }
    server.settle();
    let so_far =
        if left_out { "; the workspace is large, and the rest is read when it is opened" } else { "" };
    format!("{programs} programs{so_far}")
}
