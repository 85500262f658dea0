//! `pydslrep sim`.

use std::io::{BufRead, BufReader};

use expect_test::{Expect, expect};

use crate::process::Place;

/// Checks the output up to its last line, then ends the command as Ctrl+C does.
fn said(program: &str, arguments: &[&str], expected: &Expect) {
    let place = Place::with("my programs/x.pyr", program);
    let mut child = place.command(&[&["sim"], arguments].concat()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap);
    let mut text = String::new();
    // The last line is the command that drives.
    for line in lines.by_ref() {
        text += &(line.clone() + "\n");
        if line.contains("python3") {
            break;
        }
    }
    rustix::process::kill_process(rustix::process::Pid::from_child(&child), rustix::process::Signal::INT)
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    expected.assert_eq(&text);
}

const PROGRAM: &str = "\
wheel a with radius 4 wheel b with radius 4 robot r with port 18311 has { a b } wheels
movement m of r { move 10 centimeters } environment yard has { r } robots with { m } moves";

#[test]
fn it_says_that_it_is_ready_and_what_to_do() {
    said(
        PROGRAM,
        &["my programs/x.pyr"],
        &expect![[r#"
        robot  address    port
        ────────────────────────
        r      127.0.0.1  18311

        Ready. Press Ctrl+C to stop.
        To drive in it, run this in another terminal:

            pydslrep build "my programs/x.pyr"
            python3 "my programs/yard.py"
    "#]],
    );
}

#[test]
fn a_script_of_another_machine_is_told_where_to_go() {
    let elsewhere =
        PROGRAM.replace("18311", "18312").replace("yard has", "yard with ip lab has") + " ip lab 10.0.0.7";
    said(
        &elsewhere,
        &["my programs/x.pyr", "--listen", "0.0.0.0"],
        &expect![[r#"
        robot  address  port
        ──────────────────────
        r      0.0.0.0  18312

        Ready. Press Ctrl+C to stop.
        To drive in it, run this in another terminal:

            pydslrep build "my programs/x.pyr"
            python3 "my programs/yard.py" --host 127.0.0.1
    "#]],
    );
}
