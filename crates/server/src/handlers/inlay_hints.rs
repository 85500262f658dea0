//! `textDocument/inlayHint`.

use pydslrep_ide as ide;
use pydslrep_syntax::Span;
use tower_lsp::ls_types::{
    InlayHint, InlayHintLabel, InlayHintParams, InlayHintTooltip, MarkupContent, MarkupKind, Range, TextEdit,
};

use crate::documents::key;
use crate::positions::{to_range, to_span};
use crate::state::State;

/// The hints in a range. The document caches what they are computed from.
pub(crate) fn inlay_hints(state: &mut State, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let key = key(&params.text_document.uri);
    let encoding = state.client.encoding;
    let document = state.workspace.document(&key)?;
    let client = state.clients.entry(key.clone()).or_default();
    let typing = state.typing.as_ref().filter(|typing| typing.key == key);
    let places = ide::InlayHintPlaces {
        file: document.file?,
        range: to_span(&document.text, params.range, encoding),
        typed: &typing.map_or_else(Vec::new, |typing| typing.lines(&document.text)),
    };
    let wanted = &document.settings.inlay_hints;
    let options =
        ide::InlayHintOptions { pose: wanted.pose, duration: wanted.duration, defaults: wanted.defaults };
    let hints = ide::inlay_hints(state.workspace.database(), places, options, &mut client.movements);
    let hints = hints.into_iter().map(|hint| {
        let position = to_range(&document.text, Span::at(hint.offset), encoding).start;
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
