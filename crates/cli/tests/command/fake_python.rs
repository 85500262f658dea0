//! `pydslrep run` with a Python that misbehaves on command.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};

use expect_test::expect;
use pydslrep_trace::{FailureClass, RunEvent, RunFailure};
use rustix::process::Signal;

use crate::process::{Done, Place, paper};

/// Answers like a Python, asks no package index, makes environments of copies of itself, and runs `behave` in place of
/// scripts.
const PYTHON: &str = r#"#!/bin/sh
case "$*" in
  "-c "*) echo 3.12.0; echo "$0" ;;
  "-I -c "*) . "$INDEX" ;;
  "-I -m venv --without-pip "*) mkdir -p "$5/bin"; cp "$0" "$5/bin/python" ;;
  "-I -m pip --python "*" --version") exit ${BASE_PIP_CODE:-0} ;;
  "-I -m ensurepip") touch "$0-has-pip"; exit ${ENSUREPIP_CODE:-0} ;;
  "-I -m pip install "*) [ -e "$0-has-pip" ] ;;
  "-I -m pip "*) exit ${PIP_CODE:-0} ;;
  *) . "$BEHAVIOUR" ;;
esac
"#;

/// The messages of a first run outside of a terminal while it prepares Python.
const PREPARING: &str = "\
preparing Python for the first run: creating a virtual environment
preparing Python for the first run: installing the CoppeliaSim client library
";

fn place(behaviour: &str) -> Place {
    let place = Place::with("python", PYTHON);
    fs::set_permissions(place.path("python"), fs::Permissions::from_mode(0o755)).unwrap();
    place.write("behaviour", behaviour);
    place
}

fn command(place: &Place) -> Command {
    let program = paper("table2_two_wheels");
    let mut command = place.command(&["run", &program, "--python", place.path("python").to_str().unwrap()]);
    command.env("XDG_CACHE_HOME", place.path("cache")).env("BEHAVIOUR", place.path("behaviour"));
    command.env("INDEX", "/dev/null");
    command
}

fn run(behaviour: &str) -> Done {
    command(&place(behaviour)).output().unwrap().into()
}

/// A command that writes an event.
fn tell(event: &RunEvent) -> String {
    format!("echo '{}'", event.line().trim_end())
}

/// A command that reports a failure.
fn failed(class: FailureClass, message: &str) -> String {
    tell(&RunEvent::Failed(RunFailure::new(class, message)))
}

#[test]
fn a_run_tells_how_it_failed() {
    for (behaviour, class, message) in [
        ("exit 3", FailureClass::Crash, "the script ended with exit status: 3"),
        ("exit 130", FailureClass::Interrupted, "interrupted"),
        (failed(FailureClass::File, "no space").as_str(), FailureClass::Crash, ""),
    ] {
        let place = place(behaviour);
        let done: Done = command(&place).args(["--events", "-"]).output().unwrap().into();
        let events: Vec<RunEvent> = done.out.lines().map(|line| RunEvent::parse(line).unwrap()).collect();
        let found = events.iter().find_map(|event| match event {
            RunEvent::Failed(failure) => Some((failure.class, failure.message.as_str())),
            _ => None,
        });
        // A script that ends with 0 has succeeded.
        assert_eq!(found, (done.code != Some(0)).then_some((class, message)), "{}", done.out);
        let begin = events.iter().take_while(|event| matches!(event, RunEvent::Progress { robot: None, .. }));
        assert_eq!(begin.count(), 2, "of a first run: {}", done.out);
    }
}

#[test]
fn a_movement_that_failed_is_told() {
    let stuck = failed(FailureClass::Action, "robot robot_1, movement mov_1, action 1: move 4 m: stuck");
    let done = run(&format!("{stuck}; echo 'of a class of its own' >&2; exit 1"));
    assert_eq!(done.code, Some(1));
    let failure = "error: robot robot_1, movement mov_1, action 1: move 4 m: stuck\n";
    assert_eq!(done.err, format!("{PREPARING}of a class of its own\n{failure}"));
}

#[test]
fn what_a_first_run_installs_is_told_once() {
    let place = place("");
    let first: Done = command(&place).output().unwrap().into();
    assert!(first.err.starts_with(PREPARING), "{}", first.err);
    for done in [
        Done::from(command(&place).output().unwrap()),
        command(&place)
            .env("XDG_CACHE_HOME", place.path("other"))
            .arg("--no-progress")
            .output()
            .unwrap()
            .into(),
    ] {
        assert!(!done.err.contains("preparing"), "{}", done.err);
    }
}

