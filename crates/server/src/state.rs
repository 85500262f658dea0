//! What the server knows between two messages.

mod scenes;
mod settings;

use std::panic::{AssertUnwindSafe, catch_unwind};

use futures::channel::oneshot;
use pydslrep_analysis::{Database, EditCounts, FileId, Snapshot};
use pydslrep_ide::{FilePosition, TomlFile};
use pydslrep_syntax::Span;
use ropey::Rope;
use rustc_hash::FxHashSet;
use tower_lsp::ls_types::request::{CodeLensRefresh, InlayHintRefreshRequest};
use tower_lsp::ls_types::{
    DidChangeTextDocumentParams, Location, Position, Range, TextDocumentItem, TextDocumentPositionParams,
    TraceValue, Uri,
};

use self::scenes::SceneUsers;
use self::settings::SettingsStore;
use crate::chosen::Watched;
use crate::client::ClientFeatures;
use crate::documents::{Document, Documents, Sort, key};
use crate::handlers::driven_path::DrivenPaths;
use crate::message::Outbox;
use crate::positions::{Encoding, to_offset, to_range, to_span};
use crate::typing::{Typing, replacements};
use crate::work::Work;

/// Documents, their analysis, and what the client can do.
#[derive(Debug, Default)]
pub(crate) struct State {
    /// What the client can do.
    pub(crate) client: ClientFeatures,
    /// The analysis of the open documents.
    pub(crate) database: Database,
    /// The open documents and the other files of the workspace.
    pub(crate) documents: Documents,
    /// What is set.
    pub(crate) settings: SettingsStore,
    /// Which programs want which scenes.
    pub(crate) scenes: SceneUsers,
    /// The keys of the folders open in the client, each with `/` at its end.
    pub(crate) folders: Vec<String>,
    /// How many answers have been given a number so far.
    pub(crate) answers: u64,
    /// How many documents have been opened so far, each time counted.
    openings: u64,
    /// How many times progress was told so far; each time needs a name of its own.
    pub(crate) progresses: u64,
    /// Whose diagnostics may have changed since they were last told, beside what the database says.
    pub(crate) stale: Stale,
    /// Whether the client wants to know what changes cost.
    pub(crate) trace: TraceValue,
    /// What the changes of the last message cost, one by one, if that is wanted.
    pub(crate) costs: Vec<EditCounts>,
    /// Requests that are answered when any diagnostics change.
    pub(crate) waiting: Vec<oneshot::Sender<()>>,
    /// What was told about scripts that are written on every save.
    pub(crate) told: FxHashSet<String>,
    /// Planned paths that the client has.
    pub(crate) watched: Vec<Watched>,
    /// Where somebody is typing, if that is known.
    pub(crate) typing: Option<Typing>,
    /// What the client has to ask for again, though it changed nothing there.
    pub(crate) outdated: Outdated,
    /// How often the client was told so.
    refreshes: u64,
    /// Paths that were driven.
    pub(crate) driven: DrivenPaths,
}

/// What the client shows that is no longer so.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outdated {
    /// Inlay hints.
    pub(crate) hints: bool,
    /// Code lenses.
    pub(crate) lenses: bool,
}

/// Documents whose diagnostics have to be told again.
#[derive(Debug, Default)]
pub(crate) struct Stale {
    /// All of them.
    pub(crate) all: bool,
    /// These, by their keys.
    pub(crate) documents: FxHashSet<String>,
    /// Those that are no longer there and had some.
    pub(crate) gone: Vec<Uri>,
}

impl State {
    /// Takes in a document; one that is open already gets the new text.
    pub(crate) fn open(&mut self, opened: &TextDocumentItem) {
        let key = key(&opened.uri);
        if let Some(mut before) = self.documents.remove(&key) {
            before.set_outdated();
        }
        self.typing.take_if(|typing| typing.key == key);
        self.openings += 1;
        let mut document =
            Document::new(opened.uri.clone(), Rope::from_str(&opened.text), Some(opened.version));
        document.opening = self.openings;
        self.stale.documents.insert(key.clone());
        let document = self.documents.entry(key.clone()).insert_entry(document).into_mut();
        match document.sort() {
            Sort::Settings => return self.reload_settings(),
            Sort::Scene => return self.give_scene(&key),
            Sort::Program => {}
        }
        document.file = Some(self.database.open(&key, &opened.text));
        self.apply_settings(&key);
        self.follow_changed_imports(&key);
        self.follow_imports_of(&key);
        self.follow_scenes();
    }

