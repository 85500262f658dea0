//! The simulator that a command asks.

use std::path::PathBuf;

use clap::{Args, value_parser};
use pydslrep_config::SimulatorAddress;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::run::scene_tasks::{Interpreter, carry_out};

/// The running simulator, and the Python that asks it.
#[derive(Debug, Args)]
pub(super) struct Address {
    /// Where CoppeliaSim runs [default: `coppeliasim.host` of the settings, else 127.0.0.1]
    #[arg(long, value_name = "ADDRESS")]
    host: Option<String>,
    /// Port of its ZeroMQ remote API [default: `coppeliasim.port` of the settings, else 23000]
    #[arg(long, value_name = "PORT", value_parser = value_parser!(u16).range(1..))]
    port: Option<u16>,
    /// Hide progress
    #[arg(long)]
    no_progress: bool,
    /// The Python to connect with [default: python3]
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
}

/// A simulator, with what the settings say where no option does.
#[derive(Debug)]
pub(super) struct Simulator<'a> {
    pub(super) host: String,
    pub(super) port: u16,
    interpreter: Interpreter<'a>,
}

impl Address {
    /// The chosen simulator, by the settings of a program or, without one, of the current folder.
    pub(super) fn with(&self, settings: &SimulatorAddress) -> Simulator<'_> {
        Simulator {
            host: self.host.clone().unwrap_or_else(|| settings.host.clone()),
            port: self.port.unwrap_or(settings.port),
            interpreter: Interpreter { chosen: self.python.as_deref(), quiet: self.no_progress },
        }
    }
}

impl Simulator<'_> {
    /// Carries out a task with some parameters, which are a JSON object; `None` if the user interrupts it.
    ///
    /// # Errors
    /// If Python cannot be prepared, the simulator does not reply, or the task is refused.
    pub(super) fn ask<T: DeserializeOwned>(
        &self,
        task: &str,
        parameters: Value,
    ) -> Result<Option<T>, Failure> {
        let mut request = json!({ "task": task, "host": self.host, "port": self.port });
        if let (Value::Object(request), Value::Object(parameters)) = (&mut request, parameters) {
            request.extend(parameters);
        }
        carry_out(self.interpreter, &request)
    }
}
