//! `pydslrep/drivenPath`, a request of our own: where the robots were in the latest run of an environment, and
//! `pydslrep/drivenPathChanged`, the notification of another run. Both are described in `docs/protocol.md`.

use std::sync::Arc;

use rustc_hash::FxHashMap;
use serde_json::Value;
#[cfg(feature = "process")]
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;

use crate::chosen::ChosenEnvironment;
use crate::documents::key;
#[cfg(feature = "process")]
use crate::driven;
#[cfg(feature = "process")]
use crate::message::Outbox;
use crate::page::Audience;
#[cfg(feature = "process")]
use crate::page::Pages;
use crate::shared::Shared;

/// The request.
pub(crate) enum DrivenPath {}

impl Request for DrivenPath {
    type Params = ChosenEnvironment;
    type Result = Option<Value>;
    const METHOD: &'static str = "pydslrep/drivenPath";
}

/// The notification.
#[cfg(feature = "process")]
enum DrivenPathChanged {}

#[cfg(feature = "process")]
impl Notification for DrivenPathChanged {
    type Params = ChosenEnvironment;
    const METHOD: &'static str = "pydslrep/drivenPathChanged";
}

/// The latest path of each environment that was run in this session; clones share them.
#[derive(Debug, Clone, Default)]
pub(crate) struct DrivenPaths(Arc<Shared<Driven>>);

#[derive(Debug, Default)]
struct Driven {
    /// By the program's key and the environment's name.
    paths: FxHashMap<(String, String), Value>,
    /// The audiences of each environment, which are notified of changes.
    watched: Vec<(Audience, ChosenEnvironment)>,
}

impl DrivenPaths {
    /// The path of the latest run of an environment; `None` where there was none. From now on its audience is
    /// notified of another.
    pub(crate) fn watch(&self, which: &ChosenEnvironment, audience: Audience) -> Option<Value> {
        let (mut driven, watched) = (self.0.lock(), (audience, which.clone()));
        if !driven.watched.contains(&watched) {
            driven.watched.push(watched);
        }
        driven.paths.get(&place(which)).cloned()
    }

    /// Adds the path of a run that has ended, successfully or not, with what was planned when it began; it may not have
    /// written any of these files.
    #[cfg(feature = "process")]
    pub(crate) fn add(
        &self,
        which: &ChosenEnvironment,
        planned: Option<&Value>,
        (trace, map): (&std::path::Path, &std::path::Path),
        outbox: &Outbox,
        pages: &Pages,
    ) {
        let Ok(robots) = driven::read(trace, map) else { return };
        if robots.is_empty() {
            return;
        }
        let path =
            serde_json::json!({ "environment": which.environment, "robots": robots, "planned": planned });
        let mut driven = self.0.lock();
        driven.paths.insert(place(which), path);
        driven.watched.retain(|(audience, watched)| {
            let is_other = place(watched) != place(which);
            match audience {
                _ if is_other => {}
                Audience::Client => outbox.send_notification::<DrivenPathChanged>(watched),
                Audience::Page => pages.notify::<DrivenPathChanged>(watched),
            }
            is_other
        });
    }
}

fn place(which: &ChosenEnvironment) -> (String, String) {
    (key(&which.uri), which.environment.clone())
}
