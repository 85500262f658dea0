//! `textDocument/documentSymbol`.

use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use tower_lsp::ls_types::{
    DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, Location, SymbolInformation, SymbolKind,
    Uri,
};

use crate::positions::LineTable;
use crate::state::State;
use crate::work::Work;

/// The outline of a document.
pub(crate) fn document_symbols(
    state: &mut State,
    params: &DocumentSymbolParams,
) -> Option<Work<DocumentSymbolResponse>> {
    let as_tree = state.client.symbol_tree;
    state.work(&params.text_document.uri, |document, encoding| {
        let uri = document.uri.clone();
        Box::new(move |snapshot| {
            let symbols = ide::document_symbols(snapshot);
            let table = LineTable::new(snapshot.text(), encoding);
            if as_tree {
                let tree = symbols.into_iter().map(|symbol| convert(&table, symbol)).collect();
                return DocumentSymbolResponse::Nested(tree);
            }
            let mut flat = Vec::new();
            flatten(&table, &uri, symbols, None, &mut flat);
            DocumentSymbolResponse::Flat(flat)
        })
    })
}

#[expect(deprecated, reason = "the field must be filled even where it is not used")]
fn convert(table: &LineTable, symbol: ide::Symbol) -> DocumentSymbol {
    let children: Vec<_> = symbol.children.into_iter().map(|child| convert(table, child)).collect();
    DocumentSymbol {
        name: symbol.name,
        detail: Some(symbol.detail).filter(|detail| !detail.is_empty()),
        kind: kind(symbol.kind),
        tags: None,
        deprecated: None,
        range: table.range(symbol.full),
        selection_range: table.range(symbol.focus),
        children: (!children.is_empty()).then_some(children),
    }
}

/// For clients that know lists only: each symbol says what it is in.
#[expect(deprecated, reason = "the form, and the field, that old clients know")]
fn flatten(
    table: &LineTable,
    uri: &Uri,
    symbols: Vec<ide::Symbol>,
    container: Option<&str>,
    flat: &mut Vec<SymbolInformation>,
) {
    for symbol in symbols {
        flat.push(SymbolInformation {
            name: symbol.name.clone(),
            kind: kind(symbol.kind),
            tags: None,
            deprecated: None,
            location: Location::new(uri.clone(), table.range(symbol.full)),
            container_name: container.map(str::to_owned),
        });
        flatten(table, uri, symbol.children, Some(&symbol.name), flat);
    }
}

/// The protocol's nearest kind, a different one for each of ours.
pub(crate) fn kind(kind: ide::SymbolKind) -> SymbolKind {
    match kind {
        ide::SymbolKind::Entity(EntityKind::Wheel) => SymbolKind::VARIABLE,
        ide::SymbolKind::Entity(EntityKind::Sensor) => SymbolKind::PROPERTY,
        ide::SymbolKind::Entity(EntityKind::Ip) => SymbolKind::CONSTANT,
        ide::SymbolKind::Entity(EntityKind::Robot) => SymbolKind::CLASS,
        ide::SymbolKind::Entity(EntityKind::Movement) => SymbolKind::FUNCTION,
        ide::SymbolKind::Entity(EntityKind::Environment) => SymbolKind::NAMESPACE,
        ide::SymbolKind::Action => SymbolKind::EVENT,
    }
}
