//! The server's state between two messages.

use std::sync::Arc;

use futures::channel::oneshot;
use pydslrep_analysis::{CancellationToken, Database, EditCounts, EntityId, FileId, Severity, Snapshot};
use pydslrep_config::{Config, Problem};
use pydslrep_files::Disk;
use pydslrep_ide::{FilePosition, ScenePlace, TomlFile, TypedStatement};
use pydslrep_text::Span;
use pydslrep_workspace::{
    Changes, DocumentKind, FileSystem, MAX_BYTES, MemoryFiles, ReadError, TextChange, Workspace, path_of,
};
use ropey::Rope;
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::Value;
use tower_lsp::ls_types::request::{CodeLensRefresh, InlayHintRefreshRequest};
use tower_lsp::ls_types::{
    DidChangeTextDocumentParams, Location, Position, Range, TextDocumentContentChangeEvent, TextDocumentItem,
    TextDocumentPositionParams, TraceValue, Uri,
};

use crate::chosen::{ChosenEnvironment, Watched};
use crate::client::ClientFeatures;
use crate::documents::{ClientDocument, Document, key, text_changes};
use crate::handlers::driven_path::DrivenPaths;
use crate::message::Outbox;
use crate::page::Pages;
use crate::positions::{Encoding, to_offset, to_position, to_range, to_span};
use crate::runtimes::Runtimes;
use crate::shared::SharedWorkspace;
use crate::typing::{Typing, replacements};
use crate::work::{FileWork, SHORT, Work};

/// Documents, their analysis, and the features of the client.
#[derive(Debug)]
pub(crate) struct State {
    /// The features of the client.
    pub(crate) client: ClientFeatures,
    /// The documents that are open in the client, the files around them, and their analysis.
    pub(crate) workspace: SharedWorkspace,
    /// Options of the server's command line, which override the client's settings.
    options: Config,
    /// The files that the client provides, where there is no disk.
    pub(crate) provided: Option<Arc<MemoryFiles>>,
    /// The client's state of documents, by their keys.
    pub(crate) clients: FxHashMap<String, ClientDocument>,
    /// The changes since diagnostics were last published, as far as they were already taken from the workspace.
    changes: Changes,
    /// Documents that were closed since diagnostics were last published.
    pub(crate) closed: Vec<Uri>,
    /// The number of answers that have got a number.
    pub(crate) answers: u64,
    /// The number of times that documents have been opened.
    openings: u64,
    /// The number of progress reports; each needs its own token.
    pub(crate) progresses: u64,
    /// The trace level; if it is verbose, the client gets the cost of changes.
    pub(crate) trace: TraceValue,
    /// The cost of each change of the last message, if the trace is verbose.
    pub(crate) costs: Vec<EditCounts>,
    /// Requests that are answered when any diagnostics change.
    pub(crate) waiting: Vec<oneshot::Sender<()>>,
    /// Messages shown so far about scripts that are generated on save.
    pub(crate) reported: FxHashSet<String>,
    /// Writes the package that scripts import.
    pub(crate) runtimes: Runtimes,
    /// Planned paths that the client has.
    pub(crate) watched: Vec<Watched>,
    /// Where the user is typing, if known.
    pub(crate) typing: Option<Typing>,
    /// The hints and lenses that the client must request again although it did not change them.
    pub(crate) outdated: Outdated,
    /// The number of refreshes requested.
    refreshes: u64,
    /// Paths that were driven.
    pub(crate) driven: DrivenPaths,
    /// The pages of the path preview.
    pub(crate) pages: Pages,
}

/// The outdated items that the client shows.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outdated {
    /// Inlay hints.
    pub(crate) hints: bool,
    /// Code lenses.
    pub(crate) lenses: bool,
}

impl Default for State {
    fn default() -> Self {
        Self {
            workspace: SharedWorkspace::new(Workspace::new(Arc::new(Disk))),
            client: ClientFeatures::default(),
            options: Config::default(),
            provided: None,
            changes: Changes::default(),
            clients: FxHashMap::default(),
            closed: Vec::new(),
            answers: 0,
            openings: 0,
            progresses: 0,
            trace: TraceValue::default(),
            costs: Vec::new(),
            waiting: Vec::new(),
            reported: FxHashSet::default(),
            runtimes: Runtimes::default(),
            watched: Vec::new(),
            typing: None,
            outdated: Outdated::default(),
            refreshes: 0,
            driven: DrivenPaths::default(),
            pages: Pages::default(),
        }
    }
}

