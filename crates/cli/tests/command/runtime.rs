//! The package that scripts import, where `pydslrep build` writes it.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use expect_test::expect;

use crate::process::{Done, Place};

const PROGRAM: &str = "\
wheel a with radius 4 wheel b with radius 4 robot r with port 1 has { a b } wheels
movement m of r { move 1 meters }
environment one has { r } robots with { m } moves
environment two has { r } robots with { m m } moves
";

/// Where the package is.
const HOME: &str = "pydslrep_runtime";
const RECORD: &str = "pydslrep_runtime/_written.json";
const PART: &str = "pydslrep_runtime/pose.py";

fn place() -> Place {
    Place::with("x.pyr", PROGRAM)
}

/// Everything that `build` says of the package.
fn said(done: &Done) -> String {
    assert_eq!(done.code, Some(0), "{}", done.err);
    let lines = done.out.lines().chain(done.err.lines());
    let of_package = lines.filter(|line| line.contains(HOME) || line.contains("help"));
    of_package.flat_map(|line| [line, "\n"]).collect()
}

#[test]
fn it_is_written_once_for_all_scripts_of_a_folder() {
    let place = place();
    let done = place.run(&["build"]);
    expect![[r#"
        pydslrep_runtime written (version 0.2.0)
    "#]]
    .assert_eq(&said(&done));
    assert!(place.path("one.py").exists() && place.path("two.py").exists() && place.path(PART).exists());
    assert_eq!(said(&place.run(&["build"])), "", "it is as it was");
    assert_eq!(said(&place.run(&["build", "-o", "out"])), "out/pydslrep_runtime written (version 0.2.0)\n");
}

#[test]
fn it_is_written_as_it_is_in_the_repository() {
    let place = place();
    place.run(&["build"]);
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/pydslrep_runtime");
    let mut folders = vec![source.clone()];
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        for path in folder.read_dir().unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() && !path.ends_with("__pycache__") {
                folders.push(path);
            } else if path.is_file() {
                let name = path.strip_prefix(&source).unwrap();
                assert_eq!(
                    fs::read(&path).unwrap(),
                    fs::read(place.path(HOME).join(name)).unwrap(),
                    "{}",
                    name.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 20, "{count}");
}

#[test]
fn an_unchanged_one_is_left_alone() {
    let place = place();
    place.run(&["build"]);
    fs::set_permissions(place.path(PART), fs::Permissions::from_mode(0o640)).unwrap();
    place.run(&["build"]);
    let mode = fs::metadata(place.path(PART)).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640, "it is the same file");
}

#[test]
fn a_changed_one_is_kept_and_that_is_said() {
    let place = place();
    place.run(&["build"]);
    place.write(PART, "mine = 1\n");
    let done = place.run(&["build"]);
    assert_eq!(done.code, Some(0));
    expect![[r#"
        warning: pydslrep_runtime is not replaced: pose.py in it was changed
         |
         = help: delete it to have version 0.2.0 written, or set `write-runtime = false` in pydslrep.toml to keep it
    "#]]
    .assert_eq(&done.err);
    assert_eq!(place.read(PART), "mine = 1\n");
    fs::remove_dir_all(place.path(HOME)).unwrap();
    assert_eq!(said(&place.run(&["build"])), "pydslrep_runtime written (version 0.2.0)\n");

    fs::remove_file(place.path(RECORD)).unwrap();
    place.write(PART, "mine = 1\n");
    assert!(said(&place.run(&["build"])).contains("is not replaced: PyDSLRep did not write it"));
}

#[test]
fn an_older_one_is_replaced() {
    let place = place();
    place.run(&["build"]);
    let original = place.read(PART);
    let record = place.read(RECORD);
    place.write(RECORD, record.replace("\"version\": \"0.2.0\"", "\"version\": \"0.0.9\""));
    place.write("pydslrep_runtime/notes.txt", "mine");
    expect![[r#"
        pydslrep_runtime updated from version 0.0.9 to 0.2.0
    "#]]
    .assert_eq(&said(&place.run(&["build"])));
    assert_eq!((place.read(RECORD), place.read(PART)), (record, original));
    assert_eq!(place.read("pydslrep_runtime/notes.txt"), "mine", "what somebody added stays");
    assert!(
        fs::read_dir(place.path(""))
            .unwrap()
            .all(|entry| { !entry.unwrap().file_name().to_string_lossy().starts_with(".pydslrep-") })
    );
}

#[test]
fn it_is_not_written_where_nobody_wants_it() {
    let place = place();
    assert_eq!(said(&place.run(&["build", "--no-runtime"])), "");
    place.write("pydslrep.toml", "write-runtime = false\n");
    assert_eq!(said(&place.run(&["build"])), "");
    assert!(place.path("one.py").exists() && !place.path(HOME).exists());
}

/// A folder with a Python that gives this answer.
fn python(answer: &str) -> Place {
    let place = Place::with("python3", format!("#!/bin/sh\necho \"$*\" >> \"$0.asked\"\n{answer}\n"));
    fs::set_permissions(place.path("python3"), fs::Permissions::from_mode(0o755)).unwrap();
    place
}

#[test]
fn an_installed_one_is_enough() {
    let (place, python) = (place(), python("echo True"));
    place.write("deeper/y.pyr", PROGRAM);
    let build = || -> Done {
        place
            .command(&["build"])
            .env_remove("VIRTUAL_ENV")
            .env("PATH", python.path(""))
            .output()
            .unwrap()
            .into()
    };
    let done = build();
    assert_eq!(done.code, Some(0), "{}", done.err);
    expect![[r#"
        pydslrep_runtime is installed in your Python, so no folder is written
    "#]]
    .assert_eq(&said(&done));
    assert!(!place.path(HOME).exists() && !place.path("deeper").join(HOME).exists());
    let asked = python.read("python3.asked");
    assert!(asked.starts_with("-I -c ") && asked.matches("-I -c ").count() == 1, "{asked}");
}

#[test]
fn a_python_that_cannot_answer_has_none() {
    for answer in ["exit 1", "echo False", "exec >&-; exec tail -f /dev/null"] {
        let (place, python) = (place(), python(answer));
        let mut command = place.command(&["build"]);
        let path = format!("{}:/usr/bin:/bin", python.path("").display());
        let done: Done = command.env_remove("VIRTUAL_ENV").env("PATH", path).output().unwrap().into();
        assert_eq!(said(&done), "pydslrep_runtime written (version 0.2.0)\n", "{answer}");
    }
}
