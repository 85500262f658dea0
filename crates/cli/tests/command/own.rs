//! `pydslrep self check` and the manual pages.

use std::net::TcpListener;

use crate::process::{Done, Place};

/// The names of what `self check` prints.
fn names(done: &Done) -> Vec<&str> {
    done.out.lines().filter_map(|line| line.split_whitespace().next()).collect()
}

#[test]
fn a_report_names_everything_that_scripts_need() {
    let place = Place::new();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port().to_string();
    let mut command = place.command(&["self", "check", "--port", &port]);
    let done: Done = command.env("XDG_CACHE_HOME", place.path("cache")).output().unwrap().into();
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert_eq!(names(&done), ["pydslrep", "system", "cache", "python", "client", "odometry", "coppeliasim"]);
    let last = format!(
        "coppeliasim  something listens on 127.0.0.1:{port}: `pydslrep doctor PROGRAM` checks its scene\n"
    );
    assert!(done.out.ends_with(&last), "{}", done.out);
    drop(listener);
    let done = place.run(&["self", "check", "--port", &port]);
    assert!(done.out.contains("nothing listens on"), "{}", done.out);
}

#[test]
fn without_python_it_says_what_to_install() {
    let place = Place::new();
    let done: Done = place.command(&["self", "check"]).env("PATH", "").output().unwrap().into();
    assert_eq!(done.code, Some(1));
    let line = done.out.lines().find(|line| line.starts_with("python")).unwrap();
    assert!(line.contains("no Python on the PATH: install Python"), "{line}");
}

#[test]
fn packages_get_a_manual_page_of_every_command() {
    let place = Place::new();
    assert_eq!(place.run(&["share", "all"]).code, Some(0));
    for page in ["pydslrep.1", "pydslrep-run.1", "pydslrep-self-check.1"] {
        assert!(place.read(&format!("all/man/man1/{page}")).contains(".SH SYNOPSIS"), "{page}");
    }
    assert!(!place.path("all/man/man1/pydslrep-share.1").exists(), "only packages use it");
}

#[test]
fn packages_get_the_completions_of_every_shell() {
    let place = Place::new();
    assert_eq!(place.run(&["share", "all"]).code, Some(0));
    for (shell, path) in [
        ("bash", "bash-completion/completions/pydslrep"),
        ("elvish", "elvish/lib/pydslrep.elv"),
        ("fish", "fish/vendor_completions.d/pydslrep.fish"),
        ("powershell", "pydslrep/pydslrep.ps1"),
        ("zsh", "zsh/site-functions/_pydslrep"),
    ] {
        assert_eq!(place.read(&format!("all/{path}")), place.run(&["completions", shell]).out, "{shell}");
    }
}