impl State {
    /// Without a disk.
    pub(crate) fn in_memory() -> Self {
        let provided = Arc::new(MemoryFiles::default());
        let files: Arc<dyn FileSystem> = Arc::<MemoryFiles>::clone(&provided);
        let workspace = SharedWorkspace::new(Workspace::new(files));
        Self { workspace, provided: Some(provided), ..Self::default() }
    }

    /// Opens a document, or gives one that is open a new text.
    pub(crate) fn open(&mut self, opened: &TextDocumentItem) {
        let key = key(&opened.uri);
        self.typing.take_if(|typing| typing.key == key);
        self.openings += 1;
        let client = ClientDocument {
            uri: Some(opened.uri.clone()),
            version: Some(opened.version),
            opening: self.openings,
            ..ClientDocument::default()
        };
        if let Some(mut before) = self.clients.insert(key.clone(), client) {
            before.set_outdated();
        }
        self.workspace.open(&key, Rope::from_str(&opened.text));
    }

    /// Makes the changes of one message; false if the document is not open.
    pub(crate) fn change(&mut self, params: &DidChangeTextDocumentParams) -> bool {
        let key = key(&params.text_document.uri);
        let open = self.workspace.document(&key).filter(|document| document.is_open);
        let (Some(document), Some(client)) = (open, self.clients.get_mut(&key)) else { return false };
        client.version = Some(params.text_document.version);
        client.set_outdated();
        let (is_program, before) = (document.is_program(), document.text.clone());
        let changes = text_changes(&before, &params.content_changes, self.client.encoding);
        if is_program {
            self.note_typing(&key, &params.content_changes, &changes, &before);
            let position = end_of_edit(&params.content_changes, &changes, self.client.encoding);
            self.pages.edited_at(&params.text_document.uri, position);
        }
        let costs = self.workspace.change(&key, changes);
        if self.trace == TraceValue::Verbose {
            self.costs.extend(costs);
        }
        true
    }

    fn note_typing(
        &mut self,
        key: &str,
        events: &[TextDocumentContentChangeEvent],
        changes: &[TextChange],
        before: &Rope,
    ) {
        let spans: Vec<Option<Span>> = changes.iter().map(|change| change.span).collect();
        let after = changes.last().map_or(before, |change| &change.after);
        let replaced = replacements(events, &spans, before, after);
        let are_alike = events.windows(2).all(|pair| pair[0].text == pair[1].text);
        let before_key = self.typing.as_ref().map(|typing| typing.key.clone());
        let is_elsewhere = before_key.as_ref().is_some_and(|before| before != key);
        self.typing = Typing::after(self.typing.take(), key, &replaced, are_alike);
        if is_elsewhere {
            self.outdated = Outdated { hints: true, lenses: true };
        }
        if let Some(left) = before_key.filter(|_| is_elsewhere) {
            self.changes.documents.insert(left);
        }
    }

