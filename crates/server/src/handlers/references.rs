//! `textDocument/references` and `textDocument/documentHighlight`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams, Location, ReferenceParams,
    TextDocumentPositionParams,
};

use crate::state::State;

/// The document, if the name at a position has many occurrences.
pub(crate) fn has_many(state: &State, at: &TextDocumentPositionParams) -> Option<String> {
    /// Entities that mention it; one takes about a microsecond.
    const MANY: usize = 1_000;
    let place = state.place(at)?;
    (ide::count_mentions(state.database(), place.position()) > MANY).then(|| place.document.key.to_owned())
}

/// All occurrences of the name at a position, in programs and in scenes.
pub(crate) fn references(state: &mut State, params: &ReferenceParams) -> Option<Vec<Location>> {
    let state = &*state;
    let position = state.named(&params.text_document_position)?.position;
    let found = ide::references(state.database(), position, params.context.include_declaration)?;
    let in_programs = found.into_iter().filter_map(|place| state.location(place.file, place.span));
    let in_scenes = ide::mentions_in_scenes(state.database(), position);
    Some(in_programs.chain(state.scene_locations(&in_scenes)).collect())
}

/// The occurrences of the name at a position in its document.
pub(crate) fn highlights(
    state: &mut State,
    params: &DocumentHighlightParams,
) -> Option<Vec<DocumentHighlight>> {
    let state = &*state;
    let at = &params.text_document_position_params;
    let document = state.document(&at.text_document.uri)?;
    if let Some(environment) = state.environment_of_scene(document) {
        let (text, offset) = (document.text.to_string(), state.offset(document, at.position));
        let spans = ide::highlights_in_scene(state.database(), environment, &text, offset).into_iter();
        let highlight = |span| DocumentHighlight {
            range: state.range(document, span),
            kind: Some(DocumentHighlightKind::READ),
        };
        return Some(spans.map(highlight).collect());
    }
    let place = state.place(at)?;
    let found = ide::highlights(state.database(), place.position()).into_iter();
    let highlight = |found: ide::Highlight| {
        let kind =
            if found.is_declaration { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        DocumentHighlight { range: state.range(place.document, found.span), kind: Some(kind) }
    };
    Some(found.map(highlight).collect())
}
