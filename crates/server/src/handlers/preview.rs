//! The live preview: a page in a browser, for editors that cannot draw, with the planned path of the program in the
//! editor. `docs/protocol.md` describes its messages, which are those of the protocol and a few more.

use std::sync::Arc;

use futures::FutureExt;
use hyper::body::Bytes;
use pydslrep_ide as ide;
use pydslrep_workspace::DocumentKind;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tower_lsp::jsonrpc::{Error, Id, Result};
use tower_lsp::ls_types::request::{Request, ShowDocument};
use tower_lsp::ls_types::{
    LSPAny, Location, MessageType, Position, ShowDocumentParams, TextDocumentIdentifier,
    TextDocumentPositionParams, Uri,
};

use crate::chosen::ChosenEnvironment;
use crate::dispatch::{Table, read, run};
use crate::documents::key;
use crate::handlers::code_actions;
use crate::handlers::driven_path::DrivenPath;
use crate::handlers::planned_action::{self, ActionLocation, PlannedAt};
use crate::handlers::planned_path::{self, PlannedPath};
use crate::handlers::scripts::failure;
use crate::log::log;
use crate::message::{Body, Incoming, encode, encode_error, parse};
use crate::page::{Audience, Cursor, CursorMoved, notification};
use crate::server::Server;
use crate::state::State;
use crate::view::View;
use crate::web::{File, Site, WebServer};

/// Opens the live preview.
pub(crate) const OPEN_PREVIEW: &str = "pydslrep.openPreview";

/// The page, as `editors/preview/scripts/bundle.mjs` builds it.
const FILES: &[File] = &[
    File { name: "", media_type: "text/html; charset=utf-8", content: include_bytes!("preview/page.html") },
    File {
        name: "page.js",
        media_type: "text/javascript; charset=utf-8",
        content: include_bytes!("preview/page.js"),
    },
    File {
        name: "page.css",
        media_type: "text/css; charset=utf-8",
        content: include_bytes!("preview/page.css"),
    },
];

/// The path to show.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Shown {
    /// The program; else that of the latest cursor, or the one that was opened last.
    uri: Option<Uri>,
    /// The environment in it; else the one that the cursor is about.
    environment: Option<String>,
}

/// The request of a page to show an action in the editor.
enum Reveal {}

impl Request for Reveal {
    type Params = Location;
    type Result = bool;
    const METHOD: &'static str = "pydslrep/reveal";
}

/// The request of a page to apply a fix of a problem.
enum ApplyFix {}

impl Request for ApplyFix {
    type Params = FixOf;
    type Result = bool;
    const METHOD: &'static str = "pydslrep/applyFix";
}

/// A fix that was offered to a page.
#[derive(Debug, Serialize, Deserialize)]
struct FixOf {
    location: Location,
    /// The title of its code action.
    fix: String,
}

/// The command [`OPEN_PREVIEW`]: opens the page in a browser, or says where it is.
pub(crate) async fn open(server: Server, shown: Shown) -> Result<Option<LSPAny>> {
    let address = start(&server, shown, 0)?;
    let can_show = server.state().view.client.show_document;
    let is_shown = match address.parse() {
        Ok(uri) if can_show => {
            let params = ShowDocumentParams { uri, external: Some(true), take_focus: None, selection: None };
            server.client.show_document(params).await.unwrap_or_default()
        }
        _ => false,
    };
    if !is_shown {
        server.outbox.tell(MessageType::INFO, format!("Path preview: {address}"));
    }
    Ok(Some(json!({ "address": address })))
}

/// Starts the web server on a port, unless it runs already, and has its pages show a program; returns their address.
///
/// # Errors
///
/// If there is no program, or the server cannot be started.
pub(crate) fn start(server: &Server, shown: Shown, port: u16) -> Result<String> {
    let cursor = cursor(&server.state(), shown)?;
    let mut web = server.web();
    let web = match &mut *web {
        Some(web) => web,
        none => {
            let started = WebServer::start(port, site(server.clone()))
                .map_err(|error| failure(format!("cannot start the preview: {error}")))?;
            let events = started.events.clone();
            server.state().pages.connect(Box::new(move |event| events.send(event)));
            none.insert(started)
        }
    };
    server.state().pages.cursor_is(cursor);
    Ok(web.address.clone())
}

