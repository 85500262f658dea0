//! The script of an environment: its path, and how it is written with each client.

use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use pydslrep_analysis::{Blocked, EntityId};
use pydslrep_syntax::EntityKind;
use serde::Serialize;
use tower_lsp::jsonrpc::{self, Error, ErrorCode};
use tower_lsp::ls_types::notification::ShowMessage;
use tower_lsp::ls_types::{
    CreateFile, CreateFileOptions, DocumentChangeOperation, DocumentChanges, Location, MessageType, OneOf,
    OptionalVersionedTextDocumentIdentifier, Position, Range, ResourceOp, ShowDocumentParams,
    ShowMessageParams, TextDocumentEdit, TextEdit, Uri, WorkspaceEdit,
};

use crate::chosen::ChosenEnvironment;
use crate::documents::{Document, key};
use crate::message::Outbox;
use crate::state::State;

/// A line after the last of any script: the protocol clamps it to the document's end.
const PAST_THE_END: u32 = 1 << 30;

/// A script, ready to be written.
pub(crate) struct Script {
    /// Where it goes.
    pub(crate) uri: Uri,
    /// Its text.
    pub(crate) text: String,
}

impl Script {
    /// Its name without the folder.
    pub(crate) fn file_name(&self) -> &str {
        self.uri.as_str().rsplit('/').next().unwrap_or_default()
    }
}

/// Generates a script.
///
/// # Errors
///
/// If the document is not open or was never saved, or the environment does not exist or has errors.
pub(crate) fn generate(state: &State, which: &ChosenEnvironment) -> jsonrpc::Result<Script> {
    let id = environment(state, which)?;
    let program = state.document(&which.uri).and_then(Document::uri);
    of_environment(state, program.as_ref().unwrap_or(&which.uri), id)
}

/// The environment that is meant.
///
/// # Errors
///
/// If the document is not open, or has no such environment.
pub(crate) fn environment(state: &State, which: &ChosenEnvironment) -> jsonrpc::Result<EntityId> {
    let (_, file) = state
        .analysed(&which.uri)
        .ok_or_else(|| failure(format!("`{}` is not open in the editor", which.uri.as_str())))?;
    let name = which.environment.as_str().into();
    let declared = state.database().definitions(file, EntityKind::Environment, &name);
    let first = declared.first().copied();
    first.ok_or_else(|| failure(format!("there is no environment `{}`", which.environment)))
}

/// Generates the script of an environment.
///
/// # Errors
///
/// If it has errors, or its program was never saved.
pub(crate) fn of_environment(state: &State, program: &Uri, id: EntityId) -> jsonrpc::Result<Script> {
    let environment = state.database().environment(id).map_err(|errors| blocked(state, &errors))?;
    let target = state.document(program).map(|document| document.settings.target).unwrap_or_default();
    let file_name = pydslrep_script::file_name(&environment);
    let uri = match state.workspace.output_folder(&key(program)) {
        Some(folder) => Uri::from_file_path(Path::new(&folder).join(file_name)),
        None => address(program, &file_name),
    };
    let uri = uri.ok_or_else(unsaved)?;
    let text = pydslrep_script::generate(&environment, target).map_err(|error| failure(error.to_string()))?;
    Ok(Script { uri, text })
}

/// What a client can do about a failure, in the `data` of the error.
#[derive(Debug, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
enum Cause {
    /// The program was never saved.
    Unsaved,
    /// There are errors; the first is here, if the client can find it.
    Errors { location: Option<Location> },
}

/// Why a document that was never saved has no script.
fn unsaved() -> Error {
    with_cause("save the file first; the script is written next to it".to_owned(), &Cause::Unsaved)
}

/// Why an environment with errors is neither run nor translated.
pub(crate) fn blocked(state: &State, blocked: &Blocked) -> Error {
    let first = blocked.errors.first();
    let location = first.and_then(|error| state.location(error.file, error.span));
    with_cause(blocked.reason(), &Cause::Errors { location })
}

fn with_cause(message: String, cause: &Cause) -> Error {
    Error { data: serde_json::to_value(cause).ok(), ..failure(message) }
}

/// The script's URI unless a folder is set: in the program's folder. `None` if the program has none.
fn address(program: &Uri, file_name: &str) -> Option<Uri> {
    let whole = program.as_str();
    let address = whole.split(['?', '#']).next()?;
    // An unnamed buffer's `file://` has no path: a name after its slashes would be a host.
    let has_path = program.path().as_str().contains('/');
    let (folder, _) = address.rsplit_once('/').filter(|_| has_path)?;
    Uri::from_str(&format!("{folder}/{file_name}")).ok()
}

