//! Answers of a simulator for tools.

use std::process::ExitCode;

use serde_json::{Value, json};

use crate::failure::Failure;
use crate::report::output;
use crate::run::interrupt;

/// Prints an answer as JSON, or why there is none: `{"error", "help", "reason"}`, with the exit code of a failure.
///
/// # Errors
/// If standard output is closed, or the failure is not one of the simulator's.
pub(super) fn report_json<T>(
    answer: Result<Option<T>, Failure>,
    describe: impl FnOnce(T) -> Value,
) -> Result<ExitCode, Failure> {
    let (json, code) = match answer {
        Ok(Some(answer)) => (describe(answer), 0),
        Ok(None) => return Ok(ExitCode::from(interrupt::EXIT_CODE)),
        Err(Failure::Message { message, help, reason }) => {
            (json!({ "error": message, "help": help, "reason": reason }), Failure::EXIT_CODE)
        }
        Err(other) => return Err(other),
    };
    output::print(&format!("{json:#}\n"))?;
    Ok(ExitCode::from(code))
}
