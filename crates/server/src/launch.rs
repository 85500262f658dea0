//! How a session is started.

use std::path::PathBuf;

use pydslrep_config::Config;

/// What the program that starts a session tells it.
#[derive(Debug)]
pub(crate) struct Launch {
    /// The program that runs environments.
    pub(crate) command: PathBuf,
    /// What wins over all settings.
    pub(crate) options: Config,
}
