//! What requests read.

use std::sync::Arc;

use pydslrep_analysis::{Database, EntityId, FileId, Severity, Snapshot};
use pydslrep_files::Disk;
use pydslrep_ide::{FilePosition, ScenePlace, TomlFile, TypedStatement};
use pydslrep_text::Span;
use pydslrep_workspace::{DocumentKind, FileSystem, MemoryFiles, Workspace};
use ropey::Rope;
use rustc_hash::FxHashMap;
use tower_lsp::ls_types::{Location, Position, Range, TextDocumentPositionParams, Uri};

use crate::chosen::{ChosenEnvironment, WatchedPaths};
use crate::client::ClientFeatures;
use crate::documents::{ClientDocument, Document, key};
use crate::handlers::driven_path::DrivenPaths;
use crate::positions::{Encoding, to_offset, to_position, to_range, to_span};
use crate::typing::Typing;
use crate::work::{FileWork, SHORT, Work};

/// What requests read: documents, their analysis, and the features of the client. A copy is cheap, and stays as it is
/// while the message loop goes on.
#[derive(Debug, Clone)]
pub(crate) struct View {
    /// The features of the client.
    pub(crate) client: Arc<ClientFeatures>,
    /// The documents that are open in the client, the files around them, and their analysis.
    pub(crate) workspace: Arc<Workspace>,
    /// The files that the client provides, where there is no disk.
    pub(crate) provided: Option<Arc<MemoryFiles>>,
    /// The documents that are open in the client, by their keys.
    pub(crate) open: Arc<FxHashMap<String, ClientDocument>>,
    /// Where the user is typing, if known.
    pub(crate) typing: Option<Typing>,
    /// Paths that were driven.
    pub(crate) driven: DrivenPaths,
    /// Planned paths that the client and pages have.
    pub(crate) watched: WatchedPaths,
}

impl Default for View {
    fn default() -> Self {
        Self::new(Arc::new(Disk), None)
    }
}

impl View {
    /// Without a disk.
    pub(crate) fn in_memory() -> Self {
        let provided = Arc::new(MemoryFiles::default());
        Self::new(Arc::<MemoryFiles>::clone(&provided), Some(provided))
    }

    fn new(files: Arc<dyn FileSystem>, provided: Option<Arc<MemoryFiles>>) -> Self {
        Self {
            client: Arc::default(),
            workspace: Arc::new(Workspace::new(files)),
            provided,
            open: Arc::default(),
            typing: None,
            driven: DrivenPaths::default(),
            watched: WatchedPaths::default(),
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
        let found = self.database().shown_diagnostics(file);
        let mut errors = found.iter().filter(|found| found.severity == Severity::Error);
        errors.any(|error| statements.iter().any(|statement| statement.settles(error)))
    }

    /// Returns whether a request about all of a document takes longer than handing it to another thread.
    pub(crate) fn is_long(&self, uri: &Uri) -> bool {
        let Some(document) = self.document(uri) else { return false };
        let database = self.database();
        let length = |file: FileId| database.text(file).map_or(0, Rope::len_bytes);
        let imported = document.file.into_iter().flat_map(|file| database.imported_files(file));
        let all = document.text.len_bytes() + imported.map(length).sum::<usize>();
        all >= SHORT
    }

    /// The analysis of all programs.
    pub(crate) fn database(&self) -> &Database {
        self.workspace.database()
    }

    /// A document by its key.
    pub(crate) fn document_at(&self, key: &str) -> Option<Document<'_>> {
        Some(Document::new(self.workspace.document(key)?, self.open.get(key)))
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

    /// Returns whether a request for completion is the first one since the text changed at its position.
    pub(crate) fn is_first_completion_after_typing(&self, at: &TextDocumentPositionParams) -> bool {
        let Some(document) = self.document(&at.text_document.uri) else { return false };
        if document.kind != DocumentKind::Program {
            // Where the user types in other files is not noted.
            return true;
        }
        let offset = self.offset(document, at.position);
        self.typing.as_ref().is_some_and(|typing| typing.is_first_completion(document.key, offset))
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
