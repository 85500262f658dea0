//! `pydslrep/plannedPath`, a request of our own, and `pydslrep/plannedPathChanged`, the notification that goes with it.
//! Both are described in `docs/protocol.md`.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide as ide;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;

use crate::chosen::{ChosenEnvironment, Sent, Watched};
use crate::handlers::scripts::{environment, failure};
use crate::message::Outbox;
use crate::page::Audience;
use crate::state::State;

/// Longer paths are not planned again to see whether a change has changed them: planning takes longer than asking the
/// client to request them again.
const MOST_LEGS: usize = 1_000;

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

/// The planned path of an environment. From now on its audience is notified when it changes.
pub(crate) fn planned_path(
    state: &mut State,
    which: &ChosenEnvironment,
    audience: Audience,
) -> Result<ide::PlannedPath> {
    let path = plan(state, which);
    state.watched.retain(|watched| !watched.is(which, audience));
    let fingerprint = fingerprint(state, which);
    let sent = match &path {
        Ok(path) if path.robots.iter().any(|robot| robot.legs.len() > MOST_LEGS) => Sent::Long,
        Ok(path) => Sent::Path(path.clone()),
        Err(_) => Sent::Nothing,
    };
    state.watched.push(Watched { audience, which: which.clone(), fingerprint, sent });
    path
}

/// Notes who wants to know when a path changes, even if that is before it is planned.
pub(crate) fn watch(state: &mut State, which: &ChosenEnvironment, audience: Audience) {
    if state.watched.iter().all(|watched| !watched.is(which, audience)) {
        let which = which.clone();
        state.watched.push(Watched { audience, which, fingerprint: None, sent: Sent::Long });
    }
}

fn plan(state: &State, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    ide::planned_path(state.database(), environment(state, which)?).map_err(failure)
}

fn fingerprint(state: &State, which: &ChosenEnvironment) -> Option<Fingerprint> {
    state.database().fingerprint(environment(state, which).ok()?)
}

/// Whether its audience has the path as it is now.
fn is_sent(state: &State, watched: &Watched) -> bool {
    match &watched.sent {
        Sent::Path(path) => plan(state, &watched.which).as_ref() == Ok(path),
        Sent::Nothing => plan(state, &watched.which).is_err(),
        Sent::Long => false,
    }
}

/// Notifies the client and pages which of their paths are outdated, each once; they request them again if they still
/// need them.
pub(crate) fn announce(state: &mut State, outbox: &Outbox) {
    let watched = std::mem::take(&mut state.watched);
    for mut watched in watched {
        let fingerprint = fingerprint(state, &watched.which);
        // Most edits do not affect the path: then nothing is planned again.
        let is_the_same = fingerprint.is_some() && fingerprint == watched.fingerprint;
        if is_the_same || is_sent(state, &watched) {
            watched.fingerprint = fingerprint;
            state.watched.push(watched);
        } else {
            match watched.audience {
                Audience::Client => outbox.send_notification::<PlannedPathChanged>(&watched.which),
                #[cfg(feature = "process")]
                Audience::Page => state.pages.notify::<PlannedPathChanged>(&watched.which),
            }
        }
    }
}
