//! Watches files for `check --watch`.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

use notify::event::ModifyKind;
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use pydslrep_config::FILE_NAME;
use pydslrep_workspace::DocumentKind;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::timeout;

use crate::failure::Failure;

/// The pause in changes before the next check: editors save in several steps.
const QUIET: Duration = Duration::from_millis(50);

/// A check starts after this many events even if they do not pause.
const MAX_EVENTS: usize = 10_000;

/// The files and folders to watch.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Scope {
    /// Folders whose programs count, at any depth.
    pub(crate) folders: BTreeSet<PathBuf>,
    /// Files that count, whether they exist or not.
    pub(crate) files: BTreeSet<PathBuf>,
}

/// A watcher of a [`Scope`].
pub(crate) struct Watch {
    sender: UnboundedSender<Event>,
    events: UnboundedReceiver<Event>,
    scope: Scope,
    /// Watches until it is dropped.
    watcher: Option<RecommendedWatcher>,
}

impl Watch {
    /// A watcher of nothing.
    pub(crate) fn new() -> Self {
        let (sender, events) = unbounded_channel();
        Self { sender, events, scope: Scope::default(), watcher: None }
    }

    /// Watches this from now on, with a new watcher, so that replaced folders count. The old one still reports changes in
    /// between, except in what is watched only from now on.
    ///
    /// # Errors
    /// If the system does not allow it.
    pub(crate) fn look_at(&mut self, scope: Scope) -> Result<(), Failure> {
        let sender = self.sender.clone();
        // The receiver is gone only when the command ends.
        let tell = move |event: notify::Result<Event>| drop(event.map(|event| sender.send(event)));
        let mut watcher = notify::recommended_watcher(tell).map_err(|error| unwatched(&error))?;
        watch_all(&mut watcher, &scope)?;
        self.scope = scope;
        drop(self.watcher.replace(watcher));
        Ok(())
    }

    /// The current scope.
    pub(crate) fn scope(&self) -> &Scope {
        &self.scope
    }

    /// Waits for a change in the scope, and then until changes pause.
    pub(crate) async fn change(&mut self) {
        while let Some(event) = self.events.recv().await {
            if self.scope.concerns(&event) {
                break;
            }
        }
        for _ in 0..MAX_EVENTS {
            if timeout(QUIET, self.events.recv()).await.is_err() {
                break;
            }
        }
    }
}

/// Watches all folders of a scope, and then those that have appeared meanwhile: before its parent was watched, one that appears
/// is not reported.
fn watch_all(watcher: &mut RecommendedWatcher, scope: &Scope) -> Result<(), Failure> {
    let mut watched = BTreeSet::new();
    loop {
        let mut left = scope.watched();
        left.retain(|(folder, _)| !watched.contains(folder));
        if left.is_empty() {
            return Ok(());
        }
        for (folder, mode) in left {
            match watcher.watch(&folder, mode) {
                Ok(()) => {}
                // Removed in the meantime: its parent reports it. Not all parents are readable.
                Err(_) if !folder.exists() || mode == RecursiveMode::NonRecursive => {}
                Err(error) => return Err(unwatched(&error)),
            }
            watched.insert(folder);
        }
    }
}

fn unwatched(error: &notify::Error) -> Failure {
    Failure::new(format!("cannot watch for changes: {error}"))
        .help("watch a smaller folder, or raise the system's limit for watched files")
}

impl Scope {
    /// The folders to watch: those that count, recursively; and all parents of every file, since a settings file may
    /// appear in any of them, and folders may come and go.
    fn watched(&self) -> Vec<(PathBuf, RecursiveMode)> {
        let above = self.files.iter().chain(&self.folders).flat_map(|path| path.ancestors().skip(1));
        let above: BTreeSet<&Path> =
            above.filter(|folder| folder.is_dir() && !self.is_inside(folder)).collect();
        let inside = self.folders.iter().filter(|folder| folder.is_dir());
        let inside = inside.map(|folder| (folder.clone(), RecursiveMode::Recursive));
        inside
            .chain(above.into_iter().map(|folder| (folder.to_owned(), RecursiveMode::NonRecursive)))
            .collect()
    }

    fn is_inside(&self, path: &Path) -> bool {
        self.folders.iter().any(|folder| path.starts_with(folder))
    }

    fn concerns(&self, event: &Event) -> bool {
        let is_move = match event.kind {
            // Reading is not a change.
            EventKind::Access(_) => return false,
            EventKind::Create(_) | EventKind::Remove(_) | EventKind::Modify(ModifyKind::Name(_)) => true,
            _ => false,
        };
        // The system could not keep up, so the paths are unknown.
        event.need_rescan() || event.paths.iter().any(|path| self.concerns_path(path, is_move))
    }

    fn concerns_path(&self, path: &Path, is_move: bool) -> bool {
        path.file_name() == Some(OsStr::new(FILE_NAME))
            || self.files.contains(path)
            || (self.is_inside(path) && (DocumentKind::of_file(path).is_some() || is_move))
            // A parent of a watched path appeared or disappeared.
            || (is_move && self.files.iter().chain(&self.folders).any(|other| other.starts_with(path)))
    }
}

#[cfg(test)]
mod tests {
    use notify::event::{AccessKind, CreateKind, DataChange, RemoveKind, RenameMode};

    use super::*;

    fn concerns(kind: EventKind, path: &str) -> bool {
        let set = |paths: &[&str]| paths.iter().map(PathBuf::from).collect();
        let scope = Scope { folders: set(&["/p/rooms"]), files: set(&["/p/x.pyr", "/p/parts/wheels.pyr"]) };
        scope.concerns(&Event::new(kind).add_path(path.into()))
    }

    #[test]
    fn only_changes_in_the_scope_count() {
        let write = EventKind::Modify(ModifyKind::Data(DataChange::Any));
        let rename = EventKind::Modify(ModifyKind::Name(RenameMode::Any));
        let (create, remove) = (EventKind::Create(CreateKind::Any), EventKind::Remove(RemoveKind::Any));
        for path in ["/p/x.pyr", "/p/rooms/new.pyr", "/p/rooms/a/b.pyr", "/p/pydslrep.toml", "/pydslrep.toml"]
        {
            assert!([write, rename, create, remove].into_iter().all(|kind| concerns(kind, path)), "{path}");
            assert!(!concerns(EventKind::Access(AccessKind::Any), path), "{path}");
        }
        // Folders, which may hold programs from their first moment on.
        for path in ["/p/rooms/new", "/p/parts", "/p", "/p/rooms"] {
            assert!([rename, create, remove].into_iter().all(|kind| concerns(kind, path)), "{path}");
            assert!(!concerns(write, path), "{path}");
        }
        for path in ["/p/y.pyr", "/p/parts/other.pyr", "/p/rooms/log.txt", "/q", "/p/halls"] {
            assert!(!concerns(write, path), "{path}");
        }
        assert!(!concerns(create, "/p/halls") && !concerns(create, "/q/y.pyr"));
    }
}
