//! `textDocument/references` and `textDocument/documentHighlight`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams, Location, ReferenceParams,
};

use crate::state::State;

/// All occurrences of the name at a position.
pub(crate) fn references(state: &State, params: &ReferenceParams) -> Option<Vec<Location>> {
    let place = state.place(&params.text_document_position)?;
    let found = ide::references(state.database(), place.position(), params.context.include_declaration)?;
    Some(found.into_iter().filter_map(|place| state.location(place.file, place.span)).collect())
}

/// The occurrences of the name at a position in its document.
pub(crate) fn highlights(
    state: &mut State,
    params: &DocumentHighlightParams,
) -> Option<Vec<DocumentHighlight>> {
    state.cursor_is(&params.text_document_position_params);
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::highlights(state.database(), place.position()).into_iter();
    let highlight = |found: ide::Highlight| {
        let kind =
            if found.is_declaration { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        DocumentHighlight { range: state.range(place.document, found.span), kind: Some(kind) }
    };
    Some(found.map(highlight).collect())
}
