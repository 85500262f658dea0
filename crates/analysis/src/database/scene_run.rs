//! The planned run of an environment in its scene, kept while the environment is the same.

use std::sync::{Arc, Mutex, PoisonError};

use crate::diagnostics::PlannedRun;
use crate::fingerprint::Fingerprint;

/// The planned run of an environment in its scene, once it is known.
#[derive(Debug, Clone, Default)]
pub(super) struct SceneRun {
    /// The fingerprint of the environment when its files were last touched because of it.
    pub(super) touched_with: Option<Fingerprint>,
    /// Clones share it; its fingerprint says when it is outdated.
    known: Arc<Mutex<Option<KnownRun>>>,
}

/// The fingerprint of an environment, and its planned run.
type KnownRun = (Fingerprint, Option<Arc<PlannedRun>>);

impl SceneRun {
    /// The run of an environment with this fingerprint; `plan` is called where another one is known, or none.
    pub(super) fn of(
        &self,
        fingerprint: Fingerprint,
        plan: impl FnOnce() -> Option<PlannedRun>,
    ) -> Option<Arc<PlannedRun>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((of, run)) = known.as_ref()
            && *of == fingerprint
        {
            return run.clone();
        }
        let run = plan().map(Arc::new);
        *known = Some((fingerprint, run.clone()));
        run
    }

    /// Returns whether the run is known to have problems.
    pub(super) fn has_problems(&self) -> bool {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.as_ref().and_then(|(_, run)| run.as_ref()).is_some_and(|run| run.has_problems())
    }
}
