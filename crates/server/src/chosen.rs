//! Which environment of which program a client means, and which paths it has.

use pydslrep_analysis::Fingerprint;
use pydslrep_ide::PlannedPath;
use serde::{Deserialize, Serialize};
use tower_lsp::jsonrpc::Error;
use tower_lsp::ls_types::Uri;

use crate::page::Audience;

/// An environment: the data of an action until it is chosen, and the argument of commands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ChosenEnvironment {
    /// The program.
    pub(crate) uri: Uri,
    /// The environment in it.
    pub(crate) environment: String,
}

/// A planned path that the client or a page has.
#[derive(Debug)]
pub(crate) struct Watched {
    /// The audience that has it.
    pub(crate) audience: Audience,
    /// Whose path.
    pub(crate) which: ChosenEnvironment,
    /// The fingerprint of the environment; `None` if it had errors.
    pub(crate) fingerprint: Option<Fingerprint>,
    /// The version that was sent.
    pub(crate) sent: Sent,
}

impl Watched {
    /// Returns whether it is the path of this environment for this audience.
    pub(crate) fn is(&self, which: &ChosenEnvironment, audience: Audience) -> bool {
        self.audience == audience && self.which == *which
    }
}

/// The version of a path that its audience has.
#[derive(Debug)]
pub(crate) enum Sent {
    /// This one.
    Path(PlannedPath),
    /// There was none, for this reason.
    Failure(Error),
    /// One that is too long to be compared, or that is still being planned.
    Long,
}
