//! `pydslrep/plannedAt` and `pydslrep/actionLocation`, requests of our own: from the text to its planned path and back.
//! Both are described in `docs/protocol.md`. Locations are not part of a path, which would otherwise change with every
//! line that is inserted above it.

use pydslrep_ide as ide;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::request::Request;
use tower_lsp::ls_types::{Location, TextDocumentPositionParams};

use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::environment;
use crate::state::State;

/// The request for what a position has to do with planned paths.
pub(crate) enum PlannedAt {}

impl Request for PlannedAt {
    type Params = TextDocumentPositionParams;
    type Result = Option<AtPosition>;
    const METHOD: &'static str = "pydslrep/plannedAt";
}

/// The request for where an action is written.
pub(crate) enum ActionLocation {}

impl Request for ActionLocation {
    type Params = ActionOf;
    type Result = Option<Location>;
    const METHOD: &'static str = "pydslrep/actionLocation";
}

/// What a position has to do with planned paths.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct AtPosition {
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
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ActionOf {
    #[serde(flatten)]
    which: ChosenEnvironment,
    #[serde(flatten)]
    action: NumberedAction,
}

/// What a position has to do with planned paths; `None` where the document is not open or not a program.
pub(crate) fn planned_at(state: &mut State, at: &TextDocumentPositionParams) -> Option<AtPosition> {
    state.cursor_is(at);
    let place = state.place(at)?;
    let found = ide::planned_at(&state.database, place.position());
    Some(AtPosition {
        environments: found.environments.into_iter().map(String::from).collect(),
        using: found.using.into_iter().map(String::from).collect(),
        action: found.action.map(|(movement, index)| NumberedAction { movement: movement.into(), index }),
    })
}

/// Where an action of an environment is written; `None` if it is gone.
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
