//! `pydslrep.toml`.

use expect_test::expect;
use serde_json::Value;

use crate::process::{Done, Place, paper};

/// A program with a hint, a warning and an error, which no script depends on.
const PROBLEMS: &str = "wheel l with radius 4\nwheel r with radius 4\nwheel x with radius 0\n\
    robot a type tw with port 23000 has { l r } wheels\nmovement m of a { move 0 meters }\n\
    environment yard has { a } robots with { m } moves\n";

const FINE: &str = "wheel l with radius 4\nwheel r with radius 4\n\
    robot a type tw with port 23000 has { l r } wheels\nmovement m of a { move 1 meters }\n";

fn fine(environment: &str) -> String {
    format!("{FINE}environment {environment} has {{ a }} robots with {{ m }} moves\n")
}

/// Codes with severities, as `check` reports them.
fn reported(place: &Place, arguments: &[&str]) -> Vec<String> {
    let done = place.run(&[&["check", "--format", "json"], arguments].concat());
    let problems: Vec<Value> = serde_json::from_str(&done.out).unwrap_or_else(|_| panic!("{}", done.err));
    let word = |problem: &Value, key: &str| problem[key].as_str().unwrap().to_owned();
    problems.iter().map(|problem| word(problem, "code") + " " + &word(problem, "severity")).collect()
}

#[test]
fn the_nearest_file_counts_and_options_win_over_it() {
    let place = Place::with("a/x.pyr", PROBLEMS);
    place.write("b/c/y.pyr", PROBLEMS);
    assert_eq!(
        reported(&place, &["a"]),
        ["unused-declaration hint", "invalid-radius error", "zero-distance warning"]
    );
    place.write("pydslrep.toml", "[severity]\nzero-distance = \"error\"\n");
    place.write("b/pydslrep.toml", "[severity]\ninvalid-radius = \"hint\"\nunused-declaration = \"off\"\n");
    let both = [
        "unused-declaration hint",
        "invalid-radius error",
        "zero-distance error",
        "invalid-radius hint",
        "zero-distance warning",
    ];
    assert_eq!(reported(&place, &[]), both, "each program has its own");
    assert_eq!(
        reported(
            &place,
            &["--severity", "zero-distance=off", "--severity", "unused-declaration=warning", "b"]
        ),
        ["unused-declaration warning", "invalid-radius hint"]
    );
    assert_eq!(place.run(&["check", "b"]).code, Some(0));
    assert_eq!(place.run(&["check", "a"]).code, Some(1));
    let input = place.run_with(&["check", "-"], PROBLEMS.as_bytes());
    assert!(input.out.contains("error[zero-distance]"), "{}", input.out);
}

