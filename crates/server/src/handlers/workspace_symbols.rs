//! `workspace/symbol`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{SymbolInformation, WorkspaceSymbolParams, WorkspaceSymbolResponse};

use crate::handlers::document_symbols::kind;
use crate::state::State;

/// The declarations of all files whose names match what was typed, in the form that every client knows.
pub(crate) fn workspace_symbols(state: &State, params: &WorkspaceSymbolParams) -> WorkspaceSymbolResponse {
    let found = ide::workspace_symbols(&state.database, &params.query).into_iter();
    WorkspaceSymbolResponse::Flat(found.filter_map(|symbol| convert(state, symbol)).collect())
}

#[expect(deprecated, reason = "the field must be filled even where it is not used")]
fn convert(state: &State, symbol: ide::WorkspaceSymbol) -> Option<SymbolInformation> {
    Some(SymbolInformation {
        name: symbol.name,
        kind: kind(ide::SymbolKind::Entity(symbol.kind)),
        tags: None,
        deprecated: None,
        location: state.location(symbol.file, symbol.focus)?,
        container_name: symbol.container,
    })
}
