//! From a use, in a program or a scene, to its declaration, and from a movement to its robot.

use pydslrep_analysis::Database;
use pydslrep_ide as ide;
use tower_lsp::ls_types::{GotoDefinitionParams, GotoDefinitionResponse, LocationLink};

use crate::view::View;

/// `textDocument/definition`.
pub(crate) fn definition(view: &View, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    go_to(view, params, ide::goto_definition, view.client.definition_links)
}

/// `textDocument/declaration`: here a thing is declared where it is defined.
pub(crate) fn declaration(view: &View, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    go_to(view, params, ide::goto_definition, view.client.declaration_links)
}

/// `textDocument/typeDefinition`.
pub(crate) fn type_definition(view: &View, params: &GotoDefinitionParams) -> Option<GotoDefinitionResponse> {
    go_to(view, params, ide::goto_type_definition, view.client.type_definition_links)
}

fn go_to(
    view: &View,
    params: &GotoDefinitionParams,
    feature: fn(&Database, ide::FilePosition) -> Option<ide::Definition>,
    links: bool,
) -> Option<GotoDefinitionResponse> {
    let named = view.named(&params.text_document_position_params)?;
    let found = feature(view.database(), named.position)?;
    if !links {
        let locations = found.targets.iter().filter_map(|target| view.location(target.file, target.focus));
        return Some(GotoDefinitionResponse::Array(locations.collect()));
    }
    let origin = view.range(named.document, named.span.unwrap_or(found.origin));
    let links = found.targets.iter().filter_map(|target| {
        let document = view.document_of(target.file)?;
        Some(LocationLink {
            origin_selection_range: Some(origin),
            target_uri: document.uri()?,
            target_range: view.range(document, target.full),
            target_selection_range: view.range(document, target.focus),
        })
    });
    Some(GotoDefinitionResponse::Link(links.collect()))
}
