//! What the client can do, and what we tell it that we can.

use tower_lsp::ls_types::{
    ClientCapabilities, InitializeResult, ServerCapabilities, ServerInfo, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions,
};

use crate::positions::Encoding;

/// The client's abilities that change our answers, each off unless the client says otherwise.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent yes or no of the protocol")]
pub(crate) struct ClientFeatures {
    /// The unit of its columns.
    pub(crate) encoding: Encoding,
    /// It asks for diagnostics; then they are not pushed.
    pub(crate) pull_diagnostics: bool,
}

impl ClientFeatures {
    /// Reads them from what `initialize` brings.
    pub(crate) fn new(client: &ClientCapabilities) -> Self {
        let offered = client.general.as_ref().and_then(|general| general.position_encodings.as_deref());
        let document = client.text_document.as_ref();
        Self {
            encoding: Encoding::negotiate(offered),
            pull_diagnostics: document.is_some_and(|document| document.diagnostic.is_some()),
        }
    }
}

/// The answer to `initialize`.
pub(crate) fn initialize_result(client: &ClientFeatures) -> InitializeResult {
    InitializeResult {
        capabilities: server_capabilities(client),
        server_info: Some(ServerInfo {
            name: "pydslrep-lsp".to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        }),
        ..InitializeResult::default()
    }
}

fn server_capabilities(client: &ClientFeatures) -> ServerCapabilities {
    ServerCapabilities {
        position_encoding: Some(client.encoding.kind()),
        text_document_sync: Some(TextDocumentSyncCapability::Options(TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::INCREMENTAL),
            ..TextDocumentSyncOptions::default()
        })),
        ..ServerCapabilities::default()
    }
}
