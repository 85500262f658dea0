//! Changes around the documents: folders, files on the disk, settings.

use pydslrep_config::{FILE_NAME, SECTION};
use pydslrep_scene::ENDING;
use pydslrep_text::file_names::PROGRAM_EXTENSION as EXTENSION;
use tower_lsp::ls_types::notification::{DidChangeConfiguration, DidChangeWatchedFiles, Notification};
use tower_lsp::ls_types::{
    DidChangeConfigurationParams, DidChangeWatchedFilesParams, DidChangeWatchedFilesRegistrationOptions,
    DidChangeWorkspaceFoldersParams, FileSystemWatcher, GlobPattern, InitializedParams, OneOf, Registration,
    ServerCapabilities, WorkspaceFolder, WorkspaceFoldersServerCapabilities,
};

use crate::client::ClientFeatures;
use crate::documents::folders;
use crate::handlers::settings;
use crate::log::log;
use crate::server::Server;
use crate::view::View;

/// Asks to be notified when files change, and settings.
fn registrations(view: &View) -> Vec<Registration> {
    let mut wanted = Vec::new();
    if view.client.watched_files {
        let watch = |glob: String| FileSystemWatcher { glob_pattern: GlobPattern::String(glob), kind: None };
        let globs = [format!("**/*.{EXTENSION}"), format!("**/{FILE_NAME}"), format!("**/*{ENDING}")];
        let watchers = globs.map(watch).to_vec();
        let options = DidChangeWatchedFilesRegistrationOptions { watchers };
        wanted.push(Registration {
            id: "files".to_owned(),
            method: DidChangeWatchedFiles::METHOD.to_owned(),
            register_options: serde_json::to_value(options).ok(),
        });
    }
    if view.client.registers_settings {
        wanted.push(Registration {
            id: "settings".to_owned(),
            method: DidChangeConfiguration::METHOD.to_owned(),
            register_options: serde_json::to_value(serde_json::json!({ "section": SECTION })).ok(),
        });
    }
    wanted
}

pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    let workspace = server.workspace.get_or_insert_default();
    workspace.workspace_folders = Some(WorkspaceFoldersServerCapabilities {
        supported: Some(true),
        change_notifications: Some(OneOf::Left(true)),
    });
}

/// `initialized`: the first moment at which the client can be asked for anything.
pub(crate) async fn start(server: Server, _: InitializedParams) {
    let (registrations, folders) = {
        let state = server.state();
        (registrations(&state.view), state.view.workspace.folders().to_vec())
    };
    if !registrations.is_empty()
        && let Err(error) = server.client.register_capability(registrations).await
    {
        log(format_args!("the client does not report changes of files or settings: {error}"));
    }
    server.ask_for_settings().await;
    server.index(folders).await;
}

/// `workspace/didChangeWatchedFiles`.
pub(crate) async fn files_changed(server: Server, params: DidChangeWatchedFilesParams) {
    for change in params.changes {
        server.state().file_changed(&change.uri);
    }
    server.refresh().await;
}

/// `workspace/didChangeWorkspaceFolders`.
pub(crate) async fn folders_changed(server: Server, params: DidChangeWorkspaceFoldersParams) {
    let of = |list: &[WorkspaceFolder]| folders(list.iter().map(|folder| &folder.uri));
    let (removed, added) = (of(&params.event.removed), of(&params.event.added));
    {
        let mut state = server.state();
        let mut now = state.view.workspace.folders().to_vec();
        now.retain(|folder| !removed.contains(folder));
        now.extend(added.iter().cloned());
        state.workspace_mut().set_folders(now);
    }
    server.index(added).await;
}

/// `workspace/didChangeConfiguration`.
pub(crate) async fn settings_changed(server: Server, params: DidChangeConfigurationParams) {
    // Clients that can be asked send nothing here, or not everything.
    if server.state().view.client.settings {
        server.ask_for_settings().await;
    } else {
        settings::set(&mut server.state(), &params.settings, &server.outbox);
    }
    server.refresh().await;
}
