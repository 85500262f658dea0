//! `textDocument/documentSymbol`.

use pydslrep_analysis::Snapshot;
use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use serde::Serialize;
use tower_lsp::ls_types::{DocumentSymbolParams, Location, Range, SymbolInformation, SymbolKind, Uri};

use crate::message::WriteJson;
use crate::positions::LineTable;
use crate::view::View;
use crate::work::Work;

/// The outline of a document.
pub(crate) fn document_symbols(view: &View, params: &DocumentSymbolParams) -> Option<Work<Outline>> {
    let as_tree = view.client.symbol_tree;
    let uri = params.text_document.uri.clone();
    if let Some((document, file, text)) = view.toml_text(&uri) {
        let table = LineTable::new(document.text, view.client.encoding);
        let symbols = ide::toml_symbols(file, &text);
        return Some(Work::Done(if as_tree {
            Outline::Ready(table, symbols)
        } else {
            let mut flat = Vec::new();
            flatten(&table, &uri, symbols.into_iter(), None, &mut flat);
            Outline::List(flat)
        }));
    }
    view.work(&params.text_document.uri, |_, encoding| {
        Box::new(move |snapshot| {
            let table = LineTable::new(snapshot.text(), encoding);
            if as_tree {
                return Outline::Tree(table, snapshot);
            }
            let mut flat = Vec::new();
            flatten(&table, &uri, ide::document_symbols(&snapshot), None, &mut flat);
            Outline::List(flat)
        })
    })
}

/// An answer: a tree, or a list for clients that support nothing else.
pub(crate) enum Outline {
    /// Of this file, symbol by symbol when it is written: a long file's may be megabytes.
    Tree(LineTable, Snapshot),
    /// Of a TOML file.
    Ready(LineTable, Vec<ide::Symbol>),
    List(Vec<SymbolInformation>),
}

/// The largest answer, requested after every pause in typing. Written by hand it takes 0.04 ms for a thousand lines, by
/// serde 0.13 ms.
impl WriteJson for Outline {
    fn write_json(&self, json: &mut Vec<u8>) -> serde_json::Result<()> {
        match self {
            Self::Tree(table, snapshot) => {
                write_tree(table, ide::document_symbols(snapshot), json);
                Ok(())
            }
            Self::Ready(table, symbols) => {
                write_tree(table, symbols.iter().cloned(), json);
                Ok(())
            }
            Self::List(list) => list.write_json(json),
        }
    }
}

/// The protocol's `DocumentSymbol[]`.
fn write_tree(table: &LineTable, symbols: impl Iterator<Item = ide::Symbol>, json: &mut Vec<u8>) {
    json.push(b'[');
    for (index, symbol) in symbols.enumerate() {
        json.extend(if index == 0 { &b"{\"name\":"[..] } else { b",{\"name\":" });
        write_plain(symbol.name.as_str(), json);
        if !symbol.detail.is_empty() {
            json.extend(b",\"detail\":");
            write_plain(symbol.detail.as_str(), json);
        }
        json.extend(b",\"kind\":");
        write_plain(&kind(symbol.kind), json);
        json.extend(b",\"range\":");
        write_range(table.range(symbol.full), json);
        json.extend(b",\"selectionRange\":");
        write_range(table.range(symbol.focus), json);
        if !symbol.children.is_empty() {
            json.extend(b",\"children\":");
            write_tree(table, symbol.children.into_iter(), json);
        }
        json.push(b'}');
    }
    json.push(b']');
}

fn write_plain(value: &(impl Serialize + ?Sized), json: &mut Vec<u8>) {
    // Writing a number or a text into memory cannot fail.
    let _ = serde_json::to_writer(json, value);
}

fn write_range(range: Range, json: &mut Vec<u8>) {
    let mut digits = itoa::Buffer::new();
    let mut put = |before: &[u8], number: u32| {
        json.extend(before);
        json.extend(digits.format(number).as_bytes());
    };
    put(b"{\"start\":{\"line\":", range.start.line);
    put(b",\"character\":", range.start.character);
    put(b"},\"end\":{\"line\":", range.end.line);
    put(b",\"character\":", range.end.character);
    json.extend(b"}}");
}

/// For clients that support only lists: each symbol names its container.
#[expect(deprecated, reason = "the form, and the field, that old clients know")]
fn flatten(
    table: &LineTable,
    uri: &Uri,
    symbols: impl Iterator<Item = ide::Symbol>,
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
        flatten(table, uri, symbol.children.into_iter(), Some(&symbol.name), flat);
    }
}

/// The closest kind of the protocol, a different one for each of ours.
pub(crate) fn kind(kind: ide::SymbolKind) -> SymbolKind {
    match kind {
        ide::SymbolKind::Entity(EntityKind::Wheel) => SymbolKind::VARIABLE,
        ide::SymbolKind::Entity(EntityKind::Sensor) => SymbolKind::PROPERTY,
        ide::SymbolKind::Entity(EntityKind::Ip) => SymbolKind::CONSTANT,
        ide::SymbolKind::Entity(EntityKind::Robot) => SymbolKind::CLASS,
        ide::SymbolKind::Entity(EntityKind::Movement) => SymbolKind::FUNCTION,
        ide::SymbolKind::Entity(EntityKind::Environment) => SymbolKind::NAMESPACE,
        ide::SymbolKind::Action => SymbolKind::EVENT,
        ide::SymbolKind::Obstacle => SymbolKind::OBJECT,
        ide::SymbolKind::Table => SymbolKind::STRUCT,
    }
}

#[cfg(test)]
mod tests {
    use ropey::Rope;
    use tower_lsp::ls_types::DocumentSymbol;

    use super::*;
    use crate::positions::Encoding;

    /// In the types of the protocol's library.
    #[expect(deprecated, reason = "the library has a field that is")]
    fn convert(table: &LineTable, symbols: &[ide::Symbol]) -> Vec<DocumentSymbol> {
        let convert_one = |symbol: &ide::Symbol| DocumentSymbol {
            name: symbol.name.to_string(),
            detail: (!symbol.detail.is_empty()).then(|| symbol.detail.to_string()),
            kind: kind(symbol.kind),
            tags: None,
            deprecated: None,
            range: table.range(symbol.full),
            selection_range: table.range(symbol.focus),
            children: (!symbol.children.is_empty()).then(|| convert(table, &symbol.children)),
        };
        symbols.iter().map(convert_one).collect()
    }

    #[test]
    fn a_tree_is_written_as_the_protocol_wants_it() {
        let text = "wheel \"é\\\u{1} with radius 4\nwheel b with radius 4 robot r with port 1 has { a b } wheels\n\
                    movement m of r {\n  move 1 meters turn left\n  slam\n}\nsensor 🤖 environment e";
        for text in [text, "", "sensor s"] {
            let mut database = pydslrep_analysis::Database::new();
            let file = database.open("/a.pyr", text);
            let snapshot = database.snapshot(file, None).unwrap();
            let table = LineTable::new(&Rope::from_str(text), Encoding::Utf16);
            let symbols: Vec<_> = ide::document_symbols(&snapshot).collect();
            let expected = serde_json::to_string(&convert(&table, &symbols)).unwrap();
            let mut json = Vec::new();
            Outline::Tree(table, snapshot).write_json(&mut json).unwrap();
            assert_eq!(String::from_utf8(json).unwrap(), expected);
        }
    }
}