    /// Makes the changes of one message; false if the document is not open.
    pub(crate) fn change(&mut self, params: &DidChangeTextDocumentParams) -> bool {
        let encoding = self.client.encoding;
        let key = key(&params.text_document.uri);
        let open = self.documents.get_mut(&key).filter(|document| document.version.is_some());
        let Some(document) = open else { return false };
        document.version = Some(params.text_document.version);
        document.set_outdated();
        let before = document.text.clone();
        // All of the document before any of the analysis: should that fail, the document is still right.
        let spans: Vec<Option<Span>> =
            params.content_changes.iter().map(|change| document.apply(change, encoding)).collect();
        match document.sort() {
            Sort::Settings => {
                self.reload_settings();
                return true;
            }
            Sort::Scene => {
                self.stale.documents.insert(key.clone());
                self.give_scene(&key);
                return true;
            }
            Sort::Program => {}
        }
        let changes = &params.content_changes;
        let replaced = replacements(changes, &spans, &before, &document.text);
        let are_alike = changes.windows(2).all(|pair| pair[0].text == pair[1].text);
        let is_elsewhere = self.typing.as_ref().is_some_and(|typing| typing.key != key);
        self.typing = Typing::after(self.typing.take(), &key, &replaced, are_alike);
        if is_elsewhere {
            self.outdated = Outdated { hints: true, lenses: true };
        }
        let Some(file) = document.file else { return true };
        for (change, span) in params.content_changes.iter().zip(spans) {
            match span {
                Some(span) => self.database.edit(file, span, &change.text),
                None => document.file = Some(self.database.open(&key, &change.text)),
            }
            if self.trace == TraceValue::Verbose {
                self.costs.push(self.database.last_edit());
            }
        }
        self.follow_changed_imports(&key);
        self.follow_scenes();
        true
    }

    /// Notes that the cursor is at a place.
    pub(crate) fn cursor_is(&mut self, at: &TextDocumentPositionParams) {
        self.cursor_is_at(&at.text_document.uri, Range::new(at.position, at.position));
    }

    /// Notes what a request says about the cursor: who has gone on to another line has done with the one before.
    pub(crate) fn cursor_is_at(&mut self, uri: &Uri, range: Range) {
        let key = key(uri);
        let (Some(typing), Some(document)) = (&self.typing, self.documents.get(&key)) else { return };
        if typing.is_left(&key, range, &document.text) {
            self.typing = None;
            self.outdated = Outdated { hints: true, lenses: true };
        }
    }

