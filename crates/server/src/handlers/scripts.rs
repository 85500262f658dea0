//! The script of an environment: its path, and how it is written with each client.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use futures::channel::oneshot;
use pydslrep_analysis::environment::Environment;
use pydslrep_analysis::{Blocked, EntityId, FileId};
use pydslrep_output::{
    Changed, Kind, WriteError, check_inside, check_script, write_script as write_script_file,
};
use pydslrep_script::{Origin, origin};
use pydslrep_syntax::EntityKind;
use pydslrep_workspace::{FileSystem, MemoryFiles, ReadError};
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::{self, Error, ErrorCode};
use tower_lsp::ls_types::request::Request;
use tower_lsp::ls_types::{
    CreateFileOptions, Location, MessageActionItem, MessageType, Position, Range, ShowDocumentParams,
    ShowMessageRequestParams, TextEdit, Uri, WorkspaceEdit,
};

use crate::chosen::ChosenEnvironment;
use crate::documents::{Document, key, uri_of};
use crate::edits;
use crate::message::Outbox;
use crate::state::State;
use crate::view::View;

/// A line after the last of any script: the protocol clamps it to the document's end.
const PAST_THE_END: u32 = 1 << 30;

/// A script, ready to be written.
pub(crate) struct Script {
    /// Where it goes.
    pub(crate) uri: Uri,
    /// Its text.
    pub(crate) text: String,
    /// The number of last folders of its path that the settings name.
    depth: usize,
    /// True if the settings want the package that it imports next to it.
    needs_runtime: bool,
    /// The files that the client provides, where there is no disk.
    provided: Option<Arc<MemoryFiles>>,
}

impl Script {
    /// Its name without the folder.
    pub(crate) fn file_name(&self) -> &str {
        self.uri.as_str().rsplit('/').next().unwrap_or_default()
    }

    /// Why it may not be written; `None` if it may.
    pub(crate) fn obstacle(&self) -> Option<WriteError> {
        if let Some(files) = &self.provided {
            return obstacle_in_memory(files, Path::new(&key(&self.uri)));
        }
        self.check(&path(&self.uri)?, Changed::Keep).err()
    }

    fn check(&self, path: &Path, changed: Changed) -> Result<(), WriteError> {
        check_inside(path.parent().unwrap_or(path), self.depth)?;
        check_script(path, changed).map(drop)
    }

    /// Writes it, but never over a file that is not a generated script; the error is the reason.
    fn write(&self, path: &Path, changed: Changed) -> Result<(), String> {
        let written = self.check(path, changed).and_then(|()| write_script_file(path, &self.text, changed));
        written.map_err(|error| reason(&error))
    }

    /// The folder that needs the package; `None` if none does, or it is not on this disk.
    pub(crate) fn runtime_folder(&self) -> Option<PathBuf> {
        let path = path(&self.uri).filter(|_| self.needs_runtime && self.provided.is_none())?;
        path.parent().map(Path::to_owned)
    }

    /// Returns whether a file is known to be in its place.
    fn exists(&self) -> bool {
        match &self.provided {
            Some(files) => files.is_file(Path::new(&key(&self.uri))),
            None => path(&self.uri).is_some_and(|path| path.exists()),
        }
    }
}

/// As [`Script::obstacle`], among files in memory.
fn obstacle_in_memory(files: &MemoryFiles, path: &Path) -> Option<WriteError> {
    match files.read(path).as_deref().map(|text| origin(text.as_bytes())) {
        Ok(Origin::Generated) | Err(ReadError::Missing) => None,
        Ok(Origin::Changed) => Some(WriteError::Changed(path.to_owned())),
        Ok(Origin::Foreign) | Err(_) => Some(WriteError::Foreign(path.to_owned(), Kind::Script)),
    }
}

/// `pydslrep/script`: the script of an environment as a text, for clients that put it elsewhere than into a file.
pub(crate) enum GeneratedScript {}

impl Request for GeneratedScript {
    type Params = ChosenEnvironment;
    type Result = ScriptText;
    const METHOD: &'static str = "pydslrep/script";
}

/// A script.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ScriptText {
    /// The file that it would be written to.
    uri: Uri,
    text: String,
}

/// `pydslrep/script`.
pub(crate) fn script(view: &View, which: &ChosenEnvironment) -> jsonrpc::Result<ScriptText> {
    generate(view, which).map(|script| ScriptText { uri: script.uri, text: script.text })
}

