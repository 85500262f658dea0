//! `pydslrep stats`.

use serde_json::{Value, json};

use crate::process::{Place, paper};

/// Two environments and lines that do not count; what is put in place of `@` decides about the second.
const TWO: &str = "\
// Comments
/* of both
   kinds */

import \"parts.pyr\"
robot r with port 1 has { a b } wheels
movement m of r { move 1 meters } // at the end
environment one has { r } robots with { m } moves
environment two has { r } robots with { @ } moves
";

fn place(movement: &str) -> Place {
    let place = Place::with("x.pyr", TWO.replace('@', movement));
    place.write("parts.pyr", "wheel a with radius 4 // left\n\nwheel b with radius 4");
    place
}

#[test]
fn the_articles_program_in_a_table() {
    let done = Place::new().run(&["stats", &paper("table2_two_wheels")]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    let rows: Vec<Vec<&str>> = done.out.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(rows[0], ["environment", "lines", "of", "program", "lines", "of", "Python", "saved"]);
    let [name, "11", python, saved, "%"] = rows[2][..] else { panic!("{}", done.out) };
    let python: f64 = python.parse().unwrap();
    assert_eq!((name, saved), ("area_1", format!("{:.1}", 100.0 - 1100.0 / python).as_str()));
    assert_eq!((rows.len(), rows[3].len()), (5, 0), "a total of one would say the same again");
    let [_, "which", "scripts", "import,", "has", runtime, "more", ..] = rows[4][..] else {
        panic!("{}", done.out)
    };
    assert!(runtime.parse::<f64>().unwrap() > 20.0 * python, "the package is counted apart: {}", done.out);
}

#[test]
fn every_environment_and_their_total() {
    let place = place("m");
    let done = place.run(&["stats", "x.pyr", "--json"]);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    let stats: Value = serde_json::from_str(&done.out).unwrap();
    let environments = stats["environments"].as_array().unwrap();
    let names: Vec<&Value> = environments.iter().map(|script| &script["environment"]).collect();
    assert_eq!(names, ["one", "two"]);
    assert!(environments.iter().all(|script| script["program"] == json!(7)), "imported lines count: {stats}");
    let python: u64 = environments.iter().map(|script| script["python"].as_u64().unwrap()).sum();
    assert_eq!((&stats["total"]["program"], &stats["total"]["python"]), (&json!(7), &json!(python)));
    let table = place.run(&["stats", "x.pyr"]).out;
    let total: Vec<&str> = table.lines().nth(4).unwrap().split_whitespace().collect();
    assert!(table.contains(&format!("has {} more lines of Python", stats["runtime"])), "{table}");
    assert_eq!(total[..3], ["total", "7", &python.to_string()]);
}

#[test]
fn build_says_the_same() {
    let place = place("m");
    let stats: Value = serde_json::from_str(&place.run(&["stats", "x.pyr", "--json"]).out).unwrap();
    let built = place.run(&["build", "x.pyr"]).out;
    let row: Vec<&str> =
        built.lines().find(|line| line.contains("two.py")).unwrap().split_whitespace().collect();
    assert_eq!(row[2..], ["7", &stats["environments"][1]["python"].to_string()]);
    let docstrings = place.read("two.py").lines().filter(|line| line.trim().starts_with("\"\"\"")).count();
    assert!(docstrings > 0, "there is something not to count");
}

#[test]
fn a_broken_environment_is_left_out() {
    let done = place("nothing").run(&["stats", "x.pyr"]);
    assert_eq!(done.code, Some(1));
    assert!(done.err.contains("`two` is skipped") && done.out.contains("one"), "{}", done.err);
}

#[test]
fn without_an_environment_there_is_nothing_to_compare() {
    let done = Place::with("x.pyr", "sensor s").run(&["stats", "x.pyr"]);
    assert_eq!((done.code, done.out.as_str()), (Some(2), ""));
    assert!(done.err.contains("x.pyr has no environment"), "{}", done.err);
}
