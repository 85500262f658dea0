//! `workspace/symbol`.

use pydslrep_analysis::FileId;
use pydslrep_ide as ide;
use ropey::Rope;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{SymbolInformation, WorkspaceSymbolParams, WorkspaceSymbolResponse};

use crate::handlers::document_symbols::kind;
use crate::reader::Reader;
use crate::server::Server;
use crate::view::View;

/// The declarations of all files whose names match the query, in the form that every client knows.
pub(crate) async fn workspace_symbols(
    server: Server,
    params: WorkspaceSymbolParams,
) -> Result<Option<WorkspaceSymbolResponse>> {
    let mut reader = Reader::new(server);
    let mut search = ide::SymbolSearch::new(&params.query);
    let files: Vec<FileId> = reader.state().view.database().files().collect();
    for file in files {
        search.add(reader.state().view.database(), file);
        let length = reader.state().view.database().text(file).map_or(0, Rope::len_bytes);
        reader.has_read(length).await;
    }
    let view = &reader.state().view;
    let found = search.finish(view.database()).into_iter();
    Ok(Some(WorkspaceSymbolResponse::Flat(found.filter_map(|symbol| convert(view, symbol)).collect())))
}

#[expect(deprecated, reason = "the field must be filled even where it is not used")]
fn convert(view: &View, symbol: ide::WorkspaceSymbol) -> Option<SymbolInformation> {
    Some(SymbolInformation {
        name: symbol.name,
        kind: kind(ide::SymbolKind::Entity(symbol.kind)),
        tags: None,
        deprecated: None,
        location: view.location(symbol.file, symbol.focus)?,
        container_name: symbol.container,
    })
}
