//! Reads the programs and scenes of folders.

use pydslrep_workspace::{DocumentKind, key_of, path_of};

use super::Server;
use crate::log::log;

/// More programs than these are read only when they are opened.
const MAX_PROGRAMS: usize = 5_000;

/// No more files and folders than these are visited in search of programs: somebody may have opened a whole disk.
const MAX_ENTRIES: usize = 100_000;

/// Adds all programs and scenes of folders to the workspace; returns a summary. To be run on a thread of its own
/// where there is a disk: each file is read without holding the state, and messages are handled in between.
pub(super) fn index(server: &Server, folders: &[String]) -> String {
    let files = server.state().view.workspace.files();
    let (mut programs, mut is_incomplete) = (0, false);
    for folder in folders {
        let listing = files.list(&path_of(folder), MAX_ENTRIES);
        is_incomplete |= listing.is_truncated;
        for error in listing.errors {
            log(format_args!("cannot read the folder {error}"));
        }
        // A folder inside another may be ignored there.
        let is_open = server.state().view.workspace.folders().contains(folder);
        // Programs first: in a large workspace, scenes without one wait until they are opened.
        for path in listing.programs.into_iter().chain(listing.scenes) {
            let key = key_of(&path);
            if !is_open && !server.state().view.workspace.is_listed(&key) {
                continue;
            }
            if programs == MAX_PROGRAMS {
                is_incomplete = true;
                break;
            }
            match files.read(&path) {
                Ok(text) => {
                    server.state().workspace_mut().add(&key, &text);
                    let is_program = DocumentKind::of_document(&key) == DocumentKind::Program;
                    programs += usize::from(is_program);
                }
                Err(error) => log(format_args!("cannot read {}: {error}", path.display())),
            }
        }
    }
    server.flush_diagnostics();
    let rest =
        if is_incomplete { "; the workspace is large, and the rest is read when it is opened" } else { "" };
    format!("{programs} programs{rest}")
}
