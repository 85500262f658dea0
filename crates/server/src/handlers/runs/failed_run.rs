//! Why a run failed, and where in the user's program: scripts say which action of which movement it was.

use pydslrep_ide::{NumberedAction, PlannedCall, action_place};
use pydslrep_trace::{Call, FailureClass, RunFailure};
use tower_lsp::jsonrpc::Error;

use super::{ERROR, ended_badly};
use crate::chosen::ChosenEnvironment;
use crate::handlers::scripts::{Cause, cancelled, environment, failure, with_cause};
use crate::view::View;

/// The error of a run, with the place of the action that failed if that is still there. `stderr` has the lines that the
/// command wrote to standard error.
pub(super) fn error(view: &View, which: &ChosenEnvironment, failed: &RunFailure, stderr: &[String]) -> Error {
    match failed.class {
        FailureClass::Interrupted => cancelled("the run was cancelled"),
        // The problems are there.
        FailureClass::Program => ended_badly(None, stderr),
        FailureClass::Crash => failure(failed.output.clone().unwrap_or_else(|| words(failed))),
        FailureClass::Action | FailureClass::Setup | FailureClass::Simulator | FailureClass::File => {
            located(view, which, failed).unwrap_or_else(|| failure(words(failed)))
        }
    }
}

/// A failure as the command prints it.
fn words(failed: &RunFailure) -> String {
    let help = failed.help.as_ref().map(|help| format!("\n |\n = help: {help}"));
    format!("{ERROR}{}{}", failed.message, help.unwrap_or_default())
}

/// The error with the place of the action that failed, if it is an action's failure.
fn located(view: &View, which: &ChosenEnvironment, failed: &RunFailure) -> Option<Error> {
    let index = failed.action?.checked_sub(1)?;
    let call = |call: &Call| {
        Some(PlannedCall { movement: call.movement.clone(), index: call.action.checked_sub(1)? })
    };
    let calls = failed.calls.iter().map(call).collect::<Option<_>>()?;
    let action = NumberedAction { movement: failed.movement.clone()?, index, calls };
    let database = view.database();
    let (file, span) = action_place(database, environment(view, which).ok()?, &action)?;
    let location = view.location(file, span)?;
    let name = database.path(file).rsplit('/').next().unwrap_or_default();
    let line = location.range.start.line + 1;
    let message = format!("{} ({name}, line {line})", failed.message);
    Some(with_cause(message, &Cause::FailedRun { location }))
}
