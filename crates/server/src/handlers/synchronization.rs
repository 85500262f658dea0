//! Documents opened, changed and closed. Only the order of messages counts, not the version numbers: an editor may
//! close a document and open it again with a lower version.

use tower_lsp::ls_types::notification::LogTrace;
use tower_lsp::ls_types::{
    DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    DidSaveTextDocumentParams, LogTraceParams, ServerCapabilities, SetTraceParams,
    TextDocumentSyncCapability, TextDocumentSyncKind, TextDocumentSyncOptions, TextDocumentSyncSaveOptions,
};

use crate::client::ClientFeatures;
use crate::handlers::scripts;
use crate::log::log;
use crate::message::Outbox;
use crate::state::State;

pub(crate) fn announce(server: &mut ServerCapabilities, client: &ClientFeatures) {
    server.position_encoding = Some(client.encoding.kind());
    server.text_document_sync = Some(TextDocumentSyncCapability::Options(TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        save: Some(TextDocumentSyncSaveOptions::Supported(true)),
        ..TextDocumentSyncOptions::default()
    }));
}

/// `textDocument/didOpen`.
pub(crate) fn open(state: &mut State, params: &DidOpenTextDocumentParams, _: &Outbox) {
    state.open(&params.text_document);
}

/// `textDocument/didChange`.
pub(crate) fn change(state: &mut State, params: &DidChangeTextDocumentParams, outbox: &Outbox) {
    if !state.change(params) {
        let uri = params.text_document.uri.as_str();
        log(format_args!("a document was changed that is not open: {uri}"));
    }
    log_costs(state, params, outbox);
}

/// `textDocument/didSave`.
pub(crate) fn save(state: &mut State, params: &DidSaveTextDocumentParams, outbox: &Outbox) {
    state.saved(&params.text_document.uri);
    scripts::save(state, &params.text_document.uri, outbox);
}

/// `$/setTrace`.
pub(crate) fn set_trace(state: &mut State, params: &SetTraceParams, _: &Outbox) {
    state.trace = params.value;
}

/// `$/logTrace`: the cost of the changes of a message, for clients that trace verbosely.
fn log_costs(state: &mut State, params: &DidChangeTextDocumentParams, outbox: &Outbox) {
    for counts in state.costs.drain(..) {
        let message = format!("changed {}", params.text_document.uri.as_str());
        let verbose = format!(
            "relexed: {} tokens, reparsed: {} entities, revalidated: {} entities",
            counts.relexed, counts.reparsed, counts.revalidated
        );
        outbox.send_notification::<LogTrace>(&LogTraceParams { message, verbose: Some(verbose) });
    }
}

/// `textDocument/didClose`.
pub(crate) fn close(state: &mut State, params: &DidCloseTextDocumentParams, _: &Outbox) {
    let uri = &params.text_document.uri;
    if !state.close(uri) {
        log(format_args!("a document was closed that is not open: {}", uri.as_str()));
    }
}

#[cfg(test)]
mod tests {
    use std::str::FromStr;

    use tower_lsp::ls_types::{
        Position, Range, TextDocumentContentChangeEvent, TextDocumentItem, Uri,
        VersionedTextDocumentIdentifier,
    };

    use super::*;

    const ADDRESS: &str = "file:///tmp/a.pyr";

    fn uri() -> Uri {
        Uri::from_str(ADDRESS).unwrap()
    }

    fn open_text(state: &mut State, version: i32, text: &str) {
        let text_document = TextDocumentItem::new(uri(), "pydslrep".to_owned(), version, text.to_owned());
        state.open(&text_document);
    }

    /// One change after the other: `None` replaces the whole text, else line and column of start and end.
    fn change_text(state: &mut State, version: i32, changes: &[(Option<[u32; 4]>, &str)]) -> bool {
        let content_changes = changes
            .iter()
            .map(|&(range, text)| TextDocumentContentChangeEvent {
                range: range.map(|[a, b, c, d]| Range::new(Position::new(a, b), Position::new(c, d))),
                range_length: None,
                text: text.to_owned(),
            })
            .collect();
        let text_document = VersionedTextDocumentIdentifier::new(uri(), version);
        state.change(&DidChangeTextDocumentParams { text_document, content_changes })
    }

    /// The document's text; the database must have the same.
    fn text(state: &State) -> String {
        let (document, file) = state.view.analysed(&uri()).unwrap();
        assert_eq!(Some(document.text), state.view.database().text(file));
        document.text.to_string()
    }

    #[test]
    fn each_change_of_one_message_is_made_in_the_text_the_one_before_left() {
        let mut state = State::default();
        open_text(&mut state, 1, "one\r\ntwo\r\n");
        let changes = [
            (Some([0, 3, 1, 0]), " "),
            (Some([0, 7, 0, 7]), "🤖"),
            (Some([0, 9, 0, 99]), "!"),
            (Some([1, 0, 1, 0]), "é"),
        ];
        assert!(change_text(&mut state, 2, &changes));
        assert_eq!(text(&state), "one two🤖!\r\né");
        assert!(change_text(&mut state, 3, &[(None, "new"), (Some([0, 3, 0, 0]), "er")]));
        assert_eq!(text(&state), "er", "a reversed range is understood");
        assert_eq!(state.view.document(&uri()).unwrap().version(), Some(3));
    }

    #[test]
    fn carriage_returns_may_be_joined_and_parted() {
        let mut state = State::default();
        open_text(&mut state, 1, "a\r\nb");
        assert!(change_text(&mut state, 2, &[(Some([0, 1, 1, 0]), "\r"), (Some([1, 0, 1, 0]), "\n")]));
        assert_eq!(text(&state), "a\r\nb");
        assert!(change_text(&mut state, 3, &[(Some([1, 0, 1, 0]), "x\ry\n")]));
        assert_eq!(text(&state), "a\r\nx\ry\nb");
        assert!(change_text(&mut state, 4, &[(Some([3, 0, 3, 1]), "c")]));
        assert_eq!(text(&state), "a\r\nx\ry\nc");
    }

    #[test]
    fn a_document_may_be_opened_twice_and_again_with_a_lower_version() {
        let mut state = State::default();
        assert!(!change_text(&mut state, 1, &[(None, "too early")]));
        open_text(&mut state, 5, "first");
        open_text(&mut state, 6, "second");
        assert_eq!(text(&state), "second");
        assert!(state.close(&uri()));
        assert!(!state.close(&uri()));
        assert!(!change_text(&mut state, 7, &[(None, "too late")]));
        open_text(&mut state, 0, "third");
        assert!(change_text(&mut state, 1, &[(Some([0, 0, 0, 1]), "T")]));
        assert_eq!(text(&state), "Third");
    }
}
