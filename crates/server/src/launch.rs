//! The parameters of a session.

use std::path::PathBuf;

use pydslrep_config::Config;

/// The parameters that the program passes to the session it starts.
#[derive(Debug)]
pub(crate) struct Launch {
    /// The program that runs environments.
    pub(crate) command: PathBuf,
    /// Options that override all settings.
    pub(crate) options: Config,
}
