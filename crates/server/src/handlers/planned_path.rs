//! `pydslrep/plannedPath`, a request of our own, and `pydslrep/plannedPathChanged`, the notification that goes with it.
//! Both are described in `docs/protocol.md`.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide as ide;
use serde_json::Value;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::Location;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;

use crate::chosen::{ChosenEnvironment, Sent, Watched};
use crate::documents::Document;
use crate::handlers::code_actions;
use crate::handlers::scripts::{Cause, blocked, environment, failure, with_cause};
use crate::message::Outbox;
use crate::page::Audience;
use crate::state::State;

/// Longer paths are not planned again to see whether a change has changed them: planning takes longer than asking the
/// client to request them again.
const MAX_LEGS: usize = 1_000;

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
        Ok(path) if path.robots.iter().any(|robot| robot.legs.len() > MAX_LEGS) => Sent::Long,
        Ok(path) => Sent::Path(path.clone()),
        Err(error) => Sent::Failure(error.clone()),
    };
    state.watched.push(Watched { audience, which: which.clone(), fingerprint, sent });
    path.map_err(|error| with_fix(state, which, error))
}

/// Notes who wants to know when a path changes, even if that is before it is planned.
pub(crate) fn watch(state: &mut State, which: &ChosenEnvironment, audience: Audience) {
    if state.watched.iter().all(|watched| !watched.is(which, audience)) {
        let which = which.clone();
        state.watched.push(Watched { audience, which, fingerprint: None, sent: Sent::Long });
    }
}

fn plan(state: &State, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    let path = ide::planned_path(state.database(), environment(state, which)?);
    path.map_err(|why| no_path(state, which, &why))
}

/// Why there is no path, with the place of the first error.
fn no_path(state: &State, which: &ChosenEnvironment, why: &ide::NoPath) -> Error {
    match why {
        ide::NoPath::Blocked(errors) => blocked(state, errors),
        ide::NoPath::Scene { problems, .. } => {
            let scene = scene(state, which);
            let span = problems.first().and_then(|problem| problem.span);
            let location = scene
                .zip(span)
                .and_then(|(scene, span)| Some(Location::new(scene.uri()?, state.range(scene, span))));
            with_cause(why.to_string(), &Cause::Errors { location })
        }
        ide::NoPath::Robot(_) => failure(why.to_string()),
    }
}

/// Adds the title of the first fix to the data of an error of [`no_path`]: the code action of this title at its location.
fn with_fix(state: &State, which: &ChosenEnvironment, mut error: Error) -> Error {
    if let Some(Value::Object(data)) = &mut error.data
        && let Some(title) = first_fix(state, which)
    {
        data.insert("fix".to_owned(), title.into());
    }
    error
}

fn first_fix(state: &State, which: &ChosenEnvironment) -> Option<String> {
    let (database, id) = (state.database(), environment(state, which).ok()?);
    let title = if let Err(blocked) = database.environment(id) {
        let first = blocked.errors.first()?;
        let fixes = ide::quick_fixes(database, first.file, first.span).into_iter();
        fixes.map(|found| found.fix.title).next()?
    } else {
        let uri = scene(state, which)?.uri()?;
        let (document, file, text) = state.toml_text(&uri)?;
        let problem = state.workspace.problems(document.key).into_iter().next()?;
        ide::toml_fixes(file, &text, problem.span?).into_iter().next()?.title
    };
    Some(code_actions::sentence(&title))
}

/// The scene of an environment.
fn scene<'a>(state: &'a State, which: &ChosenEnvironment) -> Option<Document<'a>> {
    let (_, file) = state.analysed(&which.uri)?;
    state.scene_document(file, &which.environment)
}

fn fingerprint(state: &State, which: &ChosenEnvironment) -> Option<Fingerprint> {
    state.database().fingerprint(environment(state, which).ok()?)
}

/// Returns whether the audience has the current path.
fn is_sent(state: &State, watched: &Watched) -> bool {
    match &watched.sent {
        Sent::Path(path) => plan(state, &watched.which).as_ref() == Ok(path),
        Sent::Failure(error) => plan(state, &watched.which).as_ref() == Err(error),
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
        } else if state.is_error_unsettled() && plan(state, &watched.which).is_err() {
            // The path last sent stays until the line is left.
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
