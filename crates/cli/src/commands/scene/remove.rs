//! `pydslrep scene remove`: removes the objects that `push` has made.

use std::process::ExitCode;

use clap::Args;
use serde::Deserialize;
use serde_json::json;

use crate::failure::Failure;
use crate::inputs::settings_here;
use crate::report::output;
use crate::run::interrupt;

use super::address::{Address, Simulator};
use super::json::report_json;

/// Remove what `scene push` has made from a running CoppeliaSim; nothing else is touched
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Only what was made for this environment
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    address: Address,
}

#[derive(Debug, Deserialize)]
struct Answer {
    /// The number of objects.
    removed: usize,
    /// True if the main script was removed, too.
    main_script: bool,
}

/// Runs the command.
///
/// # Errors
/// If the simulator does not reply, or does not remove them.
pub(super) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let parameters = json!({ "environment": arguments.environment });
    let simulator = arguments.address.with(&settings_here()?.coppeliasim);
    let answer = simulator.ask::<Answer>("remove", parameters);
    if arguments.json {
        return report_json(
            answer,
            |answer| json!({ "removed": answer.removed, "main_script": answer.main_script }),
        );
    }
    let Some(answer) = answer? else {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    let removed = output::count(answer.removed, "object");
    let script = if answer.main_script { " and the main script" } else { "" };
    let Simulator { host, port, .. } = simulator;
    output::print(&format!("Removed {removed}{script} from CoppeliaSim at {host}:{port}.\n"))?;
    Ok(ExitCode::SUCCESS)
}
