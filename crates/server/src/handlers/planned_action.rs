//! `pydslrep/plannedAt` and `pydslrep/actionLocation`, requests of our own: from the text to its planned path and back.
//! Both are described in `docs/protocol.md`. Locations are not part of a path, which would otherwise change with every
//! line that is inserted above it.

use pydslrep_ide::{self as ide, NumberedAction};
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
    type Result = Option<ide::PlannedAt>;
    const METHOD: &'static str = "pydslrep/plannedAt";
}

/// The request for where an action is written.
pub(crate) enum ActionLocation {}

impl Request for ActionLocation {
    type Params = ActionOf;
    type Result = Option<Location>;
    const METHOD: &'static str = "pydslrep/actionLocation";
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
pub(crate) fn planned_at(state: &mut State, at: &TextDocumentPositionParams) -> Option<ide::PlannedAt> {
    let state = &*state;
    let place = state.place(at)?;
    Some(ide::planned_at(state.database(), place.position()))
}

/// Where an action of an environment is written; `None` if it is gone.
///
/// # Errors
///
/// If the document is not open, or has no such environment.
pub(crate) fn action_location(state: &State, of: &ActionOf) -> Result<Option<Location>> {
    let id = environment(state, &of.which)?;
    let place = ide::action_place(state.database(), id, &of.action);
    Ok(place.and_then(|(file, span)| state.location(file, span)))
}
