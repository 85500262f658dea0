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
use crate::view::View;

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
    view: &View,
    which: &ChosenEnvironment,
    audience: Audience,
) -> Result<ide::PlannedPath> {
    let path = plan(view, which);
    let fingerprint = fingerprint(view, which);
    let sent = match &path {
        Ok(path) if path.robots.iter().any(|robot| robot.legs.len() > MAX_LEGS) => Sent::Long,
        Ok(path) => Sent::Path(path.clone()),
        Err(error) => Sent::Failure(error.clone()),
    };
    view.watched.set(Watched { audience, which: which.clone(), fingerprint, sent });
    path.map_err(|error| with_fix(view, which, error))
}

/// The planned path of an environment as clients get it, without telling anyone of changes; `None` where there is none.
#[cfg(feature = "process")]
pub(crate) fn as_json(view: &View, which: &ChosenEnvironment) -> Option<Value> {
    serde_json::to_value(plan(view, which).ok()?).ok()
}

fn plan(view: &View, which: &ChosenEnvironment) -> Result<ide::PlannedPath> {
    let path = ide::planned_path(view.database(), environment(view, which)?);
    path.map_err(|why| no_path(view, which, &why))
}

/// Why there is no path, with the place of the first error.
fn no_path(view: &View, which: &ChosenEnvironment, why: &ide::NoPath) -> Error {
    match why {
        ide::NoPath::Blocked(errors) => blocked(view, errors),
        ide::NoPath::Scene { problems, .. } => {
            let scene = scene(view, which);
            let span = problems.first().and_then(|problem| problem.span);
            let location = scene
                .zip(span)
                .and_then(|(scene, span)| Some(Location::new(scene.uri()?, view.range(scene, span))));
            with_cause(why.to_string(), &Cause::Errors { location })
        }
        ide::NoPath::Robot(_) => failure(why.to_string()),
    }
}

/// Adds the title of the first fix to the data of an error of [`no_path`]: the code action of this title at its location.
fn with_fix(view: &View, which: &ChosenEnvironment, mut error: Error) -> Error {
    if let Some(Value::Object(data)) = &mut error.data
        && let Some(title) = first_fix(view, which)
    {
        data.insert("fix".to_owned(), title.into());
    }
    error
}

fn first_fix(view: &View, which: &ChosenEnvironment) -> Option<String> {
    let (database, id) = (view.database(), environment(view, which).ok()?);
    let title = if let Err(blocked) = database.environment(id) {
        let first = blocked.errors.first()?;
        let fixes = ide::quick_fixes(database, first.file, first.span).into_iter();
        fixes.map(|found| found.fix.title).next()?
    } else {
        let uri = scene(view, which)?.uri()?;
        let (document, file, text) = view.toml_text(&uri)?;
        let problem = view.workspace.problems(document.key).into_iter().next()?;
        ide::toml_fixes(file, &text, problem.span?).into_iter().next()?.title
    };
    Some(code_actions::sentence(&title))
}

/// The scene of an environment.
fn scene<'a>(view: &'a View, which: &ChosenEnvironment) -> Option<Document<'a>> {
    let (_, file) = view.analysed(&which.uri)?;
    view.scene_document(file, &which.environment)
}

fn fingerprint(view: &View, which: &ChosenEnvironment) -> Option<Fingerprint> {
    view.database().fingerprint(environment(view, which).ok()?)
}

/// Returns whether the audience has the current path.
fn is_sent(view: &View, watched: &Watched) -> bool {
    match &watched.sent {
        Sent::Path(path) => plan(view, &watched.which).as_ref() == Ok(path),
        Sent::Failure(error) => plan(view, &watched.which).as_ref() == Err(error),
        Sent::Long => false,
    }
}

/// Notifies the client and pages which of their paths are outdated, each once; they request them again if they still
/// need them.
pub(crate) fn announce(state: &State, outbox: &Outbox) {
    let view = &state.view;
    for mut watched in view.watched.take() {
        let fingerprint = fingerprint(view, &watched.which);
        // Most edits do not affect the path: then nothing is planned again.
        let is_the_same = fingerprint.is_some() && fingerprint == watched.fingerprint;
        if is_the_same || is_sent(view, &watched) {
            watched.fingerprint = fingerprint;
            view.watched.set(watched);
        } else if view.is_error_unsettled() && plan(view, &watched.which).is_err() {
            // The path last sent stays until the line is left.
            view.watched.set(watched);
        } else {
            match watched.audience {
                Audience::Client => outbox.send_notification::<PlannedPathChanged>(&watched.which),
                #[cfg(feature = "process")]
                Audience::Page => state.pages.notify::<PlannedPathChanged>(&watched.which),
            }
        }
    }
}
