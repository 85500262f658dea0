//! The search for programs in folders.

use std::path::Path;

use super::Server;
use crate::log::log;
use crate::workspace::{MOST_ENTRIES, MOST_PROGRAMS};

/// Opens all programs in folders; returns a summary for the user. Runs on a thread of its own: messages are handled
/// between two files.
pub(super) fn index(server: &Server, folders: &[String]) -> String {
    let (mut programs, mut left_out) = (0, false);
    for folder in folders {
        let found = pydslrep_files::find(Path::new(folder), MOST_ENTRIES);
        left_out |= !found.complete;
        for failure in found.failures {
            log(format_args!("cannot read {failure}"));
        }
        // A nested folder may be excluded from the outer one.
        let is_open = server.state().folders.contains(folder);
        // Programs first: in a large workspace, scenes without a program are read when they are opened.
        for path in found.programs.into_iter().chain(found.scenes) {
            if !is_open && !server.state().is_part_of_workspace(&path.to_string_lossy()) {
                continue;
            }
            if programs == MOST_PROGRAMS {
                left_out = true;
                break;
            }
            match pydslrep_files::read(&path) {
                Ok(text) => {
                    server.state().add_found(&path, &text);
                    programs += usize::from(pydslrep_files::is_program(&path));
                }
                Err(unread) => log(format_args!("cannot read {}: {unread}", path.display())),
            }
        }
    }
    server.flush_diagnostics();
    let so_far = if left_out { "; the workspace is large: others are read when they are opened" } else { "" };
    format!("{programs} programs{so_far}")
}