/// The edit that creates or replaces a script.
///
/// The whole text of an existing file is replaced, in the editor's buffer if it is open there, so that this can be
/// undone. A file is created only where none is known to exist. Its text is replaced too, not inserted: a buffer of
/// that name may be open and unsaved, and Neovim would keep the empty line of its empty buffers.
pub(crate) fn edit(script: &Script) -> WorkspaceEdit {
    let everything = Range::new(Position::new(0, 0), Position::new(PAST_THE_END, 0));
    let replace = TextEdit::new(everything, script.text.clone());
    let text_document = OptionalVersionedTextDocumentIdentifier { uri: script.uri.clone(), version: None };
    let edit = TextDocumentEdit { text_document, edits: vec![OneOf::Left(replace)] };
    let mut operations = vec![DocumentChangeOperation::Edit(edit)];
    if !path(&script.uri).is_some_and(|path| path.exists()) {
        let options = CreateFileOptions { overwrite: Some(true), ignore_if_exists: None };
        let create = CreateFile { uri: script.uri.clone(), options: Some(options), annotation_id: None };
        operations.insert(0, DocumentChangeOperation::Op(ResourceOp::Create(create)));
    }
    let document_changes = Some(DocumentChanges::Operations(operations));
    WorkspaceEdit { document_changes, ..WorkspaceEdit::default() }
}

/// The command `pydslrep.generateScript`, for clients that cannot create files: writes the script; returns its URI.
///
/// # Errors
///
/// As [`generate`], or if the script cannot be written.
pub(crate) fn write_script(
    state: &State,
    which: &ChosenEnvironment,
    outbox: &Outbox,
) -> jsonrpc::Result<Uri> {
    let script = generate(state, which)?;
    let path = path(&script.uri).ok_or_else(unsaved)?;
    write(&path, &script.text).map_err(failure)?;
    tell(outbox, MessageType::INFO, format!("Script written: {}", script.file_name()));
    Ok(script.uri)
}

/// Writes the scripts of all environments without errors, if that is set. Each script is reported once, and so is each
/// that cannot be written: on every save would be too often.
pub(crate) fn save(state: &mut State, program: &Uri, outbox: &Outbox) {
    let Some((document, file)) = state.analysed(program) else { return };
    if !document.settings.generate_on_save {
        return;
    }
    let uri = document.uri().unwrap_or_else(|| program.clone());
    let environments = state.database().environments(file);
    let generated = environments.iter().filter_map(|(id, _)| of_environment(state, &uri, *id).ok());
    let scripts: Vec<Script> = generated.collect();
    for script in scripts {
        let Some(path) = path(&script.uri) else { continue };
        let (kind, message) = match write(&path, &script.text) {
            Ok(()) => (MessageType::INFO, format!("Script written: {} (on every save)", script.file_name())),
            Err(reason) => (MessageType::WARNING, reason),
        };
        if state.reported.insert(message.clone()) {
            tell(outbox, kind, message);
        }
    }
}

/// Writes a script, but never over a file that is not a generated script; the error is the reason.
fn write(path: &Path, text: &str) -> Result<(), String> {
    let before = fs::read(path);
    // This cannot be undone in the editor.
    if before.as_ref().is_ok_and(|content| !pydslrep_script::may_replace(content)) {
        let reason = "already exists and is not a generated script; move it, or rename the environment";
        return Err(format!("{} {reason}", path.display()));
    }
    if before.is_ok_and(|content| content == text.as_bytes()) {
        return Ok(());
    }
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    folder
        .and_then(|()| fs::write(path, text))
        .map_err(|error| format!("cannot write {}: {error}", path.display()))
}

fn tell(outbox: &Outbox, typ: MessageType, message: String) {
    outbox.send_notification::<ShowMessage>(&ShowMessageParams { typ, message });
}

/// The request to show a script next to its program.
pub(crate) fn show(uri: Uri) -> ShowDocumentParams {
    ShowDocumentParams { uri, external: Some(false), take_focus: Some(false), selection: None }
}

/// The error for a request that is valid but cannot be done.
pub(crate) fn failure(message: String) -> Error {
    // The protocol's code for requests that fail although they are valid.
    Error { code: ErrorCode::ServerError(-32803), message: message.into(), data: None }
}

fn path(uri: &Uri) -> Option<PathBuf> {
    if !uri.scheme().as_str().eq_ignore_ascii_case("file") {
        return None;
    }
    uri.to_file_path().map(std::borrow::Cow::into_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_goes_beside_its_program() {
        let address = |program: &str| {
            address(&Uri::from_str(program).unwrap(), "area_1.py").map(|uri| uri.as_str().to_owned())
        };
        assert_eq!(address("file:///c%3A/a%20b/x.pyr").as_deref(), Some("file:///c%3A/a%20b/area_1.py"));
        assert_eq!(
            address("vscode-vfs://github/o/r/x.pyr?q=/1#f").as_deref(),
            Some("vscode-vfs://github/o/r/area_1.py")
        );
        assert_eq!(address("untitled:Untitled-1"), None);
        assert_eq!(address("file://"), None, "what an unnamed buffer of Neovim is called");
    }
}
