//! `pydslrep/plannedPath`, a request of our own, and `pydslrep/plannedPathChanged`, the notification that goes with it.
//! Both are described in `docs/protocol.md`.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide as ide;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;

use crate::chosen::{ChosenEnvironment, Watched};
use crate::handlers::scripts::{environment, failure};
use crate::message::Outbox;
use crate::state::State;

/// The request.
pub(crate) enum PlannedPath {}

impl Request for PlannedPath {
    type Params = ChosenEnvironment;
    type Result = ide::PlannedPath;
    const METHOD: &'static str = "pydslrep/plannedPath";
}

/// The notification.
enum PlannedPathChanged {}

impl Notification for PlannedPathChanged {
    type Params = ChosenEnvironment;
    const METHOD: &'static str = "pydslrep/plannedPathChanged";
}

/// The planned path of an environment. From now on the client is notified when it changes.
pub(crate) fn planned_path(state: &mut State, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    let path = plan(state, which);
    state.watched.retain(|watched| watched.which != *which);
    let fingerprint = fingerprint(state, which);
    state.watched.push(Watched { which: which.clone(), fingerprint, path: path.as_ref().ok().cloned() });
    path
}

fn plan(state: &State, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    ide::planned_path(state.database(), environment(state, which)?).map_err(failure)
}

fn fingerprint(state: &State, which: &ChosenEnvironment) -> Option<Fingerprint> {
    state.database().fingerprint(environment(state, which).ok()?)
}

/// Notifies the client which of its paths are outdated, each once; it requests them again if it still needs them.
pub(crate) fn announce(state: &mut State, outbox: &Outbox) {
    let watched = std::mem::take(&mut state.watched);
    for mut watched in watched {
        let fingerprint = fingerprint(state, &watched.which);
        // Most edits do not affect the path: then nothing is planned again.
        let is_the_same = fingerprint.is_some() && fingerprint == watched.fingerprint;
        if is_the_same || plan(state, &watched.which).ok() == watched.path {
            watched.fingerprint = fingerprint;
            state.watched.push(watched);
        } else {
            outbox.send_notification::<PlannedPathChanged>(&watched.which);
        }
    }
}
