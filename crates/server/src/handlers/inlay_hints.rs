//! `textDocument/inlayHint`.

use pydslrep_ide as ide;
use tower_lsp::ls_types::{
    InlayHint, InlayHintLabel, InlayHintParams, InlayHintTooltip, MarkupContent, MarkupKind, TextEdit,
};

use crate::state::State;

/// The hints in a range.
pub(crate) fn inlay_hints(state: &State, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    let range = state.span(document, params.range);
    let wanted = document.settings.inlay_hints;
    let options =
        ide::InlayHintOptions { pose: wanted.pose, duration: wanted.duration, defaults: wanted.defaults };
    let hints = ide::inlay_hints(&state.database, file, range, options).into_iter().map(|hint| {
        let position = state.range(document, pydslrep_syntax::Span::at(hint.offset)).start;
        let edit = |text| vec![TextEdit::new(tower_lsp::ls_types::Range::new(position, position), text)];
        let tooltip = MarkupContent { kind: MarkupKind::Markdown, value: hint.tooltip };
        InlayHint {
            position,
            label: InlayHintLabel::String(hint.label),
            kind: None,
            text_edits: hint.insert.map(edit),
            tooltip: Some(InlayHintTooltip::MarkupContent(tooltip)),
            padding_left: Some(true),
            padding_right: None,
            data: None,
        }
    });
    Some(hints.collect())
}