/// Generates a script.
///
/// # Errors
///
/// If the document is not open or was never saved, or the environment does not exist or has errors.
pub(crate) fn generate(view: &View, which: &ChosenEnvironment) -> jsonrpc::Result<Script> {
    let id = environment(view, which)?;
    let program = view.document(&which.uri).and_then(Document::uri);
    of_environment(view, program.as_ref().unwrap_or(&which.uri), id)
}

/// The chosen environment.
///
/// # Errors
///
/// If the document is not open, or has no such environment.
pub(crate) fn environment(view: &View, which: &ChosenEnvironment) -> jsonrpc::Result<EntityId> {
    let (_, file) = opened(view, &which.uri)?;
    let name = which.environment.as_str().into();
    let declared = view.database().definitions(file, EntityKind::Environment, &name);
    let first = declared.first().copied();
    first.ok_or_else(|| failure(format!("there is no environment `{}`", which.environment)))
}

/// Generates the script of an environment.
///
/// # Errors
///
/// If it has errors, or its program was never saved.
pub(crate) fn of_environment(view: &View, program: &Uri, id: EntityId) -> jsonrpc::Result<Script> {
    of_resolved(view, program, view.database().environment(id))
}

/// As [`of_environment`], of several environments of a program.
pub(crate) fn of_environments(
    view: &View,
    program: &Uri,
    ids: impl IntoIterator<Item = EntityId>,
) -> impl Iterator<Item = jsonrpc::Result<Script>> {
    let environments = view.database().ready_environments(ids).into_iter();
    environments.map(move |environment| of_resolved(view, program, environment))
}

fn of_resolved(
    view: &View,
    program: &Uri,
    environment: Result<Environment, Blocked>,
) -> jsonrpc::Result<Script> {
    let environment = environment.map_err(|errors| blocked(view, &errors))?;
    let settings = view.document(program).map(|document| document.settings.clone()).unwrap_or_default();
    let file_name = pydslrep_script::file_name(&environment);
    let uri = match view.workspace.output_folder(&key(program)) {
        Some(folder) => uri_of(&format!("{folder}/{file_name}")),
        None => address(program, &file_name),
    };
    let uri = uri.ok_or_else(unsaved)?;
    let text = pydslrep_script::generate(&environment, settings.target, &program_name(program))
        .map_err(|error| failure(error.to_string()))?;
    let provided = view.provided.clone();
    let (depth, needs_runtime) = (settings.output_depth(), settings.write_runtime);
    Ok(Script { uri, text, depth, needs_runtime, provided })
}

/// The name of a program's file.
fn program_name(program: &Uri) -> String {
    let path = program.path().decode().to_string_lossy();
    path.rsplit('/').next().unwrap_or_default().to_owned()
}

/// The cause of a failure that a client can act on, in the `data` of the error.
#[derive(Debug, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
pub(crate) enum Cause {
    /// The program was never saved.
    Unsaved,
    /// An action failed in a run.
    #[cfg(feature = "process")]
    FailedRun { location: Location },
    /// There are errors; the first is here, if the client can find it.
    Errors { location: Option<Location> },
}

/// Why a document that was never saved has no script.
fn unsaved() -> Error {
    with_cause("save the file first; the script is written next to it".to_owned(), &Cause::Unsaved)
}

/// Why an environment with errors is neither run nor translated.
pub(crate) fn blocked(view: &View, blocked: &Blocked) -> Error {
    let first = blocked.errors.first();
    let location = first.and_then(|error| view.location(error.file, error.span));
    with_cause(blocked.reason(), &Cause::Errors { location })
}

pub(crate) fn with_cause(message: String, cause: &Cause) -> Error {
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
    // Where there is no disk, a file may be there that the client has not provided.
    let overwrite = script.provided.is_none().then_some(true);
    let create = CreateFileOptions { overwrite, ignore_if_exists: None };
    edits::of_file(script.uri.clone(), replace, (!script.exists()).then_some(create))
}

/// The command `pydslrep.generateScript`, for clients that cannot create files: writes the script and begins to write the
/// package that it imports; returns the script's URI and the end of that.
///
/// # Errors
///
/// As [`generate`], or if the script cannot be written.
pub(crate) fn write_script(
    state: &State,
    which: &ChosenEnvironment,
    changed: Changed,
    outbox: &Outbox,
) -> jsonrpc::Result<(Uri, Option<oneshot::Receiver<()>>)> {
    let script = generate(&state.view, which)?;
    let path = path(&script.uri).ok_or_else(unsaved)?;
    script.write(&path, changed).map_err(failure)?;
    outbox.tell(MessageType::INFO, format!("Script written: {}", script.file_name()));
    let runtime = script.runtime_folder().map(|folder| state.runtimes.write(folder, outbox));
    Ok((script.uri, runtime))
}

