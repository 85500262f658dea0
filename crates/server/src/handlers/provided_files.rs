//! `pydslrep/files`, a notification of our own: what is in files that are not open, for a server without a disk. It is
//! described in `docs/protocol.md`.

use serde::{Deserialize, Serialize};
use tower_lsp::ls_types::Uri;
use tower_lsp::ls_types::notification::Notification;

use crate::log::log;
use crate::server::Server;

/// The notification.
pub(crate) enum ProvidedFiles {}

impl Notification for ProvidedFiles {
    type Params = Files;
    const METHOD: &'static str = "pydslrep/files";
}

/// Files that were created, changed or deleted.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Files {
    files: Vec<ProvidedFile>,
}

#[derive(Debug, Serialize, Deserialize)]
struct ProvidedFile {
    uri: Uri,
    /// `None` for a file that is gone.
    text: Option<String>,
}

/// Takes in files.
pub(crate) async fn provide(server: Server, params: Files) {
    for file in &params.files {
        if !server.state().provide(&file.uri, file.text.as_deref()) {
            log(format_args!("files are read from the disk; `{}` is ignored", ProvidedFiles::METHOD));
            return;
        }
    }
    server.refresh().await;
}
