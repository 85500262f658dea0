//! Notifications of the pages of the path preview: the location of the cursor, and paths that have changed.

use std::fmt;

use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Request;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{Position, TextDocumentIdentifier, TextDocumentPositionParams, Uri};

use crate::message::{Body, encode};

/// The receiver of a path, which is notified when it changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Audience {
    /// The client.
    Client,
    /// Pages of the path preview.
    #[cfg(feature = "process")]
    Page,
}

/// A cursor in a program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Cursor {
    #[serde(flatten)]
    pub(crate) at: TextDocumentPositionParams,
    /// The environment to show; else the one that the cursor is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) environment: Option<String>,
    /// True at the location of an edit.
    pub(crate) is_edit: bool,
}

/// The notification of a cursor.
pub(crate) enum CursorMoved {}

impl Notification for CursorMoved {
    type Params = Option<Cursor>;
    const METHOD: &'static str = "pydslrep/cursorMoved";
}

/// Sends a message to all pages.
type Deliver = Box<dyn Fn(&[u8]) + Send>;

/// The pages of the path preview.
#[derive(Default)]
pub(crate) struct Pages {
    cursor: Option<Cursor>,
    deliver: Option<Deliver>,
}

impl fmt::Debug for Pages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pages").field("cursor", &self.cursor).finish_non_exhaustive()
    }
}

impl Pages {
    /// Sends messages to pages from now on.
    #[cfg(feature = "process")]
    pub(crate) fn connect(&mut self, deliver: Deliver) {
        self.deliver = Some(deliver);
    }

    /// The latest cursor in a program.
    #[cfg(feature = "process")]
    pub(crate) fn cursor(&self) -> Option<&Cursor> {
        self.cursor.as_ref()
    }

    /// The cursor is here.
    pub(crate) fn cursor_is_at(&mut self, uri: &Uri, position: Position) {
        self.cursor_is(Cursor { at: place(uri, position), environment: None, is_edit: false });
    }

    /// The cursor is in the scene of an environment that is declared here.
    pub(crate) fn chosen_at(&mut self, program: &Uri, environment: String, position: Position) {
        let (at, environment) = (place(program, position), Some(environment));
        let is_known = |before: &Cursor| before.at == at && before.environment == environment;
        if !self.cursor.as_ref().is_some_and(is_known) {
            self.cursor_is(Cursor { at, environment, is_edit: false });
        }
    }

    /// The text was edited, here if that is known.
    pub(crate) fn edited_at(&mut self, uri: &Uri, position: Option<Position>) {
        let before = self.cursor.as_ref().filter(|cursor| cursor.at.text_document.uri == *uri);
        let position = position.or_else(|| Some(before?.at.position)).unwrap_or_default();
        self.cursor_is(Cursor { at: place(uri, position), environment: None, is_edit: true });
    }

    /// The cursor is here; an edit there changes the program even where the cursor was before.
    pub(crate) fn cursor_is(&mut self, cursor: Cursor) {
        let before = self.cursor.as_ref();
        if !cursor.is_edit
            && cursor.environment.is_none()
            && before.is_some_and(|before| before.at == cursor.at)
        {
            return;
        }
        // A page that is still being opened begins with the environment that was chosen for it.
        let before = before.filter(|before| before.at.text_document == cursor.at.text_document);
        let chosen = cursor.environment.clone().or_else(|| before?.environment.clone());
        self.notify::<CursorMoved>(&Some(cursor.clone()));
        self.cursor = Some(Cursor { environment: chosen, ..cursor });
    }

    /// Sends a notification.
    pub(crate) fn notify<N: Notification>(&self, params: &N::Params) {
        if let Some(deliver) = &self.deliver {
            deliver(&notification::<N>(params));
        }
    }
}

/// An encoded notification.
pub(crate) fn notification<N: Notification>(params: &N::Params) -> Body {
    let params = serde_json::to_value(params).unwrap_or_default();
    encode(&Request::build(N::METHOD).params(params).finish())
}

fn place(uri: &Uri, position: Position) -> TextDocumentPositionParams {
    TextDocumentPositionParams { text_document: TextDocumentIdentifier { uri: uri.clone() }, position }
}