/// The command `pydslrep.writeRuntime`, for clients that create the script: begins to write the package that it imports.
///
/// It is not part of the edit that creates the script: an editor would open all its files, and ask about each of those
/// that exist already. And nothing about it is to be undone.
///
/// # Errors
///
/// As [`generate`].
pub(crate) fn write_runtime(
    state: &State,
    which: &ChosenEnvironment,
    outbox: &Outbox,
) -> jsonrpc::Result<Option<oneshot::Receiver<()>>> {
    let folder = generate(&state.view, which)?.runtime_folder();
    Ok(folder.map(|folder| state.runtimes.write(folder, outbox)))
}

/// Writes the scripts of all environments without errors, if that is set. Each script is reported once, and so is each
/// that cannot be written: on every save would be too often.
pub(crate) fn save(state: &mut State, program: &Uri, outbox: &Outbox) {
    let view = &state.view;
    let Some((document, file)) = view.analysed(program) else { return };
    if !document.settings.generate_on_save || view.provided.is_some() {
        return;
    }
    let uri = document.uri().unwrap_or_else(|| program.clone());
    let environments = view.database().environments(file);
    let ids = environments.into_iter().map(|(id, _)| id);
    let scripts: Vec<Script> = of_environments(view, &uri, ids).flatten().collect();
    let folders: BTreeSet<PathBuf> = scripts.iter().filter_map(Script::runtime_folder).collect();
    for script in scripts {
        let Some(path) = path(&script.uri) else { continue };
        let (kind, message) = match script.write(&path, Changed::Keep) {
            Ok(()) => (MessageType::INFO, format!("Script written: {} (on every save)", script.file_name())),
            Err(reason) => (MessageType::WARNING, reason),
        };
        if state.reported.insert(message.clone()) {
            outbox.tell(kind, message);
        }
    }
    for folder in folders {
        // The next message need not wait for it.
        drop(state.runtimes.write(folder, outbox));
    }
}

/// Why a script is not written, with advice.
pub(crate) fn reason(error: &WriteError) -> String {
    match (error, error.help()) {
        (WriteError::Foreign(..), _) => format!("{error}; move it, or rename the environment"),
        (WriteError::Changed(_), _) => format!("{error}, so it is kept; Generate Script can replace it"),
        (_, Some(help)) => format!("{error}; {help}"),
        (_, None) => error.to_string(),
    }
}

/// The answers to [`question`].
const REPLACE: &str = "Replace It";
const KEEP: &str = "Keep It";

/// Returns the question to the user before a script is written; `None` if there is nothing to ask.
///
/// # Errors
///
/// As [`generate`].
pub(crate) fn question(
    view: &View,
    which: &ChosenEnvironment,
) -> jsonrpc::Result<Option<ShowMessageRequestParams>> {
    let script = generate(view, which)?;
    let is_changed = matches!(script.obstacle(), Some(WriteError::Changed(_)));
    Ok(is_changed.then(|| {
        let name = script.file_name();
        choice(format!("{name} was changed since it was generated. Replace your changes?"), [REPLACE, KEEP])
    }))
}

/// A question to the user with two answers.
pub(crate) fn choice(message: String, answers: [&str; 2]) -> ShowMessageRequestParams {
    let answer = |title: &str| MessageActionItem { title: title.to_owned(), properties: HashMap::new() };
    let actions = Some(answers.map(answer).to_vec());
    ShowMessageRequestParams { typ: MessageType::WARNING, message, actions }
}

/// Returns whether an answer to [`question`] allows it.
pub(crate) fn allows(answer: Option<&MessageActionItem>) -> bool {
    answer.is_some_and(|answer| answer.title == REPLACE)
}

/// The error for a request that the user does not want any more.
pub(crate) fn cancelled(message: &'static str) -> Error {
    Error { code: ErrorCode::RequestCancelled, message: message.into(), data: None }
}

/// The request to show a script next to its program.
pub(crate) fn show(uri: Uri) -> ShowDocumentParams {
    ShowDocumentParams { uri, external: Some(false), take_focus: Some(false), selection: None }
}

/// A program of the client.
///
/// # Errors
///
/// If there is none.
pub(crate) fn opened<'a>(view: &'a View, program: &Uri) -> jsonrpc::Result<(Document<'a>, FileId)> {
    let unopened = || failure(format!("`{}` is not open in the editor", program.as_str()));
    view.analysed(program).ok_or_else(unopened)
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
