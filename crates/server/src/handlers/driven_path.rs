//! `pydslrep/drivenPath`, a request of our own: where the robots were in the latest run of an environment, and
//! `pydslrep/drivenPathChanged`, the notification that there was another one. Both are described in `docs/protocol.md`.

use rustc_hash::FxHashMap;
use serde_json::Value;

use crate::chosen::ChosenEnvironment;
use crate::documents::key;
#[cfg(feature = "process")]
use crate::driven;
#[cfg(feature = "process")]
use crate::message::Outbox;

/// Name of the request.
pub(crate) const DRIVEN_PATH: &str = "pydslrep/drivenPath";

/// Name of the notification.
#[cfg(feature = "process")]
const DRIVEN_PATH_CHANGED: &str = "pydslrep/drivenPathChanged";

/// What was driven in this session.
#[derive(Debug, Default)]
pub(crate) struct DrivenPaths {
    /// By the program's key and the environment's name.
    paths: FxHashMap<(String, String), Value>,
    /// What the client has, and wants to hear of.
    watched: Vec<ChosenEnvironment>,
}

impl DrivenPaths {
    /// The path of the latest run; null where there was none. From now on the client is told when there is another.
    pub(crate) fn answer(&mut self, which: &ChosenEnvironment) -> Value {
        if !self.watched.contains(which) {
            self.watched.push(which.clone());
        }
        self.paths.get(&place(which)).cloned().unwrap_or_default()
    }

    /// A run has ended, well or badly, that wrote these files; none of them where it did not get that far.
    #[cfg(feature = "process")]
    pub(crate) fn add(
        &mut self,
        which: &ChosenEnvironment,
        trace: &std::path::Path,
        map: &std::path::Path,
        outbox: &Outbox,
    ) {
        let Ok(robots) = driven::read(trace, map) else { return };
        if robots.is_empty() {
            return;
        }
        let path = serde_json::json!({ "environment": which.environment, "robots": robots });
        self.paths.insert(place(which), path);
        self.watched.retain(|watched| {
            let is_other = place(watched) != place(which);
            if !is_other {
                outbox.notify(DRIVEN_PATH_CHANGED, watched);
            }
            is_other
        });
    }
}

fn place(which: &ChosenEnvironment) -> (String, String) {
    (key(&which.uri), which.environment.clone())
}
