//! `textDocument/formatting`, `textDocument/rangeFormatting` and `textDocument/onTypeFormatting`. The layout has no
//! options: the client's tab size is ignored.

use pydslrep_analysis::Snapshot;
use pydslrep_ide as ide;
use pydslrep_syntax as syntax;
use tower_lsp::ls_types::{
    DocumentFormattingParams, DocumentOnTypeFormattingOptions, DocumentOnTypeFormattingParams,
    DocumentRangeFormattingParams, ServerCapabilities, TextEdit,
};

use crate::client::ClientFeatures;
use crate::positions::{Encoding, LineTable, to_span};
use crate::view::View;
use crate::work::Work;

/// The edits that format a document.
pub(crate) fn document(view: &View, params: &DocumentFormattingParams) -> Option<Work<Vec<TextEdit>>> {
    view.work(&params.text_document.uri, |_, encoding| {
        Box::new(move |snapshot| convert(&snapshot, encoding, ide::format(&snapshot)))
    })
}

/// The same for a range.
pub(crate) fn range(view: &View, params: &DocumentRangeFormattingParams) -> Option<Work<Vec<TextEdit>>> {
    view.work(&params.text_document.uri, |document, encoding| {
        let span = to_span(document.text, params.range, encoding);
        Box::new(move |snapshot| convert(&snapshot, encoding, ide::format_range(&snapshot, span)))
    })
}

pub(crate) fn announce_on_type(server: &mut ServerCapabilities, _: &ClientFeatures) {
    server.document_on_type_formatting_provider = Some(DocumentOnTypeFormattingOptions {
        first_trigger_character: "}".to_owned(),
        more_trigger_character: Some(vec!["\n".to_owned()]),
    });
}

/// The edits after a character was typed.
pub(crate) fn on_type(view: &View, params: &DocumentOnTypeFormattingParams) -> Option<Vec<TextEdit>> {
    let place = view.place(&params.text_document_position)?;
    let edits = match params.ch.as_str() {
        "}" => ide::format_after_brace(view.database(), place.position()),
        "\n" => ide::format_after_line_break(view.database(), place.position()),
        _ => Vec::new(),
    };
    let edits = edits.into_iter().map(|edit| TextEdit::new(view.range(place.document, edit.span), edit.text));
    Some(edits.collect())
}

fn convert(snapshot: &Snapshot, encoding: Encoding, edits: Vec<syntax::TextEdit>) -> Vec<TextEdit> {
    let table = LineTable::new(snapshot.text(), encoding);
    edits.into_iter().map(|edit| TextEdit::new(table.range(edit.span), edit.text)).collect()
}
