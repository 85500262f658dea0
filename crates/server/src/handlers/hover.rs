//! `textDocument/hover`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{Hover, HoverContents, HoverParams, MarkedString, MarkupContent};

use crate::state::State;

/// What is known about the thing at a position.
pub(crate) fn hover(state: &State, params: &HoverParams) -> Option<Hover> {
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::hover(&state.database, place.position())?;
    let contents = match &state.client.hover_format {
        Some(kind) => HoverContents::Markup(MarkupContent { kind: kind.clone(), value: found.markdown }),
        // The older form, which is Markdown by definition.
        None => HoverContents::Scalar(MarkedString::String(found.markdown)),
    };
    Some(Hover { contents, range: Some(state.range(place.document, found.span)) })
}
