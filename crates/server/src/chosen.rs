//! Which environment of which program a client means, and what it has of it.

use pydslrep_analysis::Fingerprint;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tower_lsp::ls_types::Uri;

/// Which environment is meant: what an action carries until it is chosen, and the argument of commands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ChosenEnvironment {
    /// The program.
    pub(crate) uri: Uri,
    /// The environment in it.
    pub(crate) environment: String,
}

/// A path the client has, and how it looked then; `None` where there was none.
#[derive(Debug)]
pub(crate) struct Watched {
    /// Whose path.
    pub(crate) which: ChosenEnvironment,
    /// What the environment was made of, where it was without errors.
    pub(crate) fingerprint: Option<Fingerprint>,
    /// The path, as it was sent.
    pub(crate) path: Option<Value>,
}
