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
use crate::state::State;

/// The environment, movement or robot at a position.
pub(crate) fn prepare(state: &State, params: &CallHierarchyPrepareParams) -> Option<Vec<CallHierarchyItem>> {
    let place = state.place(&params.text_document_position_params)?;
    let found = ide::call_items(state.database(), place.position()).into_iter();
    let items: Vec<_> = found.filter_map(|item| convert(state, item)).collect();
    (!items.is_empty()).then_some(items)
}

/// Returns the callers: environments that run a movement or a robot.
pub(crate) fn incoming(
    state: &State,
    params: &CallHierarchyIncomingCallsParams,
) -> Option<Vec<CallHierarchyIncomingCall>> {
    let called = find(state, &params.item)?;
    let calls = ide::incoming_calls(state.database(), &called).into_iter().filter_map(|call| {
        let from_ranges = ranges(state, state.document_of(call.item.file)?, &call.ranges);
        Some(CallHierarchyIncomingCall { from: convert(state, call.item)?, from_ranges })
    });
    Some(calls.collect())
}

/// Returns the callees: the movements that an environment runs, or that a movement does.
pub(crate) fn outgoing(
    state: &State,
    params: &CallHierarchyOutgoingCallsParams,
) -> Option<Vec<CallHierarchyOutgoingCall>> {
    let caller = find(state, &params.item)?;
    let document = state.document_of(caller.file)?;
    let calls = ide::outgoing_calls(state.database(), &caller).into_iter().filter_map(|call| {
        let from_ranges = ranges(state, document, &call.ranges);
        Some(CallHierarchyOutgoingCall { to: convert(state, call.item)?, from_ranges })
    });
    Some(calls.collect())
}

fn find(state: &State, item: &CallHierarchyItem) -> Option<ide::CallItem> {
    let (document, file) = state.analysed(&item.uri)?;
    let of_kind = |entity: &EntityKind| kind(ide::SymbolKind::Entity(*entity)) == item.kind;
    let kind = EntityKind::ALL.into_iter().find(of_kind)?;
    ide::call_item(state.database(), file, kind, &item.name, state.span(document, item.selection_range))
}

fn convert(state: &State, item: ide::CallItem) -> Option<CallHierarchyItem> {
    let document = state.document_of(item.file)?;
    Some(CallHierarchyItem {
        name: item.name,
        kind: kind(ide::SymbolKind::Entity(item.kind)),
        tags: None,
        detail: Some(item.detail).filter(|detail| !detail.is_empty()),
        uri: document.uri()?,
        range: state.range(document, item.full),
        selection_range: state.range(document, item.focus),
        data: None,
    })
}

fn ranges(state: &State, document: Document<'_>, spans: &[Span]) -> Vec<Range> {
    spans.iter().map(|span| state.range(document, *span)).collect()
}