#[test]
fn odometry_installs_more_when_it_is_first_asked_for() {
    let place = place("");
    let explore = |arguments: &[&str]| -> Done {
        let python = place.path("python");
        let program = paper("table7_slam");
        let mut command = place.command(&["run", &program, "--python", python.to_str().unwrap()]);
        command.args(arguments).env("XDG_CACHE_HOME", place.path("cache"));
        command.env("BEHAVIOUR", place.path("behaviour")).env("INDEX", "/dev/null");
        command.output().unwrap().into()
    };
    assert!(explore(&[]).err.starts_with(PREPARING));
    assert!(explore(&["--odometry"]).err.starts_with(
        "\
preparing Python for the first run with --odometry: creating a virtual environment
preparing Python for the first run with --odometry: installing the CoppeliaSim client library, NumPy and SciPy
"
    ));
    for again in [&["--odometry"][..], &[]] {
        assert!(!explore(again).err.contains("preparing"));
    }
}

#[test]
fn odometry_is_for_those_who_explore() {
    let place = place("");
    let done: Done = command(&place).arg("--odometry").output().unwrap().into();
    assert!(done.err.starts_with(PREPARING), "{}", done.err);
}

#[test]
fn a_script_that_breaks_is_an_outside_failure() {
    let done = run("echo 'Traceback (most recent call last)' >&2; echo 'OSError: disk' >&2; exit 1");
    assert_eq!(done.code, Some(2));
    assert!(done.err.ends_with("OSError: disk\n"), "{}", done.err);
    let done = run("kill -9 $$");
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("signal: 9"), "{}", done.err);
}

#[test]
fn what_a_script_says_cannot_confuse() {
    // No text, and then more than fits into pipes that nobody reads.
    let done =
        run("printf 'garbage \\377\\n\\n  s  x  \\n'; yes | head -c 300000; head -c 3000000 /dev/zero >&2");
    assert_eq!(done.code, Some(0), "{}", done.err);
}

#[test]
fn what_cannot_be_installed_is_explained() {
    let place = place("");
    let done: Done = command(&place).env("PIP_CODE", "1").output().unwrap().into();
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("cannot install the CoppeliaSim client library"), "{}", done.err);
    assert!(done.err.contains("needs network access to PyPI"), "{}", done.err);
    assert_eq!(cached(&place), ["lock"], "nothing half made is left");
}

#[test]
fn where_python_has_no_pip_the_environment_gets_one() {
    let place = place("");
    let done: Done = command(&place).env("BASE_PIP_CODE", "1").output().unwrap().into();
    assert_eq!(done.err, PREPARING);
    let environment = cached(&place).into_iter().find(|name| name.starts_with("venv-")).unwrap();
    assert!(place.path(&format!("cache/pydslrep/{environment}/bin/python-has-pip")).exists());

    let place = self::place("");
    let codes = [("BASE_PIP_CODE", "1"), ("ENSUREPIP_CODE", "1")];
    let done: Done = command(&place).envs(codes).output().unwrap().into();
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("cannot create a virtual environment"), "{}", done.err);
    assert!(done.err.contains("needs its modules venv and ensurepip"), "{}", done.err);
    assert_eq!(cached(&place), ["lock"], "nothing half made is left");
}

