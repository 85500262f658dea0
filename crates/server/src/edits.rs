//! Edits of several documents, in the best form that the client supports.

use pydslrep_analysis::Edit;
use pydslrep_text::Span;
use tower_lsp::ls_types::{
    CreateFile, CreateFileOptions, DocumentChangeOperation, DocumentChanges, OneOf,
    OptionalVersionedTextDocumentIdentifier, Range, RenameFile, ResourceOp, TextDocumentEdit, TextEdit, Uri,
    WorkspaceEdit,
};

use crate::documents::Document;
use crate::view::View;

/// Edits of documents, each document once, and what happens to files.
#[derive(Default)]
pub(crate) struct Edits<'a> {
    documents: Vec<(Document<'a>, Vec<TextEdit>)>,
    /// A file that gets another name, after the edits.
    pub(crate) renamed: Option<(Uri, Uri)>,
}

impl<'a> Edits<'a> {
    /// Edits of programs.
    pub(crate) fn of_programs(view: &'a View, edits: &[Edit]) -> Self {
        let mut all = Self::default();
        for edit in edits {
            if let Some(document) = view.document_of(edit.file) {
                all.add(view, document, edit.span, edit.text.clone());
            }
        }
        all
    }

    /// Replaces a part of a document, unless the same is done already.
    pub(crate) fn add(&mut self, view: &View, document: Document<'a>, span: Span, text: String) {
        let edit = TextEdit::new(view.range(document, span), text);
        match self.documents.iter_mut().find(|(other, _)| other.key == document.key) {
            Some((_, edits)) if edits.contains(&edit) => {}
            Some((_, edits)) => edits.push(edit),
            None => self.documents.push((document, vec![edit])),
        }
    }

    /// All of it for the client.
    pub(crate) fn finish(self, view: &View) -> WorkspaceEdit {
        if !view.client.versioned_edits {
            let changes = self.documents.into_iter();
            let changes = changes.filter_map(|(document, edits)| Some((document.uri()?, edits))).collect();
            return WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() };
        }
        let edits = self.documents.into_iter().filter_map(|(document, edits)| {
            let (uri, version) = (document.uri()?, document.version());
            let text_document = OptionalVersionedTextDocumentIdentifier { uri, version };
            Some(TextDocumentEdit { text_document, edits: edits.into_iter().map(OneOf::Left).collect() })
        });
        let changes = match self.renamed {
            None => DocumentChanges::Edits(edits.collect()),
            Some((old_uri, new_uri)) => {
                let rename = RenameFile { old_uri, new_uri, options: None, annotation_id: None };
                let operations = edits.map(DocumentChangeOperation::Edit);
                let rename = DocumentChangeOperation::Op(ResourceOp::Rename(rename));
                DocumentChanges::Operations(operations.chain([rename]).collect())
            }
        };
        WorkspaceEdit { document_changes: Some(changes), ..WorkspaceEdit::default() }
    }
}

/// The edit that creates a file with a text, which fails if it exists.
pub(crate) fn new_file(uri: Uri, text: String) -> WorkspaceEdit {
    let options = CreateFileOptions { overwrite: None, ignore_if_exists: None };
    of_file(uri, TextEdit::new(Range::default(), text), Some(options))
}

/// An edit of one file, which is created before if there are options for that.
pub(crate) fn of_file(uri: Uri, edit: TextEdit, create: Option<CreateFileOptions>) -> WorkspaceEdit {
    let create = create.map(|options| {
        let create = CreateFile { uri: uri.clone(), options: Some(options), annotation_id: None };
        DocumentChangeOperation::Op(ResourceOp::Create(create))
    });
    let text_document = OptionalVersionedTextDocumentIdentifier { uri, version: None };
    let edit = TextDocumentEdit { text_document, edits: vec![OneOf::Left(edit)] };
    let operations = create.into_iter().chain([DocumentChangeOperation::Edit(edit)]).collect();
    let document_changes = Some(DocumentChanges::Operations(operations));
    WorkspaceEdit { document_changes, ..WorkspaceEdit::default() }
}