    /// The statements being typed in a document, one for each cursor.
    pub(crate) fn statements_being_typed(&self, document: Document<'_>) -> Vec<TypedStatement<'_>> {
        let typing = self.typing.as_ref().filter(|typing| typing.key == document.key);
        let places = typing.map_or(&[][..], Typing::unsaved_places);
        let Some(file) = document.file else { return Vec::new() };
        let statement =
            |offset: &u32| TypedStatement::at(self.database(), FilePosition { file, offset: *offset });
        places.iter().filter_map(statement).collect()
    }

    /// Returns whether the next word of a statement being typed will settle an error.
    pub(crate) fn is_error_unsettled(&self) -> bool {
        let Some(document) = self.typing.as_ref().and_then(|typing| self.document_at(&typing.key)) else {
            return false;
        };
        let statements = self.statements_being_typed(document);
        let Some(file) = document.file.filter(|_| !statements.is_empty()) else { return false };
        let found = self.database().diagnostics(file);
        let mut errors = found.iter().filter(|found| found.severity == Severity::Error);
        errors.any(|error| statements.iter().any(|statement| statement.settles(error)))
    }

    /// Returns the changes in the workspace since the last call.
    pub(crate) fn take_changes(&mut self) -> Changes {
        self.note_changes();
        std::mem::take(&mut self.changes)
    }

    /// Takes the changes of the workspace. That stops its readers, so it happens before they begin.
    fn note_changes(&mut self) {
        if self.workspace.has_changes() {
            let Changes { all, documents } = self.workspace.untracked_mut().take_changes();
            self.changes.all |= all;
            self.changes.documents.extend(documents);
        }
    }

    /// Prepares for [`Self::borrow`] after this message.
    pub(crate) fn prepare_to_borrow(&mut self) -> u64 {
        self.note_changes();
        self.workspace.version()
    }

    /// Returns the current state for a request about a document that continues beside the message loop, and the token that
    /// is cancelled when the workspace changes. Memory of earlier requests moves to it until [`Self::release`].
    pub(crate) fn borrow(&mut self, key: &str) -> (Self, CancellationToken) {
        let (workspace, token) = self.workspace.borrow();
        let mut clients: FxHashMap<String, ClientDocument> =
            self.clients.iter().map(|(key, client)| (key.clone(), client.without_memory())).collect();
        if let (Some(own), Some(borrowed)) = (self.clients.get_mut(key), clients.get_mut(key)) {
            borrowed.exchange_memory(own);
        }
        let (client, provided) = (self.client.clone(), self.provided.clone());
        let typing = self.typing.clone();
        let borrowed = Self { client, workspace, provided, clients, typing, ..Self::default() };
        (borrowed, token)
    }

    /// Ends the loan to a request, and keeps what it has remembered.
    pub(crate) fn release(&mut self, key: &str, mut borrowed: Self) {
        if let (Some(own), Some(borrowed)) = (self.clients.get_mut(key), borrowed.clients.get_mut(key))
            && own.opening == borrowed.opening
        {
            own.exchange_memory(borrowed);
        }
        for watched in borrowed.watched.drain(..) {
            self.watched.retain(|other| !other.is(&watched.which, watched.audience));
            self.watched.push(watched);
        }
    }

    /// The key of a document of which a request about all of it takes longer than handing it to another thread.
    pub(crate) fn if_long(&self, uri: &Uri) -> Option<String> {
        let document = self.document(uri)?;
        let database = self.database();
        let length = |file: FileId| database.text(file).map_or(0, Rope::len_bytes);
        let imported = document.file.into_iter().flat_map(|file| database.imported_files(file));
        let all = document.text.len_bytes() + imported.map(length).sum::<usize>();
        (all >= SHORT).then(|| document.key.to_owned())
    }

    /// Tells pages where the cursor is, or the pointer.
    pub(crate) fn note_cursor(&mut self, at: &TextDocumentPositionParams) {
        let uri = &at.text_document.uri;
        if self.is_program(uri) {
            self.pages.cursor_is_at(uri, at.position);
        } else if let Some((which, position)) = self.driven_in(uri) {
            self.pages.chosen_at(&which.uri, which.environment, position);
        }
    }

    /// Notes that the cursor is at a place.
    pub(crate) fn cursor_is(&mut self, at: &TextDocumentPositionParams) {
        self.note_cursor(at);
        self.cursor_is_at(&at.text_document.uri, Range::new(at.position, at.position));
    }

    /// Notes the cursor of a request: a user who has moved to another line has finished the one before.
    pub(crate) fn cursor_is_at(&mut self, uri: &Uri, range: Range) {
        let key = key(uri);
        let (Some(typing), Some(document)) = (&self.typing, self.workspace.document(&key)) else { return };
        if typing.is_left(&key, range, &document.text) {
            self.changes.documents.insert(typing.key.clone());
            self.typing = None;
            self.outdated = Outdated { hints: true, lenses: true };
        }
    }

    /// Returns whether this is the first request for completion since the text changed at this place; from now on it is
    /// not.
    pub(crate) fn is_first_completion_after_typing(&mut self, at: &TextDocumentPositionParams) -> bool {
        let key = key(&at.text_document.uri);
        let Some(document) = self.workspace.document(&key) else { return false };
        if !document.is_program() {
            // Where the user types in other files is not noted.
            return true;
        }
        let offset = to_offset(&document.text, at.position, self.client.encoding);
        self.typing.as_mut().is_some_and(|typing| typing.complete(&key, offset))
    }

    /// Asks the client to request outdated hints and lenses again.
    pub(crate) fn tell_outdated(&mut self, outbox: &Outbox) {
        let Outdated { hints, lenses } = std::mem::take(&mut self.outdated);
        if hints && self.client.refreshes_inlay_hints {
            self.refreshes += 1;
            outbox.send_server_request::<InlayHintRefreshRequest>(self.refreshes);
        }
        if lenses && self.client.refreshes_code_lenses {
            self.refreshes += 1;
            outbox.send_server_request::<CodeLensRefresh>(self.refreshes);
        }
    }

    /// Notes that a document was saved.
    pub(crate) fn saved(&mut self, uri: &Uri) {
        let key = key(uri);
        if self.typing.as_mut().is_some_and(|typing| typing.save(&key)) {
            self.outdated.lenses = true;
            self.changes.documents.insert(key);
        }
    }

    /// Closes a document; false if it is not open. From now on its file counts, if there is one.
    pub(crate) fn close(&mut self, uri: &Uri) -> bool {
        let key = key(uri);
        if !self.workspace.close(&key) {
            return false;
        }
        if let Some(mut client) = self.clients.remove(&key) {
            client.set_outdated();
        }
        self.closed.push(uri.clone());
        true
    }

    /// A file was created, changed or deleted, by whomever.
    pub(crate) fn file_changed(&mut self, uri: &Uri) {
        self.workspace.file_changed(&key(uri));
    }

    /// The client provides a file, or takes one away; false where files come from a disk.
    pub(crate) fn provide(&mut self, uri: &Uri, text: Option<&str>) -> bool {
        let Some(files) = &self.provided else { return false };
        let key = key(uri);
        match text {
            Some(text) if text.len() as u64 > MAX_BYTES => {
                files.write_unreadable(&*path_of(&key), ReadError::TooLarge);
            }
            Some(text) => files.write(&*path_of(&key), text),
            None => files.remove(path_of(&key)),
        }
        self.workspace.file_changed(&key);
        true
    }

    /// Applies the client's settings; returns their problems.
    pub(crate) fn set_client_settings(&mut self, value: &Value) -> Vec<Problem> {
        let (config, problems) = Config::from_json(value);
        self.workspace.set_overrides(self.options.clone().merged_over(config));
        problems
    }

    /// Sets the options that override the client's settings, before there are any.
    #[cfg(feature = "process")]
    pub(crate) fn set_options(&mut self, options: Config) {
        self.workspace.set_overrides(options.clone());
        self.options = options;
    }

    /// The analysis of all programs.
    pub(crate) fn database(&self) -> &Database {
        self.workspace.database()
    }

    /// A document by its key.
    pub(crate) fn document_at(&self, key: &str) -> Option<Document<'_>> {
        Some(Document::new(self.workspace.document(key)?, self.clients.get(key)))
    }