#[test]
fn mistakes_in_it_are_shown_and_nothing_is_done() {
    let place = Place::with("x.pyr", fine("yard"));
    place.write(
        "pydslrep.toml",
        "\u{feff}# 机器人\r\noutput = \"out\"\r\nsevrity = { }\r\n\r\n[severity]\r\nwheel-count = \"warn\"\r\n",
    );
    let done = place.run(&["check"]);
    expect![[r#"
        error: there is no setting `sevrity`
         --> pydslrep.toml:3:1
          |
        3 | sevrity = { } 
          | ^^^^^^^
          |
          = help: did you mean `severity`?

        error: `severity.wheel-count` cannot be `warn`
         --> pydslrep.toml:6:15
          |
        6 | wheel-count = "warn" 
          |               ^^^^^^
          |
          = help: did you mean `warning`?

    "#]]
    .assert_eq(&done.err);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    for command in ["build", "plan", "stats", "run"] {
        let done = place.run(&[command, "x.pyr"]);
        assert_eq!((done.code, done.out.as_str()), (Some(2), ""), "{command}");
        assert!(done.err.contains("did you mean `severity`?"), "{command} {}", done.err);
    }
    assert!(!place.path("out").exists() && !place.path("yard.py").exists());
}

#[test]
fn no_toml_and_no_text_are_told_with_their_place() {
    let place = Place::with("x.pyr", fine("yard"));
    place.write("pydslrep.toml", "output = scripts");
    let done = place.run(&["check"]);
    expect![[r#"
        error: `scripts` is not a value
         --> pydslrep.toml:1:10
          |
        1 | output = scripts
          |          ^^^^^^^
          |
          = help: strings are in quotes: `"scripts"`

    "#]]
    .assert_eq(&done.err);
    assert_eq!(done.code, Some(2));
    place.write("pydslrep.toml", b"\xff");
    let done = place.run(&["check"]);
    assert!(done.err.contains("cannot read pydslrep.toml: not valid UTF-8"), "{}", done.err);
    assert_eq!(done.code, Some(2));
}

#[test]
fn scripts_go_where_it_says() {
    let place = Place::with("a/b/x.pyr", fine("yard"));
    place.write("a/pydslrep.toml", "output = \"out/py\"\n");
    place.write("c/y.pyr", fine("hall"));
    assert_eq!(place.run(&["build"]).code, Some(0));
    assert!(place.read("a/out/py/yard.py").contains("yard"));
    assert!(place.path("c/hall.py").exists(), "a program of no project has its script beside it");
    place.write("pydslrep.toml", "output = \"all\"\n");
    let done = place.run_with(&["build", "-"], fine("input").as_bytes());
    assert_eq!((done.code, place.path("all/input.py").exists()), (Some(0), true), "{}", done.err);
    assert_eq!(place.run(&["build", "a", "-o", "here"]).code, Some(0));
    assert!(place.path("here/yard.py").exists(), "the option wins");
}

#[test]
fn scripts_are_for_the_target_that_it_says() {
    let place = Place::with("x.pyr", fine("yard"));
    let is_for_vrep = |options: &[&str]| {
        assert_eq!(place.run(&[&["build"], options].concat()).code, Some(0));
        place.read("yard.py").contains("in V-REP;")
    };
    assert!(!is_for_vrep(&[]) && is_for_vrep(&["--target", "vrep"]));
    place.write("pydslrep.toml", "target = \"vrep\"\n");
    assert!(is_for_vrep(&[]) && !is_for_vrep(&["--target", "coppeliasim"]));
    let done = place.run(&["build", "--target", "v-rep"]);
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("coppeliasim, vrep"), "{}", done.err);
}

#[test]
fn each_command_takes_an_edition() {
    let place = Place::with("x.pyr", fine("yard").replace("move 1 meters", "wait 1 seconds"));
    for command in ["check", "build", "plan", "run"] {
        let done = place.run(&[command, "x.pyr", "--edition", "article"]);
        assert_eq!(done.code, Some(1), "{command} {}", done.err);
        let printed = done.out + &done.err;
        assert!(
            printed.contains("error[not-in-article]: the article does not have `wait`"),
            "{command} {printed}"
        );
        let done = place.run(&[command, "x.pyr", "--edition", "old"]);
        assert_eq!(done.code, Some(2), "{command}");
    }
    assert!(!place.path("yard.py").exists());
    assert_eq!(reported(&place, &[]), Vec::<String>::new());
    place.write("pydslrep.toml", "edition = \"article\"\n");
    assert_eq!(reported(&place, &[]), ["not-in-article error"]);
    assert_eq!(reported(&place, &["--edition", "current"]), Vec::<String>::new(), "the option wins");
}

#[test]
fn a_missing_client_of_vrep_is_explained() {
    let place = Place::with("x.pyr", fine("yard"));
    place.write("pydslrep.toml", "target = \"vrep\"\n");
    // Only a script's own folder and Python's path count.
    place.write("elsewhere/sim.py", "");
    let done: Done = place.command(&["run", "x.pyr"]).env_remove("PYTHONPATH").output().unwrap().into();
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("neither beside the program nor on Python's path"), "{}", done.err);
    assert!(done.err.contains("copy sim.py, simConst.py and remoteApi"), "{}", done.err);
    // Whatever is called so is found, and the script says what is wrong with it.
    place.write("sim.py", "raise NameError('no library')");
    let done: Done = place.command(&["run", "x.pyr"]).env_remove("PYTHONPATH").output().unwrap().into();
    assert_eq!(done.code, Some(2));
    assert!(done.err.contains("error: sim.py cannot be loaded: no library."), "{}", done.err);
}

#[test]
fn what_keeps_a_script_from_being_made_is_shown_as_an_error() {
    let place = Place::with("x.pyr", fine("yard").replace("{ l r } wheels", "{ l } wheels"));
    place.write("pydslrep.toml", "[severity]\nwheel-count = \"off\"\nunused-declaration = \"off\"\n");
    assert_eq!(reported(&place, &[]), Vec::<String>::new());
    let done = place.run(&["build"]);
    assert!(done.err.starts_with("error[wheel-count]"), "{}", done.err);
    assert!(done.err.contains("\n1 error in 1 file.\n"), "{}", done.err);
    assert_eq!(done.code, Some(1));
}

#[test]
fn programs_without_one_are_as_ever() {
    let place = Place::new();
    let usual = ["wheel-kind-mismatch warning", "port-of-other-target hint"];
    assert_eq!(reported(&place, &[&paper("table4_holonomic")]), usual);
}

#[test]
fn some_problems_are_those_of_a_target() {
    let program = fine("yard").replace("{ a }", "{ a b }")
        + "robot b with port 23000 has { l r } wheels\nmovement n of b { move 1 meters }\n";
    let place = Place::with("x.pyr", program.replace("{ m }", "{ m n }"));
    assert_eq!(reported(&place, &[]), Vec::<String>::new());
    place.write("pydslrep.toml", "target = \"vrep\"\n");
    assert_eq!(reported(&place, &[]), ["duplicate-port warning"]);
}
