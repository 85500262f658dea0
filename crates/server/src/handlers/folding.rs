//! `textDocument/foldingRange`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{FoldingRange, FoldingRangeKind, FoldingRangeParams, Range};

use crate::positions::LineTable;
use crate::view::View;
use crate::work::Work;

/// Everything in a document that can be folded.
pub(crate) fn folding_ranges(view: &View, params: &FoldingRangeParams) -> Option<Work<Vec<FoldingRange>>> {
    let whole_lines = view.client.line_folding_only;
    view.work(&params.text_document.uri, |_, encoding| {
        Box::new(move |snapshot| {
            let table = LineTable::new(snapshot.text(), encoding);
            let folds = ide::folding_ranges(&snapshot);
            folds.iter().filter_map(|fold| convert(fold, table.range(fold.span), whole_lines)).collect()
        })
    })
}

fn convert(fold: &ide::Fold, range: Range, whole_lines: bool) -> Option<FoldingRange> {
    let Range { start, mut end } = range;
    if whole_lines && fold.keeps_last_line {
        end.line -= 1;
    }
    (end.line > start.line).then(|| FoldingRange {
        start_line: start.line,
        start_character: (!whole_lines).then_some(start.character),
        end_line: end.line,
        end_character: (!whole_lines).then_some(end.character),
        kind: match fold.kind {
            ide::FoldKind::Entity => None,
            ide::FoldKind::Comment => Some(FoldingRangeKind::Comment),
            ide::FoldKind::Region => Some(FoldingRangeKind::Region),
            ide::FoldKind::Imports => Some(FoldingRangeKind::Imports),
        },
        collapsed_text: None,
    })
}
