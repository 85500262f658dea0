//! `pydslrep/plannedAt` and `pydslrep/actionLocation`, requests of our own: from the text to its planned path and back.
//! Both are described in `docs/protocol.md`. What they say is not part of a path, which would else change with every
//! line that is inserted above it.

use pydslrep_ide as ide;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{Location, TextDocumentPositionParams};

use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::environment;
use crate::state::State;

/// Name of the request.
pub(crate) const PLANNED_AT: &str = "pydslrep/plannedAt";

/// Name of the request.
pub(crate) const ACTION_LOCATION: &str = "pydslrep/actionLocation";

/// What of planned paths stands at a position.
#[derive(Debug, Serialize)]
pub(crate) struct PlannedAt {
    environments: Vec<String>,
    using: Vec<String>,
    action: Option<NumberedAction>,
}

/// An action by its number.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct NumberedAction {
    movement: String,
    index: usize,
}

/// Which action is meant.
#[derive(Debug, Deserialize)]
pub(crate) struct ActionOf {
    #[serde(flatten)]
    which: ChosenEnvironment,
    #[serde(flatten)]
    action: NumberedAction,
}

/// What of planned paths stands at a position; `None` where the document is not open or is no program.
pub(crate) fn planned_at(state: &State, at: &TextDocumentPositionParams) -> Option<PlannedAt> {
    let place = state.place(at)?;
    let found = ide::planned_at(&state.database, place.position());
    Some(PlannedAt {
        environments: found.environments.into_iter().map(String::from).collect(),
        using: found.using.into_iter().map(String::from).collect(),
        action: found.action.map(|(movement, index)| NumberedAction { movement: movement.into(), index }),
    })
}

/// Where an action of an environment stands; `None` where it is no longer there.
///
/// # Errors
///
/// If the document is not open, or has no such environment.
pub(crate) fn action_location(state: &State, of: &ActionOf) -> Result<Option<Location>> {
    let id = environment(state, &of.which)?;
    let movement = of.action.movement.as_str().into();
    let place = ide::action_place(&state.database, id, &movement, of.action.index);
    Ok(place.and_then(|(file, span)| state.location(file, span)))
}
