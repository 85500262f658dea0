//! `pydslrep/plannedAt` and `pydslrep/actionLocation`, requests of our own: from the text to its planned path and back.
//! Both are described in `docs/protocol.md`. Locations are not part of a path, which would otherwise change with every
//! line that is inserted above it.

use pydslrep_ide::{self as ide, NumberedAction};
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::request::Request;
use tower_lsp::ls_types::{Location, TextDocumentPositionParams, Uri};

use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::environment;
use crate::view::View;

/// The request for the environments and the action at a position.
pub(crate) enum PlannedAt {}

impl Request for PlannedAt {
    type Params = TextDocumentPositionParams;
    type Result = Option<At>;
    const METHOD: &'static str = "pydslrep/plannedAt";
}

/// The request for where an action is written.
pub(crate) enum ActionLocation {}

impl Request for ActionLocation {
    type Params = ActionOf;
    type Result = Option<Location>;
    const METHOD: &'static str = "pydslrep/actionLocation";
}

/// An action of an environment.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ActionOf {
    #[serde(flatten)]
    which: ChosenEnvironment,
    #[serde(flatten)]
    action: NumberedAction,
}

/// The environments and the action that a position belongs to in planned paths.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct At {
    #[serde(flatten)]
    planned: ide::PlannedAt,
    /// The program, where the position is in its scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    program: Option<Uri>,
}

/// Returns the environments and the action at a position; `None` if the document is not open, or is neither a program
/// nor the scene of one. An environment being typed is named once it lists robots: before, its name changes with each
/// letter.
pub(crate) fn planned_at(view: &View, at: &TextDocumentPositionParams) -> Option<At> {
    if let Some(place) = view.place(at) {
        let mut planned = ide::planned_at(view.database(), place.position());
        for statement in view.statements_being_typed(place.document) {
            if let Some(begun) = statement.begun_environment() {
                planned.environments.retain(|name| name != begun);
                planned.using.retain(|name| name != begun);
            }
        }
        return Some(At { planned, program: None });
    }
    let (which, _) = view.driven_in(&at.text_document.uri)?;
    let (environments, using) = (vec![which.environment.clone()], vec![which.environment]);
    let planned = ide::PlannedAt { environments, using, action: None };
    Some(At { planned, program: Some(which.uri) })
}

/// Where an action of an environment is written; `None` if it is gone.
///
/// # Errors
///
/// If the document is not open, or has no such environment.
pub(crate) fn action_location(view: &View, of: &ActionOf) -> Result<Option<Location>> {
    let id = environment(view, &of.which)?;
    let place = ide::action_place(view.database(), id, &of.action);
    Ok(place.and_then(|(file, span)| view.location(file, span)))
}
