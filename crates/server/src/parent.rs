//! Exiting when the client has died. Usually the input ends then, but another child of the client may have inherited
//! the pipe and keep it open. So the client's process is watched too, where that costs nothing.

use std::fs;
use std::iter::successors;
use std::os::unix::process::parent_id;
use std::thread;

use rustix::event::{PollFd, PollFlags, poll};
use rustix::process::{Pid, PidfdFlags, pidfd_open};

use crate::log::log;

/// Exits as soon as the client's process has ended, with the exit code of an abrupt end, after `tidy_up`.
///
/// Only an ancestor of this process is watched: with a container or a remote shell in between, the same process id
/// belongs to another process.
pub(crate) fn leave_with(client: u32, tidy_up: impl Fn() + Send + 'static) {
    if !is_ancestor(client) {
        return;
    }
    let Some(pid) = i32::try_from(client).ok().and_then(Pid::from_raw) else { return };
    let Ok(process) = pidfd_open(pid, PidfdFlags::empty()) else { return };
    let watch = move || {
        let mut ends = [PollFd::new(&process, PollFlags::IN)];
        while let Ok(0) | Err(rustix::io::Errno::INTR) = poll(&mut ends, None) {}
        log(format_args!("the client's process {client} has ended"));
        tidy_up();
        std::process::exit(1);
    };
    // Without the thread, the end of the input still ends the session.
    let _ = thread::Builder::new().name("client watch".to_owned()).spawn(watch);
}

fn is_ancestor(client: u32) -> bool {
    let parent = |process: &u32| parent_of(*process).filter(|parent| *parent > 1);
    // A longer chain can only be one that changed while it was read.
    successors(Some(parent_id()), parent).take(64).any(|process| process == client)
}

/// The name in `/proc/…/stat` may contain spaces and brackets; the state and the parent follow its last bracket.
fn parent_of(process: u32) -> Option<u32> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, fields) = stat.rsplit_once(')')?;
    fields.split_ascii_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ancestors_are_recognised() {
        let parent = parent_id();
        assert!(is_ancestor(parent));
        assert!(!is_ancestor(std::process::id()));
        assert_eq!(parent_of(std::process::id()), Some(parent));
    }
}
