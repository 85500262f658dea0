//! The path preview of a saved file, without an editor: a session whose client is the file.

use std::fmt;
use std::io;
use std::path::Path;
use std::sync::mpsc;

use serde_json::{Value, json};
use tokio::runtime::{Builder, Runtime};
use tower_lsp::ls_types::{FileChangeType, Uri};

use crate::handlers::preview::{self, Shown};
use crate::message::Outbox;
use crate::session::Session;

/// A page in a browser with the planned path of a file, until it is dropped.
pub struct FilePreview {
    session: Session,
    uri: Uri,
    text: String,
    version: i32,
    address: String,
    /// Runs tasks that outlast a message.
    _runtime: Runtime,
}

impl fmt::Debug for FilePreview {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FilePreview").field("uri", &self.uri).finish_non_exhaustive()
    }
}

impl FilePreview {
    /// Serves the page of a program, by its absolute path and its text, on a port of this machine; 0 is any free one.
    ///
    /// # Errors
    ///
    /// If the port is not free, or no thread can be started.
    pub fn start(program: &Path, text: String, port: u16) -> io::Result<Self> {
        let uri = Uri::from_file_path(program).ok_or_else(|| io::Error::other("its path is not absolute"))?;
        let runtime = Builder::new_multi_thread().worker_threads(1).build()?;
        // Nothing reads the session's messages to an editor.
        let (sender, _) = mpsc::channel();
        let handle = runtime.handle().clone();
        let mut session = Session::new(Outbox::new(sender), move |unfinished| drop(handle.spawn(unfinished)));
        send(&mut session, Some(1), "initialize", &json!({ "capabilities": {} }));
        send(&mut session, None, "initialized", &json!({}));
        let document = json!({ "uri": uri, "languageId": "pydslrep", "version": 1, "text": text });
        send(&mut session, None, "textDocument/didOpen", &json!({ "textDocument": document }));
        let address = preview::start(session.server(), Shown::default(), port)
            .map_err(|error| io::Error::other(error.message))?;
        Ok(Self { session, uri, text, version: 1, address, _runtime: runtime })
    }

    /// The page's address, a secret: any client that knows it sees the path.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// The program has this text now, and any of the other files may have changed.
    pub fn changed<'a>(&mut self, text: String, others: impl IntoIterator<Item = &'a Path>) {
        let uris = others.into_iter().filter_map(Uri::from_file_path);
        let changes: Vec<Value> =
            uris.map(|uri| json!({ "uri": uri, "type": FileChangeType::CHANGED })).collect();
        self.send("workspace/didChangeWatchedFiles", &json!({ "changes": changes }));
        if text != self.text {
            self.version += 1;
            let document = json!({ "uri": self.uri, "version": self.version });
            let changes = json!([{ "text": text }]);
            self.send(
                "textDocument/didChange",
                &json!({ "textDocument": document, "contentChanges": changes }),
            );
            self.text = text;
        }
        self.session.flush_diagnostics();
    }

    fn send(&mut self, method: &str, params: &Value) {
        send(&mut self.session, None, method, params);
    }
}

impl Drop for FilePreview {
    fn drop(&mut self) {
        self.session.leave();
    }
}

fn send(session: &mut Session, id: Option<i32>, method: &str, params: &Value) {
    let mut message = json!({ "jsonrpc": "2.0", "method": method, "params": params });
    if let Some(id) = id {
        message["id"] = id.into();
    }
    session.handle(message.to_string().as_bytes());
}
