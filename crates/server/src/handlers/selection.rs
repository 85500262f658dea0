//! `textDocument/selectionRange`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{SelectionRange, SelectionRangeParams};

use crate::view::View;

/// The ranges to which a selection expands, from each position.
pub(crate) fn selection_ranges(view: &View, params: &SelectionRangeParams) -> Option<Vec<SelectionRange>> {
    let (document, file) = view.analysed(&params.text_document.uri)?;
    let offsets: Vec<u32> =
        params.positions.iter().map(|position| view.offset(document, *position)).collect();
    let found = ide::selection_ranges(view.database(), file, &offsets);
    let nest = |spans: Vec<_>| {
        spans.into_iter().rev().fold(None, |parent, span| {
            Some(SelectionRange { range: view.range(document, span), parent: parent.map(Box::new) })
        })
    };
    Some(found.into_iter().filter_map(nest).collect())
}
