//! `textDocument/documentSymbol`.

use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use tower_lsp::ls_types::{DocumentSymbolParams, Location, SymbolInformation, SymbolKind, Uri};

use crate::positions::LineTable;
use crate::state::State;
use crate::work::Work;

/// The outline of a document.
pub(crate) fn document_symbols(state: &mut State, params: &DocumentSymbolParams) -> Option<Work<Outline>> {
    let as_tree = state.client.symbol_tree;
    state.work(&params.text_document.uri, |document, encoding| {
        let uri = document.uri.clone();
        Box::new(move |snapshot| {
            let symbols = ide::document_symbols(snapshot);
            let table = LineTable::new(snapshot.text(), encoding);
            if as_tree {
                return Outline::Tree(table, symbols);
            }
            let mut flat = Vec::new();
            flatten(&table, &uri, symbols, None, &mut flat);
            Outline::List(flat)
        })
    })
}

/// An answer: a tree, or for clients that know nothing else a list.
pub(crate) enum Outline {
    /// As it is, to be converted symbol by symbol when it is written: a long file's may be megabytes.
    Tree(LineTable, Vec<ide::Symbol>),
    List(Vec<SymbolInformation>),
}

impl Serialize for Outline {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Tree(table, symbols) => Branches { table, symbols }.serialize(serializer),
            Self::List(list) => list.serialize(serializer),
        }
    }
}

struct Branches<'a> {
    table: &'a LineTable,
    symbols: &'a [ide::Symbol],
}

impl Serialize for Branches<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.symbols.iter().map(|symbol| Branch { table: self.table, symbol }))
    }
}

/// The protocol's `DocumentSymbol`.
struct Branch<'a> {
    table: &'a LineTable,
    symbol: &'a ide::Symbol,
}

impl Serialize for Branch<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { table, symbol } = self;
        let mut fields = serializer.serialize_map(None)?;
        fields.serialize_entry("name", symbol.name.as_str())?;
        if !symbol.detail.is_empty() {
            fields.serialize_entry("detail", symbol.detail.as_str())?;
        }
        fields.serialize_entry("kind", &kind(symbol.kind))?;
        fields.serialize_entry("range", &table.range(symbol.full))?;
        fields.serialize_entry("selectionRange", &table.range(symbol.focus))?;
        if !symbol.children.is_empty() {
            fields.serialize_entry("children", &Branches { table, symbols: &symbol.children })?;
        }
        fields.end()
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
            name: symbol.name.to_string(),
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
