//! `textDocument/prepareCallHierarchy`, `callHierarchy/incomingCalls` and `callHierarchy/outgoingCalls`.
//!
//! An item needs no data of its own: its document, kind, name and range are enough to find it again.

use pydslrep_ide as ide;
use pydslrep_syntax::{EntityKind, Span};
use tower_lsp::ls_types::{
    CallHierarchyIncomingCall, CallHierarchyIncomingCallsParams, CallHierarchyItem,
    CallHierarchyOutgoingCall, CallHierarchyOutgoingCallsParams, CallHierarchyPrepareParams, Range,
};

use crate::documents::Document;
use crate::handlers::document_symbols::kind;
use crate::view::View;

/// The environment, movement or robot at a position.
pub(crate) fn prepare(view: &View, params: &CallHierarchyPrepareParams) -> Option<Vec<CallHierarchyItem>> {
    let place = view.place(&params.text_document_position_params)?;
    let found = ide::call_items(view.database(), place.position()).into_iter();
    let items: Vec<_> = found.filter_map(|item| convert(view, item)).collect();
    (!items.is_empty()).then_some(items)
}

/// Returns the callers: environments that run a movement or a robot.
pub(crate) fn incoming(
    view: &View,
    params: &CallHierarchyIncomingCallsParams,
) -> Option<Vec<CallHierarchyIncomingCall>> {
    let called = find(view, &params.item)?;
    let calls = ide::incoming_calls(view.database(), &called).into_iter().filter_map(|call| {
        let from_ranges = ranges(view, view.document_of(call.item.file)?, &call.ranges);
        Some(CallHierarchyIncomingCall { from: convert(view, call.item)?, from_ranges })
    });
    Some(calls.collect())
}

/// Returns the callees: the movements that an environment runs, or that a movement does.
pub(crate) fn outgoing(
    view: &View,
    params: &CallHierarchyOutgoingCallsParams,
) -> Option<Vec<CallHierarchyOutgoingCall>> {
    let caller = find(view, &params.item)?;
    let document = view.document_of(caller.file)?;
    let calls = ide::outgoing_calls(view.database(), &caller).into_iter().filter_map(|call| {
        let from_ranges = ranges(view, document, &call.ranges);
        Some(CallHierarchyOutgoingCall { to: convert(view, call.item)?, from_ranges })
    });
    Some(calls.collect())
}

fn find(view: &View, item: &CallHierarchyItem) -> Option<ide::CallItem> {
    let (document, file) = view.analysed(&item.uri)?;
    let of_kind = |entity: &EntityKind| kind(ide::SymbolKind::Entity(*entity)) == item.kind;
    let kind = EntityKind::ALL.into_iter().find(of_kind)?;
    ide::call_item(view.database(), file, kind, &item.name, view.span(document, item.selection_range))
}

fn convert(view: &View, item: ide::CallItem) -> Option<CallHierarchyItem> {
    let document = view.document_of(item.file)?;
    Some(CallHierarchyItem {
        name: item.name,
        kind: kind(ide::SymbolKind::Entity(item.kind)),
        tags: None,
        detail: Some(item.detail).filter(|detail| !detail.is_empty()),
        uri: document.uri()?,
        range: view.range(document, item.full),
        selection_range: view.range(document, item.focus),
        data: None,
    })
}

fn ranges(view: &View, document: Document<'_>, spans: &[Span]) -> Vec<Range> {
    spans.iter().map(|span| view.range(document, *span)).collect()
}