/// The names in the cache folder.
fn cached(place: &Place) -> Vec<String> {
    let entries = fs::read_dir(place.path("cache/pydslrep")).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// A first run where the package index behaves like this.
fn first_run(index: &str) -> (Place, Done) {
    let place = place("");
    place.write("index", index);
    let done = command(&place).env("INDEX", place.path("index")).output().unwrap().into();
    (place, done)
}

#[test]
fn without_network_nothing_is_begun() {
    let (place, done) = first_run("echo 'pypi.org cannot be reached: no such name'; exit 3");
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    expect![[r#"
        error: cannot install the CoppeliaSim client library: pypi.org cannot be reached: no such name
         |
         = help: the first run needs network access to PyPI; behind a proxy or with a mirror, set HTTPS_PROXY or PIP_INDEX_URL
    "#]].assert_eq(&done.err);
    assert_eq!(cached(&place), ["lock"]);
}

#[test]
fn an_index_that_hangs_is_not_waited_for() {
    let (_, done) = first_run("exec tail -f /dev/null");
    assert_eq!(done.code, Some(2));
    let reason = "cannot install the CoppeliaSim client library: the package index does not answer";
    assert!(done.err.contains(reason), "{}", done.err);
}

#[test]
fn what_cannot_be_asked_is_left_to_pip() {
    let (_, done) = first_run("echo 'no module named asyncio' >&2; exit 1");
    assert_eq!(done.code, Some(0), "{}", done.err);
}

#[test]
fn an_interrupt_stops_the_script() {
    // The script reports that it runs, and then how it ended. Shells run traps while they `wait`; in any other
    // call the signal and the call race.
    let running = Running::start(
        "tail -f /dev/null > /dev/null 2>&1 & trap 'kill $!; echo stopped > end; exit 130' INT; echo > started; wait",
    );
    running.interrupt();
    assert_eq!(running.event(), Event::Ended(Some(130)));
    assert_eq!(running.place.read("end"), "stopped\n");
}

#[test]
fn further_interrupts_let_it_stop_its_robots() {
    for signal in [Signal::INT, Signal::QUIT, Signal::HUP, Signal::TERM] {
        let running = Running::start(
            "mkfifo go; tail -f /dev/null > /dev/null 2>&1 & \
             trap 'trap \"\" INT; kill $!; echo > asked; read line < go; echo stopped > end; exit 130' INT; \
             mkfifo asked; echo > started; wait",
        );
        running.signal(signal);
        // It is stopping now, and hears of nothing else.
        fs::read(running.place.path("asked")).unwrap();
        for _ in 0..3 {
            running.signal(signal);
        }
        running.place.write("go", "\n");
        assert_eq!(running.event(), Event::Ended(Some(130)));
        assert_eq!(running.place.read("end"), "stopped\n");
    }
}

#[test]
fn a_script_says_at_once_why_it_waits() {
    let note = tell(&RunEvent::Note { text: "it waits".to_owned() });
    let warning = tell(&RunEvent::Warning { text: "it is old".to_owned(), help: None });
    let failed = failed(FailureClass::Simulator, "no reply");
    let place = place(&format!("{note}; {warning}; {failed}; exit 2"));
    let done: Done = command(&place).arg("--no-progress").output().unwrap().into();
    let printed = "note: it waits\nwarning: it is old\nerror: no reply\n";
    assert_eq!((done.code, done.err.as_str()), (Some(2), printed));
}

#[test]
fn whoever_started_a_run_need_not_live_to_end_it() {
    let mut running = Running::start_with(
        &["--until-input-ends"],
        "tail -f /dev/null > /dev/null 2>&1 & trap 'kill $!; echo stopped > end; exit 130' INT; echo > started; wait",
    );
    drop(running.input.take());
    assert_eq!(running.event(), Event::Ended(Some(130)));
    assert_eq!(running.place.read("end"), "stopped\n");
}

#[test]
fn a_script_that_does_not_listen_is_ended() {
    let running = Running::start("trap '' INT; echo > started; exec tail -f /dev/null");
    running.interrupt();
    assert_eq!(running.event(), Event::Ended(Some(130)));
}

/// A run whose script has begun, watched by threads that report its events.
struct Running {
    place: Place,
    pid: rustix::process::Pid,
    input: Option<ChildStdin>,
    events: Receiver<Event>,
}

#[derive(Debug, PartialEq)]
enum Event {
    Started,
    Ended(Option<i32>),
}

impl Running {
    fn start(behaviour: &str) -> Self {
        Self::start_with(&[], behaviour)
    }

    fn start_with(arguments: &[&str], behaviour: &str) -> Self {
        let place = place(&format!("cd \"$(dirname \"$BEHAVIOUR\")\"; {behaviour}"));
        assert!(Command::new("mkfifo").arg(place.path("started")).status().unwrap().success());
        let mut child = command(&place).args(arguments).stdin(Stdio::piped()).spawn().unwrap();
        let input = child.stdin.take();
        let pid = rustix::process::Pid::from_child(&child);
        let (tell, events) = channel();
        let (tell_of_start, started) = (tell.clone(), place.path("started"));
        // To its end: while the script still opens the pipe, a signal would make that fail.
        std::thread::spawn(move || fs::read(started).map(|_| tell_of_start.send(Event::Started)));
        std::thread::spawn(move || {
            tell.send(Event::Ended(child.wait_with_output().unwrap().status.code())).unwrap();
        });
        let running = Self { place, pid, input, events };
        assert_eq!(running.event(), Event::Started);
        running
    }

    fn interrupt(&self) {
        self.signal(Signal::INT);
    }

    fn signal(&self, signal: Signal) {
        rustix::process::kill_process(self.pid, signal).unwrap();
    }

    fn event(&self) -> Event {
        self.events.recv().unwrap()
    }
}
