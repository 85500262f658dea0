//! The server's state between two messages.

use std::sync::Arc;

use futures::channel::oneshot;
use pydslrep_analysis::EditCounts;
use pydslrep_config::{Config, Problem};
use pydslrep_text::{Span, offset};
use pydslrep_workspace::{Changes, MAX_BYTES, ReadError, TextChange, Workspace, path_of};
use ropey::Rope;
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::Value;
use tower_lsp::ls_types::request::{CodeLensRefresh, InlayHintRefreshRequest};
use tower_lsp::ls_types::{
    Diagnostic, DidChangeTextDocumentParams, Position, Range, TextDocumentContentChangeEvent,
    TextDocumentItem, TextDocumentPositionParams, TraceValue, Uri,
};

use crate::documents::{ClientDocument, key, text_changes};
use crate::message::Outbox;
use crate::page::Pages;
use crate::positions::{Encoding, to_offset, to_position};
use crate::readers::{Loan, Readers};
use crate::runtimes::Runtimes;
use crate::typing::{Typing, replacements};
use crate::view::View;

/// What requests read, and what only the message loop needs.
#[derive(Debug, Default)]
pub(crate) struct State {
    /// What requests read.
    pub(crate) view: View,
    /// The requests that read it beside the message loop.
    readers: Arc<Readers>,
    /// The number of changes of the workspace.
    version: u64,
    /// Options of the server's command line, which override the client's settings.
    options: Config,
    /// The changes since diagnostics were last published, as far as they were already taken from the workspace.
    changes: Changes,
    /// Documents that were closed since diagnostics were last published.
    pub(crate) closed: Vec<Uri>,
    /// The diagnostics last published of each document, by its key, and its address as the client writes it.
    pub(crate) published: FxHashMap<String, (Uri, Vec<Diagnostic>)>,
    /// The number of times that documents have been opened.
    openings: u64,
    /// The number of progress reports; each needs its own token.
    pub(crate) progresses: u64,
    /// The trace level; if it is verbose, the client gets the cost of changes.
    pub(crate) trace: TraceValue,
    /// The cost of each change of the last message, if the trace is verbose.
    pub(crate) costs: Vec<EditCounts>,
    /// Requests that are answered when any diagnostics change.
    pub(crate) waiting: Vec<oneshot::Sender<()>>,
    /// Messages shown so far about scripts that are generated on save.
    pub(crate) reported: FxHashSet<String>,
    /// Writes the package that scripts import.
    pub(crate) runtimes: Runtimes,
    /// The hints and lenses that the client must request again although it did not change them.
    pub(crate) outdated: Outdated,
    /// The number of refreshes requested.
    refreshes: u64,
    /// The pages of the path preview.
    pub(crate) pages: Pages,
}

/// The outdated items that the client shows.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Outdated {
    /// Inlay hints.
    pub(crate) hints: bool,
    /// Code lenses.
    pub(crate) lenses: bool,
}

impl State {
    /// Without a disk.
    pub(crate) fn in_memory() -> Self {
        Self { view: View::in_memory(), ..Self::default() }
    }

    /// Opens a document, or gives one that is open a new text.
    pub(crate) fn open(&mut self, opened: &TextDocumentItem) {
        let key = key(&opened.uri);
        self.view.typing.take_if(|typing| typing.key == key);
        self.openings += 1;
        let document = ClientDocument::new(opened.uri.clone(), opened.version, self.openings);
        if let Some(mut before) = self.open_mut().insert(key.clone(), document) {
            before.set_outdated();
        }
        self.published.remove(&key);
        self.workspace_mut().open(&key, Rope::from_str(&opened.text));
    }

    /// Makes the changes of one message; false if the document is not open.
    pub(crate) fn change(&mut self, params: &DidChangeTextDocumentParams) -> bool {
        let key = key(&params.text_document.uri);
        let open = self.view.workspace.document(&key).filter(|document| document.is_open);
        let Some((is_program, before)) = open.map(|document| (document.is_program(), document.text.clone()))
        else {
            return false;
        };
        let Some(client) = self.open_mut().get_mut(&key) else { return false };
        client.version = params.text_document.version;
        client.set_outdated();
        let encoding = self.view.client.encoding;
        let changes = text_changes(&before, &params.content_changes, encoding);
        if is_program {
            self.note_typing(&key, &params.content_changes, &changes, &before);
            let position = end_of_edit(&params.content_changes, &changes, encoding);
            self.pages.edited_at(&params.text_document.uri, position);
        }
        let costs = self.workspace_mut().change(&key, changes);
        if self.trace == TraceValue::Verbose {
            self.costs.extend(costs);
        }
        true
    }