    /// The document at an address.
    pub(crate) fn document(&self, uri: &Uri) -> Option<Document<'_>> {
        self.document_at(&key(uri))
    }

    /// Returns whether a program is at an address.
    pub(crate) fn is_program(&self, uri: &Uri) -> bool {
        self.document(uri).is_some_and(|document| document.kind == DocumentKind::Program)
    }

    /// The document at an address, if it could be analysed.
    pub(crate) fn analysed(&self, uri: &Uri) -> Option<(Document<'_>, FileId)> {
        let document = self.document(uri)?;
        Some((document, document.file?))
    }

    /// Work on a document as it is now; `None` where it is not open or could not be analysed.
    pub(crate) fn work<R>(
        &self,
        uri: &Uri,
        run: impl FnOnce(Document<'_>, Encoding) -> Box<dyn FnOnce(Snapshot) -> R + Send>,
    ) -> Option<Work<R>> {
        let (document, file) = self.analysed(uri)?;
        Some(Work::OnFile(FileWork {
            snapshot: self.database().snapshot(file, None)?,
            outdated: document.outdated(),
            run: run(document, self.client.encoding),
        }))
    }

    /// Returns the location in a program that a position of the client refers to.
    pub(crate) fn place(&self, at: &TextDocumentPositionParams) -> Option<Place<'_>> {
        let (document, file) = self.analysed(&at.text_document.uri)?;
        Some(Place { document, file, offset: self.offset(document, at.position) })
    }

    /// The name at a position of a program, or of a scene that one has.
    pub(crate) fn named(&self, at: &TextDocumentPositionParams) -> Option<Named<'_>> {
        let document = self.document(&at.text_document.uri)?;
        let offset = self.offset(document, at.position);
        if let Some(file) = document.file {
            return Some(Named { document, span: None, position: FilePosition { file, offset } });
        }
        let environment = self.environment_of_scene(document)?;
        let text = document.text.to_string();
        let found = pydslrep_ide::name_in_scene(self.database(), environment, &text, offset)?;
        Some(Named { document, span: Some(found.span), position: found.declared })
    }

    /// The environment of a document that is a scene.
    pub(crate) fn environment_of_scene(&self, document: Document<'_>) -> Option<EntityId> {
        let is_scene = document.kind == DocumentKind::Scene;
        is_scene.then(|| self.workspace.environment_of_scene(document.key)).flatten()
    }

    /// The environment that is driven in the scene at an address, and where that is declared.
    pub(crate) fn driven_in(&self, scene: &Uri) -> Option<(ChosenEnvironment, Position)> {
        let declared = self.environment_of_scene(self.document(scene)?)?;
        let FilePosition { file, offset } = pydslrep_ide::declaration(self.database(), declared)?;
        let (program, tree) = (self.document_of(file)?, self.database().tree(declared)?);
        let which = ChosenEnvironment { uri: program.uri()?, environment: tree.name()?.text.to_string() };
        Some((which, to_position(program.text, offset, self.client.encoding)))
    }

    /// The scene of an environment of a program, if there is one.
    pub(crate) fn scene_document(&self, program: FileId, environment: &str) -> Option<Document<'_>> {
        self.document_at(&self.workspace.scene_key(program, environment)?)
    }

    /// Places in scenes, each once: programs in one folder can share a scene.
    pub(crate) fn scene_locations(&self, places: &[ScenePlace]) -> Vec<Location> {
        let mut locations: Vec<Location> = Vec::new();
        for place in places {
            let Some(document) = self.scene_document(place.program, &place.environment) else { continue };
            let Some(uri) = document.uri() else { continue };
            let location = Location::new(uri, self.range(document, place.span));
            if !locations.contains(&location) {
                locations.push(location);
            }
        }
        locations
    }

    /// The settings or the scene at an address, with its text.
    pub(crate) fn toml_text(&self, uri: &Uri) -> Option<(Document<'_>, TomlFile<'_>, String)> {
        let document = self.document(uri)?;
        let file = match document.kind {
            DocumentKind::Program => return None,
            DocumentKind::Settings => TomlFile::Settings,
            DocumentKind::Scene => {
                TomlFile::Scene(self.database(), self.workspace.environment_of_scene(document.key))
            }
        };
        Some((document, file, document.text.to_string()))
    }

    /// The document that the database knows as `file`.
    pub(crate) fn document_of(&self, file: FileId) -> Option<Document<'_>> {
        self.document_at(self.database().path(file))
    }

    /// A position as a byte offset.
    pub(crate) fn offset(&self, document: Document<'_>, position: Position) -> u32 {
        to_offset(document.text, position, self.client.encoding)
    }

    /// A range as the bytes it covers.
    pub(crate) fn span(&self, document: Document<'_>, range: Range) -> Span {
        to_span(document.text, range, self.client.encoding)
    }

    /// Bytes as the range they cover.
    pub(crate) fn range(&self, document: Document<'_>, span: Span) -> Range {
        to_range(document.text, span, self.client.encoding)
    }

    /// A place in any document.
    pub(crate) fn location(&self, file: FileId, span: Span) -> Option<Location> {
        let document = self.document_of(file)?;
        Some(Location::new(document.uri()?, self.range(document, span)))
    }
}

/// Where the last change of a message ends; `None` if it replaces the whole text.
fn end_of_edit(
    events: &[TextDocumentContentChangeEvent],
    changes: &[TextChange],
    encoding: Encoding,
) -> Option<Position> {
    let (event, change) = (events.last()?, changes.last()?);
    let length = u32::try_from(event.text.len()).ok()?;
    Some(to_position(&change.after, change.span?.start + length, encoding))
}

/// A name in a program or a scene, and the place of a program that says what it refers to.
pub(crate) struct Named<'a> {
    /// The document that has the name.
    pub(crate) document: Document<'a>,
    /// Where the name is, in a scene.
    pub(crate) span: Option<Span>,
    /// The name itself in a program; its declaration, for one in a scene.
    pub(crate) position: FilePosition,
}

/// A place in a document.
pub(crate) struct Place<'a> {
    /// The document.
    pub(crate) document: Document<'a>,
    /// Its number in the database.
    pub(crate) file: FileId,
    /// The byte offset in it.
    pub(crate) offset: u32,
}

impl Place<'_> {
    /// As the features want it.
    pub(crate) fn position(&self) -> FilePosition {
        FilePosition { file: self.file, offset: self.offset }
    }
}
