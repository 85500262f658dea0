//! From a use, in a program or a scene, to its declaration, and from a movement to its robot.

use pydslrep_analysis::Database;
use pydslrep_ide as ide;
use tower_lsp::ls_types::{GotoDefinitionParams, GotoDefinitionResponse, LocationLink};

use crate::state::State;

/// `textDocument/definition`.
pub(crate) fn definition(state: &State, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    go_to(state, params, ide::goto_definition, state.client.definition_links)
}

/// `textDocument/declaration`: here a thing is declared where it is defined.
pub(crate) fn declaration(state: &State, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    go_to(state, params, ide::goto_definition, state.client.declaration_links)
}

/// `textDocument/typeDefinition`.
pub(crate) fn type_definition(
    state: &State,
    params: &GotoDefinitionParams,
) -> Option<GotoDefinitionResponse> {
    go_to(state, params, ide::goto_type_definition, state.client.type_definition_links)
}

fn go_to(
    state: &State,
    params: &GotoDefinitionParams,
    feature: fn(&Database, ide::FilePosition) -> Option<ide::Definition>,
    links: bool,
) -> Option<GotoDefinitionResponse> {
    let named = state.named(&params.text_document_position_params)?;
    let found = feature(state.database(), named.position)?;
    if !links {
        let locations = found.targets.iter().filter_map(|target| state.location(target.file, target.focus));
        return Some(GotoDefinitionResponse::Array(locations.collect()));
    }
    let origin = state.range(named.document, named.span.unwrap_or(found.origin));
    let links = found.targets.iter().filter_map(|target| {
        let document = state.document_of(target.file)?;
        Some(LocationLink {
            origin_selection_range: Some(origin),
            target_uri: document.uri()?,
            target_range: state.range(document, target.full),
            target_selection_range: state.range(document, target.focus),
        })
    });
    Some(GotoDefinitionResponse::Link(links.collect()))
}