    fn note_typing(
        &mut self,
        key: &str,
        events: &[TextDocumentContentChangeEvent],
        changes: &[TextChange],
        before: &Rope,
    ) {
        let spans: Vec<Option<Span>> = changes.iter().map(|change| change.span).collect();
        let after = changes.last().map_or(before, |change| &change.after);
        let replaced = replacements(events, &spans, before, after);
        let are_alike = events.windows(2).all(|pair| pair[0].text == pair[1].text);
        let before_key = self.view.typing.as_ref().map(|typing| typing.key.clone());
        let is_elsewhere = before_key.as_ref().is_some_and(|before| before != key);
        self.view.typing = Typing::after(self.view.typing.take(), key, &replaced, are_alike);
        if is_elsewhere {
            self.outdated = Outdated { hints: true, lenses: true };
        }
        if let Some(left) = before_key.filter(|_| is_elsewhere) {
            self.changes.documents.insert(left);
        }
    }

    /// Returns the changes in the workspace since the last call.
    pub(crate) fn take_changes(&mut self) -> Changes {
        self.note_changes();
        std::mem::take(&mut self.changes)
    }

    /// Takes the changes of the workspace. That stops its readers, so it happens before they begin.
    fn note_changes(&mut self) {
        if self.view.workspace.has_changes() {
            let Changes { all, documents } = self.untracked_workspace_mut().take_changes();
            self.changes.all |= all;
            self.changes.documents.extend(documents);
        }
    }

    /// Prepares for [`Self::lend`] after this message; returns the version of the workspace.
    pub(crate) fn prepare_to_lend(&mut self) -> u64 {
        self.note_changes();
        self.version
    }

    /// Lends the current view to a request that continues beside the message loop; `None` if the workspace has changed
    /// since it had this version.
    pub(crate) fn lend(&self, version: u64) -> Option<Loan> {
        (self.version == version).then(|| self.readers.lend(self.view.clone()))
    }

    /// The workspace, to be changed: its readers are cancelled.
    pub(crate) fn workspace_mut(&mut self) -> &mut Workspace {
        self.version += 1;
        self.untracked_workspace_mut()
    }

    /// The workspace for changes that affect no answer, such as the record of what was asked so far.
    fn untracked_workspace_mut(&mut self) -> &mut Workspace {
        if Arc::get_mut(&mut self.view.workspace).is_none() {
            self.readers.stop();
        }
        Arc::make_mut(&mut self.view.workspace)
    }

    fn open_mut(&mut self) -> &mut FxHashMap<String, ClientDocument> {
        Arc::make_mut(&mut self.view.open)
    }

    /// Tells pages where the cursor is, or the pointer.
    pub(crate) fn note_cursor(&mut self, at: &TextDocumentPositionParams) {
        let uri = &at.text_document.uri;
        if self.view.is_program(uri) {
            self.pages.cursor_is_at(uri, at.position);
        } else if let Some((which, position)) = self.view.driven_in(uri) {
            self.pages.chosen_at(&which.uri, which.environment, position);
        }
    }

    /// Notes that the cursor is at a place.
    pub(crate) fn cursor_is(&mut self, at: &TextDocumentPositionParams) {
        self.note_cursor(at);
        self.cursor_is_at(&at.text_document.uri, Range::new(at.position, at.position));
    }

    /// Notes the cursor of a request: a user who has moved to another line has finished the one before.
    pub(crate) fn cursor_is_at(&mut self, uri: &Uri, range: Range) {
        let key = key(uri);
        let (Some(typing), Some(document)) = (&self.view.typing, self.view.workspace.document(&key)) else {
            return;
        };
        if typing.is_left(&key, range, &document.text) {
            self.changes.documents.insert(typing.key.clone());
            self.view.typing = None;
            self.outdated = Outdated { hints: true, lenses: true };
        }
    }

    /// Notes that completion is requested at a position.
    pub(crate) fn note_completion(&mut self, at: &TextDocumentPositionParams) {
        let key = key(&at.text_document.uri);
        let Some(document) = self.view.workspace.document(&key) else { return };
        let offset = to_offset(&document.text, at.position, self.view.client.encoding);
        if let Some(typing) = &mut self.view.typing {
            typing.note_completion(&key, offset);
        }
    }

