//! `textDocument/formatting` and `textDocument/rangeFormatting`. The layout has no options: the client's tab size is not
//! asked for.

use pydslrep_ide as ide;
use pydslrep_syntax as syntax;
use tower_lsp::ls_types::{DocumentFormattingParams, DocumentRangeFormattingParams, TextEdit};

use crate::documents::Document;
use crate::positions::LineTable;
use crate::state::State;

/// The edits that bring a document into the canonical layout.
pub(crate) fn document(state: &State, params: &DocumentFormattingParams) -> Option<Vec<TextEdit>> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    Some(convert(state, document, ide::format(&state.database, file)))
}

/// The same for a range.
pub(crate) fn range(state: &State, params: &DocumentRangeFormattingParams) -> Option<Vec<TextEdit>> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    let span = state.span(document, params.range);
    Some(convert(state, document, ide::format_range(&state.database, file, span)))
}

fn convert(state: &State, document: &Document, edits: Vec<syntax::TextEdit>) -> Vec<TextEdit> {
    let table = LineTable::new(&document.text, state.client.encoding);
    edits.into_iter().map(|edit| TextEdit::new(table.range(edit.span), edit.text)).collect()
}
