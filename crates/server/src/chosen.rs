//! Which environment of which program a client means, and which paths it has.

use std::sync::Arc;

use pydslrep_analysis::Fingerprint;
use pydslrep_ide::PlannedPath;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Error;
use tower_lsp::ls_types::Uri;

use crate::page::Audience;
use crate::shared::Shared;

/// An environment: the data of an action until it is chosen, and the argument of commands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ChosenEnvironment {
    /// The program.
    pub(crate) uri: Uri,
    /// The environment in it.
    pub(crate) environment: String,
}

/// The planned paths that the client and pages have, and are notified of; clones share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct WatchedPaths(Arc<Shared<Vec<Watched>>>);

impl WatchedPaths {
    /// Notes who wants to know when a path changes, even if that is before it is planned.
    pub(crate) fn watch(&self, which: &ChosenEnvironment, audience: Audience) {
        let mut all = self.0.lock();
        if all.iter().all(|watched| !watched.is(which, audience)) {
            let which = which.clone();
            all.push(Watched { audience, which, fingerprint: None, sent: Sent::Long });
        }
    }

    /// Notes that an audience has a path now.
    pub(crate) fn set(&self, watched: Watched) {
        let mut all = self.0.lock();
        all.retain(|other| !other.is(&watched.which, watched.audience));
        all.push(watched);
    }

    /// Returns all paths, and forgets them.
    pub(crate) fn take(&self) -> Vec<Watched> {
        std::mem::take(&mut *self.0.lock())
    }

    /// Notes that any path may have changed.
    pub(crate) fn forget_fingerprints(&self) {
        self.0.lock().iter_mut().for_each(|watched| watched.fingerprint = None);
    }
}

/// A planned path that the client or a page has.
#[derive(Debug)]
pub(crate) struct Watched {
    /// The audience that has it.
    pub(crate) audience: Audience,
    /// Whose path.
    pub(crate) which: ChosenEnvironment,
    /// The fingerprint of the environment; `None` if it had errors.
    pub(crate) fingerprint: Option<Fingerprint>,
    /// The version that was sent.
    pub(crate) sent: Sent,
}

impl Watched {
    /// Returns whether it is the path of this environment for this audience.
    fn is(&self, which: &ChosenEnvironment, audience: Audience) -> bool {
        self.audience == audience && self.which == *which
    }
}

/// The version of a path that its audience has.
#[derive(Debug)]
pub(crate) enum Sent {
    /// This one.
    Path(PlannedPath),
    /// There was none, for this reason.
    Failure(Error),
    /// One that is too long to be compared, or that is still being planned.
    Long,
}