    /// Asks the client to request outdated hints and lenses again.
    pub(crate) fn tell_outdated(&mut self, outbox: &Outbox) {
        let Outdated { hints, lenses } = std::mem::take(&mut self.outdated);
        if hints && self.view.client.refreshes_inlay_hints {
            self.refreshes += 1;
            outbox.send_server_request::<InlayHintRefreshRequest>(self.refreshes);
        }
        if lenses && self.view.client.refreshes_code_lenses {
            self.refreshes += 1;
            outbox.send_server_request::<CodeLensRefresh>(self.refreshes);
        }
    }

    /// Notes that a document was saved.
    pub(crate) fn saved(&mut self, uri: &Uri) {
        let key = key(uri);
        if self.view.typing.as_mut().is_some_and(|typing| typing.save(&key)) {
            self.outdated.lenses = true;
            self.changes.documents.insert(key);
        }
    }

    /// Closes a document; false if it is not open. From now on its file counts, if there is one.
    pub(crate) fn close(&mut self, uri: &Uri) -> bool {
        let key = key(uri);
        if !self.workspace_mut().close(&key) {
            return false;
        }
        if let Some(mut document) = self.open_mut().remove(&key) {
            document.set_outdated();
        }
        self.published.remove(&key);
        self.closed.push(uri.clone());
        true
    }

    /// A file was created, changed or deleted, by whomever.
    pub(crate) fn file_changed(&mut self, uri: &Uri) {
        self.workspace_mut().file_changed(&key(uri));
    }

    /// The client provides a file, or takes one away; false where files come from a disk.
    pub(crate) fn provide(&mut self, uri: &Uri, text: Option<&str>) -> bool {
        let Some(files) = &self.view.provided else { return false };
        let key = key(uri);
        match text {
            Some(text) if text.len() as u64 > MAX_BYTES => {
                files.write_unreadable(&*path_of(&key), ReadError::TooLarge);
            }
            Some(text) => files.write(&*path_of(&key), text),
            None => files.remove(path_of(&key)),
        }
        self.workspace_mut().file_changed(&key);
        true
    }

    /// Applies the client's settings; returns their problems.
    pub(crate) fn set_client_settings(&mut self, value: &Value) -> Vec<Problem> {
        let (config, problems) = Config::from_json(value);
        let overrides = self.options.clone().merged_over(config);
        self.workspace_mut().set_overrides(overrides);
        problems
    }

    /// Sets the options that override the client's settings, before there are any.
    #[cfg(feature = "process")]
    pub(crate) fn set_options(&mut self, options: Config) {
        self.workspace_mut().set_overrides(options.clone());
        self.options = options;
    }
}

/// Where the last change of a message ends; `None` if it replaces the whole text.
fn end_of_edit(
    events: &[TextDocumentContentChangeEvent],
    changes: &[TextChange],
    encoding: Encoding,
) -> Option<Position> {
    let (event, change) = (events.last()?, changes.last()?);
    Some(to_position(&change.after, change.span?.start + offset(event.text.len()), encoding))
}

#[cfg(test)]
mod tests {
    use std::thread;

    use pydslrep_analysis::{CancellationToken, check_cancelled};

    use super::*;

    #[test]
    fn a_change_stops_readers_and_does_not_wait_for_those_that_go_on() {
        let mut state = State::default();
        let before = state.prepare_to_lend();
        let loan = state.lend(before).unwrap();
        let reader = thread::spawn(move || {
            loan.read(CancellationToken::default(), |_| {
                loop {
                    check_cancelled();
                    thread::yield_now();
                }
            })
        });
        state.workspace_mut().open("/a.pyr", Rope::from_str("wheel a"));
        assert_eq!(reader.join().unwrap(), None::<()>);
        assert!(state.lend(before).is_none());
        let stubborn = state.lend(state.version).unwrap();
        state.workspace_mut().open("/b.pyr", Rope::from_str("wheel b"));
        let sees_b = stubborn.read(CancellationToken::default(), |view| view.document_at("/b.pyr").is_some());
        assert!(!sees_b.unwrap_or_default() && state.view.document_at("/b.pyr").is_some());
    }
}
