//! From a use to its declaration.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{GotoDefinitionParams, GotoDefinitionResponse, LocationLink};

use crate::state::State;

/// `textDocument/definition`.
pub(crate) fn definition(state: &State, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::goto_definition(&state.database, place.position())?;
    if !state.client.definition_links {
        let locations = found.targets.iter().filter_map(|target| state.location(target.file, target.focus));
        return Some(GotoDefinitionResponse::Array(locations.collect()));
    }
    let origin = state.range(place.document, found.origin);
    let links = found.targets.iter().filter_map(|target| {
        let document = state.document_of(target.file)?;
        Some(LocationLink {
            origin_selection_range: Some(origin),
            target_uri: document.uri.clone(),
            target_range: state.range(document, target.full),
            target_selection_range: state.range(document, target.focus),
        })
    });
    Some(GotoDefinitionResponse::Link(links.collect()))
}
