//! `textDocument/inlayHint`.

use pydslrep_ide as ide;
use pydslrep_syntax::Span;
use tower_lsp::ls_types::{
    InlayHint, InlayHintLabel, InlayHintParams, InlayHintTooltip, MarkupContent, MarkupKind, Range, TextEdit,
};

use crate::view::View;

/// The hints in a range. The document caches what they are computed from.
pub(crate) fn inlay_hints(view: &View, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let document = view.document(&params.text_document.uri)?;
    let typing = view.typing.as_ref().filter(|typing| typing.key == document.key);
    let places = ide::InlayHintPlaces {
        file: document.file?,
        range: view.span(document, params.range),
        typed: &typing.map_or_else(Vec::new, |typing| typing.lines(document.text)),
    };
    let wanted = &document.settings.inlay_hints;
    let options =
        ide::InlayHintOptions { pose: wanted.pose, duration: wanted.duration, defaults: wanted.defaults };
    let hints = ide::inlay_hints(view.database(), places, options, &mut document.memory().movements.lock());
    let hints = hints.into_iter().map(|hint| {
        let position = view.range(document, Span::at(hint.offset)).start;
        let edit = |text| vec![TextEdit::new(Range::new(position, position), text)];
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
