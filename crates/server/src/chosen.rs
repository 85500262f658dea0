//! Which environment of which program a client means, and which paths it has.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide::PlannedPath;
use serde::{Deserialize, Serialize};
use tower_lsp::ls_types::Uri;

/// An environment: the data of an action until it is chosen, and the argument of commands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ChosenEnvironment {
    /// The program.
    pub(crate) uri: Uri,
    /// The environment in it.
    pub(crate) environment: String,
}

/// A planned path that the client has.
#[derive(Debug)]
pub(crate) struct Watched {
    /// Whose path.
    pub(crate) which: ChosenEnvironment,
    /// What the environment was made of, where it was without errors.
    pub(crate) fingerprint: Option<Fingerprint>,
    /// The path as it was sent; `None` where there was none.
    pub(crate) path: Option<PlannedPath>,
}
