//! The whole surface of the server, one entry per message of the protocol.

use std::fmt;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::*;
use tower_lsp::{Client, LanguageServer};

use crate::capabilities::{self, ClientFeatures};
use crate::handlers::synchronization;
use crate::message::Outbox;
use crate::state::State;

/// The server's end of one session; clones share it.
///
/// Every method changes or reads the state before it awaits anything. That, and the order in which the loop calls
/// them, is why an answer is always about the latest text the client sent before its question.
#[derive(Debug, Clone)]
pub struct Server {
    state: Arc<Mutex<State>>,
    client: Client,
    outbox: Outbox,
}

impl Server {
    /// A session that talks to `client`; notifications of ours go to `outbox`, in order with the answers.
    pub fn new(client: Client, outbox: Outbox) -> Self {
        Self { state: Arc::default(), client, outbox }
    }

    /// The state, for as long as one handler runs. Never keep it across an `.await`.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        // A handler that panicked has left it locked in name only; `recover` has mended what it may have broken.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl LanguageServer for Server {
    //// Life cycle ////

    async fn initialize(&self, params: InitializeParams) -> Result<InitializeResult> {
        let features = ClientFeatures::new(&params.capabilities);
        let result = capabilities::initialize_result(&features);
        self.state().client = features;
        #[cfg(all(target_os = "linux", feature = "process"))]
        if let Some(client) = params.process_id {
            crate::parent::leave_with(client);
        }
        Ok(result)
    }

    async fn shutdown(&self) -> Result<()> {
        Ok(())
    }

    //// Documents ////

    async fn did_open(&self, params: DidOpenTextDocumentParams) {
        synchronization::open(&mut self.state(), params);
    }

    async fn did_change(&self, params: DidChangeTextDocumentParams) {
        if !synchronization::change(&mut self.state(), &params) {
            log(format_args!("change to a document that is not open: {}", params.text_document.uri.as_str()));
        }
    }

    async fn did_close(&self, params: DidCloseTextDocumentParams) {
        if !synchronization::close(&mut self.state(), &params) {
            log(format_args!("close of a document that is not open: {}", params.text_document.uri.as_str()));
        }
    }
}

/// What happens between messages; the loop calls these.
impl Server {
    /// All messages that had arrived are handled: time to tell the client what they changed.
    pub(crate) fn settle(&self) {}

    /// A handler panicked and may have left the analysis half changed: it is made anew from the documents.
    pub(crate) fn recover(&self) {}
}

/// Writes a line to standard error, the only place where a language server may say something of its own.
pub(crate) fn log(message: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr(), "pydslrep-lsp: {message}");
}