    /// Has the client ask again for what is no longer so.
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
        self.outdated.lenses |= self.typing.as_mut().is_some_and(|typing| typing.save(&key));
    }

    /// Lets go of a document; false if it is not open. From now on its file counts, if there is one.
    pub(crate) fn close(&mut self, uri: &Uri) -> bool {
        let key = key(uri);
        let Some(document) = self.documents.get(&key).filter(|document| document.version.is_some()) else {
            return false;
        };
        let sort = document.sort();
        self.stale.gone.push(uri.clone());
        self.remove(&key);
        match sort {
            Sort::Program | Sort::Scene => self.file_changed(uri),
            Sort::Settings => self.reload_settings(),
        }
        true
    }

    /// Forgets a document, open or not.
    pub(crate) fn remove(&mut self, key: &str) {
        if let Some(mut document) = self.documents.remove(key) {
            document.set_outdated();
            if document.published.is_some_and(|published| !published.is_empty()) {
                self.stale.gone.push(document.uri);
            }
            if let Some(file) = document.file {
                self.database.close(file);
            }
        }
    }

    /// Analyses all documents afresh, after a defect that may have left the database half changed. A document that
    /// brings the defect up again stays open, but without answers until it is opened anew.
    pub(crate) fn rebuild(&mut self) {
        let mut left_out = FxHashSet::default();
        while let Some(failed) = self.try_rebuild(&left_out) {
            left_out.insert(failed);
        }
        let all: Vec<String> = self.documents.keys().cloned().collect();
        for key in all {
            self.apply_settings(&key);
            self.follow_imports(&key);
        }
        self.follow_scenes();
    }

    /// The key of the document that cannot be analysed, if one cannot.
    fn try_rebuild(&mut self, left_out: &FxHashSet<String>) -> Option<String> {
        self.database = Database::new();
        self.scenes = SceneUsers::default();
        self.stale.all = true;
        for (key, document) in &mut self.documents {
            document.file = None;
            if left_out.contains(key) || !document.is_program() {
                continue;
            }
            let text = document.text.to_string();
            let opening = AssertUnwindSafe(|| self.database.open(key, &text));
            match catch_unwind(opening) {
                Ok(file) => document.file = Some(file),
                Err(_) => return Some(key.clone()),
            }
        }
        None
    }

    /// The document at an address.
    pub(crate) fn document(&self, uri: &Uri) -> Option<&Document> {
        self.documents.get(&key(uri))
    }

    /// The document at an address, if it could be analysed.
    pub(crate) fn analysed(&self, uri: &Uri) -> Option<(&Document, FileId)> {
        let document = self.document(uri)?;
        Some((document, document.file?))
    }

    /// Work on a document as it is now; `None` where it is not open or could not be analysed.
    pub(crate) fn work<R>(
        &self,
        uri: &Uri,
        run: impl FnOnce(&Document, Encoding) -> Box<dyn FnOnce(Snapshot) -> R + Send>,
    ) -> Option<Work<R>> {
        let (document, file) = self.analysed(uri)?;
        Some(Work {
            snapshot: self.database.snapshot(file, None)?,
            outdated: document.outdated.clone(),
            run: run(document, self.client.encoding),
        })
    }

    /// What a position in a document points at.
    pub(crate) fn place(&self, at: &TextDocumentPositionParams) -> Option<Place<'_>> {
        let (document, file) = self.analysed(&at.text_document.uri)?;
        Some(Place { document, file, offset: self.offset(document, at.position) })
    }

    /// The settings or the scene at an address, with its text.
    pub(crate) fn toml_text(&self, uri: &Uri) -> Option<(&Document, TomlFile<'_>, String)> {
        let document = self.document(uri)?;
        Some((document, self.toml_file(document)?, document.text.to_string()))
    }

    /// What kind of TOML file a document is; `None` for a program.
    pub(crate) fn toml_file(&self, document: &Document) -> Option<TomlFile<'_>> {
        match document.sort() {
            Sort::Program => None,
            Sort::Settings => Some(TomlFile::Settings),
            Sort::Scene => Some(TomlFile::Scene(&self.database, self.environment_in(&key(&document.uri)))),
        }
    }

    /// The document that the database knows as `file`.
    pub(crate) fn document_of(&self, file: FileId) -> Option<&Document> {
        self.documents.get(self.database.path(file))
    }

    /// A position as a byte offset.
    pub(crate) fn offset(&self, document: &Document, position: Position) -> u32 {
        to_offset(&document.text, position, self.client.encoding)
    }

    /// A range as the bytes it covers.
    pub(crate) fn span(&self, document: &Document, range: Range) -> Span {
        to_span(&document.text, range, self.client.encoding)
    }

    /// Bytes as the range they cover.
    pub(crate) fn range(&self, document: &Document, span: Span) -> Range {
        to_range(&document.text, span, self.client.encoding)
    }

    /// A place in any document.
    pub(crate) fn location(&self, file: FileId, span: Span) -> Option<Location> {
        let document = self.document_of(file)?;
        Some(Location::new(document.uri.clone(), self.range(document, span)))
    }
}

/// A place in a document.
pub(crate) struct Place<'a> {
    /// The document.
    pub(crate) document: &'a Document,
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
