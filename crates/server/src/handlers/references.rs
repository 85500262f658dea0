//! `textDocument/references` and `textDocument/documentHighlight`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams, Location, ReferenceParams,
    TextDocumentPositionParams,
};

use crate::view::View;

/// Returns whether the name at a position has many occurrences.
pub(crate) fn has_many(view: &View, at: &TextDocumentPositionParams) -> bool {
    /// Entities that mention it; one takes about a microsecond.
    const MANY: usize = 1_000;
    view.place(at).is_some_and(|place| ide::count_mentions(view.database(), place.position()) > MANY)
}

/// All occurrences of the name at a position, in programs and in scenes.
pub(crate) fn references(view: &View, params: &ReferenceParams) -> Option<Vec<Location>> {
    let position = view.named(&params.text_document_position)?.position;
    let found = ide::references(view.database(), position, params.context.include_declaration)?;
    let in_programs = found.into_iter().filter_map(|place| view.location(place.file, place.span));
    let in_scenes = ide::mentions_in_scenes(view.database(), position);
    Some(in_programs.chain(view.scene_locations(&in_scenes)).collect())
}

/// The occurrences of the name at a position in its document.
pub(crate) fn highlights(view: &View, params: &DocumentHighlightParams) -> Option<Vec<DocumentHighlight>> {
    let at = &params.text_document_position_params;
    let document = view.document(&at.text_document.uri)?;
    if let Some(environment) = view.environment_of_scene(document) {
        let (text, offset) = (document.text.to_string(), view.offset(document, at.position));
        let spans = ide::highlights_in_scene(view.database(), environment, &text, offset).into_iter();
        let highlight = |span| DocumentHighlight {
            range: view.range(document, span),
            kind: Some(DocumentHighlightKind::READ),
        };
        return Some(spans.map(highlight).collect());
    }
    let place = view.place(at)?;
    let found = ide::highlights(view.database(), place.position()).into_iter();
    let highlight = |found: ide::Highlight| {
        let kind =
            if found.is_declaration { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        DocumentHighlight { range: view.range(place.document, found.span), kind: Some(kind) }
    };
    Some(found.map(highlight).collect())
}
