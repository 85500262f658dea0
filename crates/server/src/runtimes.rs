//! The package that scripts import, written next to them.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::thread;

use futures::channel::oneshot;
use pydslrep_output::{RuntimeFolder, has_runtime, write_runtime};
use rustc_hash::FxHashSet;
use tower_lsp::ls_types::MessageType;

use crate::log::log;
use crate::message::Outbox;
use crate::shared::Shared;

/// Writes packages, and remembers what the user knows already; clones share it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Runtimes {
    /// True if the user's Python has the package; empty until it was asked.
    is_installed: Arc<OnceLock<bool>>,
    reported: Arc<Shared<FxHashSet<String>>>,
}

impl Runtimes {
    /// Writes the package into a folder, unless it is there or installed. The receiver resolves when it is done.
    /// Runs on a thread of its own: the user's Python may take its time to answer.
    pub(crate) fn write(&self, folder: PathBuf, outbox: &Outbox) -> oneshot::Receiver<()> {
        let (done, receiver) = oneshot::channel();
        let (own, outbox) = (self.clone(), outbox.clone());
        let work = move || {
            own.write_now(&folder, &outbox);
            // Nobody has to wait for it.
            let _ = done.send(());
        };
        if let Err(error) = thread::Builder::new().name("runtime".to_owned()).spawn(work) {
            log(format_args!("the runtime of scripts is not written: {error}"));
        }
        receiver
    }

    fn write_now(&self, folder: &std::path::Path, outbox: &Outbox) {
        let (typ, message) = match write_runtime(folder, || *self.is_installed.get_or_init(has_runtime)) {
            Ok(RuntimeFolder::Current(_) | RuntimeFolder::Installed) => return,
            Ok(RuntimeFolder::Kept(kept)) => (MessageType::WARNING, format!("{kept}; {}", kept.help())),
            Ok(written) => (MessageType::INFO, format!("Runtime of scripts: {written}")),
            Err(error) => (MessageType::WARNING, error.to_string()),
        };
        if self.reported.lock().insert(message.clone()) {
            outbox.tell(typ, message);
        }
    }
}
