//! File operations in the client's own tree: `workspace/willRenameFiles` asks before, `workspace/didRenameFiles`,
//! `didCreateFiles` and `didDeleteFiles` notify afterwards.
//!
//! A client that also watches files reports the same twice, which does no harm.

use std::str::FromStr;

use pydslrep_analysis::Edit;
use pydslrep_config::FILE_NAME;
use pydslrep_ide as ide;
use pydslrep_scene::ENDING;
use pydslrep_text::file_names::PROGRAM_EXTENSION as EXTENSION;
use pydslrep_workspace::path_of;
use tower_lsp::ls_types::{
    CreateFilesParams, DeleteFilesParams, FileOperationFilter, FileOperationPattern,
    FileOperationPatternKind, FileOperationRegistrationOptions, RenameFilesParams, ServerCapabilities, Uri,
    WorkspaceEdit, WorkspaceFileOperationsServerCapabilities,
};

use crate::client::ClientFeatures;
use crate::documents::folders;
use crate::documents::key;
use crate::handlers::code_actions;
use crate::server::Server;
use crate::state::State;
use crate::view::View;

/// The operations that matter to programs: on themselves, on folders, which may hold some, on settings and on scenes.
pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    let filter = |glob: String, kind: FileOperationPatternKind| FileOperationFilter {
        scheme: Some("file".to_owned()),
        pattern: FileOperationPattern { glob, matches: Some(kind), options: None },
    };
    let programs = filter(format!("**/*.{EXTENSION}"), FileOperationPatternKind::File);
    let settings = filter(format!("**/{FILE_NAME}"), FileOperationPatternKind::File);
    let scenes = filter(format!("**/*{ENDING}"), FileOperationPatternKind::File);
    let folders = filter("**".to_owned(), FileOperationPatternKind::Folder);
    let all = FileOperationRegistrationOptions {
        filters: vec![programs.clone(), settings, scenes.clone(), folders.clone()],
    };
    let workspace = server.workspace.get_or_insert_default();
    workspace.file_operations = Some(WorkspaceFileOperationsServerCapabilities {
        will_rename: Some(FileOperationRegistrationOptions { filters: vec![programs, scenes, folders] }),
        did_rename: Some(all.clone()),
        did_create: Some(all.clone()),
        did_delete: Some(all),
        ..WorkspaceFileOperationsServerCapabilities::default()
    });
}

/// The edits that keep all imports valid, and environments of the same name as their scenes; `None` where none is
/// needed.
pub(crate) fn will_rename(view: &View, params: &RenameFilesParams) -> Option<WorkspaceEdit> {
    let path = |uri: &str| Some(key(&Uri::from_str(uri).ok()?).trim_end_matches('/').to_owned());
    let renames: Vec<ide::FileRename> = params
        .files
        .iter()
        .filter_map(|file| Some(ide::FileRename { from: path(&file.old_uri)?, to: path(&file.new_uri)? }))
        .collect();
    let mut edits = ide::rename_files(view.database(), &renames);
    edits.extend(renames.iter().flat_map(|rename| environment_renamed(view, rename)));
    (!edits.is_empty()).then(|| code_actions::workspace_edit(view, &edits))
}

/// The edits that give the environment of a scene its new name, where that is one.
fn environment_renamed(view: &View, rename: &ide::FileRename) -> Vec<Edit> {
    let parts = |path: &str| {
        let (folder, name) = path.rsplit_once('/')?;
        Some((folder.to_owned(), name.strip_suffix(ENDING)?.to_owned()))
    };
    let (Some((from, _)), Some((to, name))) = (parts(&rename.from), parts(&rename.to)) else {
        return Vec::new();
    };
    // In another folder it is the scene of other programs.
    if from != to {
        return Vec::new();
    }
    let environments = view.workspace.environments_of_scene(&rename.from).into_iter();
    let edits = environments.filter_map(|id| {
        let position = ide::declaration(view.database(), id)?;
        ide::rename(view.database(), position, &name).ok()
    });
    edits.flatten().collect()
}

/// `workspace/didRenameFiles`.
pub(crate) async fn did_rename(server: Server, params: RenameFilesParams) {
    let added = {
        let mut state = server.state();
        remove(&mut state, params.files.iter().map(|file| file.old_uri.as_str()));
        add(&mut state, params.files.iter().map(|file| file.new_uri.as_str()))
    };
    server.index(added).await;
    server.refresh().await;
}

/// `workspace/didCreateFiles`.
pub(crate) async fn did_create(server: Server, params: CreateFilesParams) {
    let added = add(&mut server.state(), params.files.iter().map(|file| file.uri.as_str()));
    server.index(added).await;
    server.refresh().await;
}

/// `workspace/didDeleteFiles`.
pub(crate) async fn did_delete(server: Server, params: DeleteFilesParams) {
    remove(&mut server.state(), params.files.iter().map(|file| file.uri.as_str()));
    server.refresh().await;
}

/// Handles files and folders, by their URIs, that are gone.
fn remove<'a>(state: &mut State, addresses: impl Iterator<Item = &'a str>) {
    for uri in addresses.filter_map(|address| Uri::from_str(address).ok()) {
        let [folder] = &folders([&uri])[..] else { continue };
        let inside = state.view.workspace.documents().filter(|document| document.key.starts_with(folder));
        let inside: Vec<String> = inside.map(|document| document.key.clone()).collect();
        state.file_changed(&uri);
        for key in inside {
            state.workspace_mut().file_changed(&key);
        }
    }
}

/// Handles new files and folders; returns the folders of the workspace among them, which may contain programs.
fn add<'a>(state: &mut State, addresses: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut new = Vec::new();
    for uri in addresses.filter_map(|address| Uri::from_str(address).ok()) {
        if !path_of(&key(&uri)).is_dir() {
            state.file_changed(&uri);
            continue;
        }
        new.extend(folders([&uri]).into_iter().filter(|folder| state.view.workspace.contains(folder)));
        // It may contain a file of settings.
        state.workspace_mut().settings_files_changed();
    }
    new
}