/// The cursor to begin with.
fn cursor(state: &State, shown: Shown) -> Result<Cursor> {
    let latest = state.pages.cursor();
    let uri = shown.uri.or_else(|| latest.map(|cursor| cursor.at.text_document.uri.clone()));
    let uri = uri.or_else(|| last_opened(state));
    let uri = uri.ok_or_else(|| failure("open a program (a .pyr file) first".to_owned()))?;
    let known = latest.filter(|cursor| key(&cursor.at.text_document.uri) == key(&uri));
    let position = known.map_or(Position::default(), |cursor| cursor.at.position);
    let at = TextDocumentPositionParams { text_document: TextDocumentIdentifier { uri }, position };
    Ok(Cursor { at, environment: shown.environment, is_edit: false })
}

/// The program that the client has opened last.
fn last_opened(state: &State) -> Option<Uri> {
    let open = state.view.open.keys().filter_map(|key| state.view.document_at(key));
    let programs = open.filter(|document| document.kind == DocumentKind::Program);
    programs.max_by_key(|document| document.opening())?.uri()
}

fn site(server: Server) -> Site {
    let (greeter, requests) = (server.clone(), Arc::new(requests()));
    Site {
        files: FILES,
        greet: Box::new(move || notification::<CursorMoved>(&greeter.state().pages.cursor().cloned())),
        answer: Box::new(move |message| answer(server.clone(), Arc::clone(&requests), message).boxed()),
    }
}

/// The requests of pages.
fn requests() -> Table {
    let mut table = Table::default();
    table.add(
        read::<PlannedPath, _>(planned_path)
            .noting(|state, which| state.view.watched.watch(which, Audience::Page))
            .beside_if(|view, which| view.is_long(&which.uri)),
    );
    table.add(read::<DrivenPath, _>(|view, which| view.driven.watch(which, Audience::Page)));
    table.add(
        read::<PlannedAt, _>(planned_action::planned_at)
            .beside_if(|view, at| view.is_long(&at.text_document.uri)),
    );
    table.add(read::<ActionLocation, _>(planned_action::action_location));
    table.add(run::<Reveal, _>(reveal));
    table.add(run::<ApplyFix, _>(apply_fix));
    table
}

/// Answers a message of a page.
async fn answer(server: Server, requests: Arc<Table>, message: Bytes) -> Body {
    match parse(&message) {
        Ok(Incoming::Request(request)) => {
            let answer = requests.answer_page(&server, request).await;
            answer.unwrap_or_else(|| encode_error(Id::Null, Error::invalid_request()))
        }
        Ok(Incoming::Response(response)) => encode_error(response.id().clone(), Error::invalid_request()),
        Err(refusal) => encode(&refusal),
    }
}

/// A planned path for a page; fixes that the page cannot apply are not offered.
fn planned_path(view: &View, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    planned_path::planned_path(view, which, Audience::Page).map_err(|mut error| {
        if !view.client.applies_edits
            && let Some(Value::Object(data)) = &mut error.data
        {
            data.remove("fix");
        }
        error
    })
}

/// Has the editor select a location in a program; false if it cannot.
async fn reveal(server: Server, Location { uri, range }: Location) -> Result<bool> {
    let can_show = |view: &View| view.client.show_document && view.document(&uri).is_some();
    if !can_show(&server.state().view) {
        return Ok(false);
    }
    let client = server.client;
    let params = ShowDocumentParams { uri, external: None, take_focus: Some(true), selection: Some(range) };
    // The page need not wait for the user.
    tokio::spawn(async move {
        if let Err(error) = client.send_request::<ShowDocument>(params).await {
            log(format_args!("the client did not show an action: {error}"));
        }
    });
    Ok(true)
}

/// Has the editor apply a fix; false if it cannot, or there is no such fix any more.
async fn apply_fix(server: Server, of: FixOf) -> Result<bool> {
    let edit = {
        let view = &server.state().view;
        view.client.applies_edits.then(|| code_actions::quick_fix(view, &of.location, &of.fix)).flatten()
    };
    let Some(edit) = edit else { return Ok(false) };
    let client = server.client;
    tokio::spawn(async move {
        if let Err(error) = client.apply_edit(edit).await {
            log(format_args!("the client did not apply a fix: {error}"));
        }
    });
    Ok(true)
}
