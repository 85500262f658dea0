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

/// All occurrences of the name at a position.
pub(crate) fn references(state: &mut State, params: &ReferenceParams) -> Option<Vec<Location>> {
    let state = &*state;
    let place = state.place(&params.text_document_position)?;
    let found = ide::references(state.database(), place.position(), params.context.include_declaration)?;
    Some(found.into_iter().filter_map(|place| state.location(place.file, place.span)).collect())
}

/// The occurrences of the name at a position in its document.
pub(crate) fn highlights(
    state: &mut State,
    params: &DocumentHighlightParams,
) -> Option<Vec<DocumentHighlight>> {
    let state = &*state;
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::highlights(state.database(), place.position()).into_iter();
    let highlight = |found: ide::Highlight| {
        let kind =
            if found.is_declaration { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        DocumentHighlight { range: state.range(place.document, found.span), kind: Some(kind) }
    };
    Some(found.map(highlight).collect())
}
