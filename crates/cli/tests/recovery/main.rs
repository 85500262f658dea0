//! Messages for broken programs: every case in `tests/recovery` is checked by the command and compared.
//! `UPDATE_EXPECT=1` writes what the command says now; read it aloud before it is kept.

#![allow(clippy::unwrap_used, clippy::panic)] // what the tests share is test code too

mod case;
mod command;
mod cut;

use std::collections::BTreeMap;
use std::fs;

use expect_test::expect_file;

use crate::case::Group;
use crate::command::{Folder, Problem};

const GROUPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/recovery");

fn groups() -> Vec<(String, Group)> {
    let entries = fs::read_dir(GROUPS).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = entries
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .filter(|path| path.file_stem().is_some_and(|stem| stem != "README"))
        .collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| Group::read(&fs::read_to_string(path).unwrap());
    paths.iter().map(|path| (path.to_str().unwrap().to_owned(), read(path))).collect()
}

/// All cases of a group in one folder, each in a file of its own.
fn folder(group: &Group) -> (Folder, Vec<String>) {
    let folder = Folder::new();
    // The files that imports name.
    for part in ["parts.pyr", "more.pyr"] {
        folder.write(part, "");
    }
    let name = |number: usize| format!("{number:03}.pyr");
    let cases = group.cases().enumerate();
    let names = cases.map(|(number, case)| {
        folder.write(&name(number), &group.program(case));
        name(number)
    });
    let names = names.collect();
    (folder, names)
}

#[test]
fn every_message_is_the_reviewed_one() {
    for (path, group) in groups() {
        let (folder, names) = folder(&group);
        let mut shown = folder.shown();
        let messages: Vec<String> = names
            .iter()
            .map(|name| shown.remove(name).unwrap_or_else(|| "No problems.\n".to_owned()))
            .collect();
        expect_file![path].assert_eq(&group.with_messages(&messages));
    }
}

#[test]
fn each_mistake_is_one_problem() {
    let mut wrong = String::new();
    for (path, group) in groups() {
        let (folder, names) = folder(&group);
        let problems = by_file(folder.problems(&[]));
        for (case, name) in group.cases().zip(names) {
            let found = problems.get(&name).map_or(0, Vec::len);
            if found != case.problems() {
                wrong += &format!("{path}: \"{}\" has {found} problems\n", case.title);
            }
        }
    }
    assert!(wrong.is_empty(), "a title may end with (2 problems) where there are so many\n{wrong}");
}

/// After all safe fixes, the fixed problems are gone and no others have appeared.
#[test]
fn safe_fixes_leave_nothing_behind() {
    let (mut fixed, mut wrong) = (0, String::new());
    for (path, group) in groups() {
        let (folder, names) = folder(&group);
        let mut shown = folder.shown();
        let before = by_file(folder.problems(&[]));
        let after = by_file(folder.problems(&["--fix"]));
        for (case, name) in group.cases().zip(names) {
            let problems = |files: &Problems| files.get(&name).cloned().unwrap_or_default();
            let message = shown.remove(&name).unwrap_or_default();
            let safe = message.lines().filter(|line| line.starts_with("fix: ")).count();
            if let Err(complaint) = check_fixed(problems(&before), &problems(&after), safe) {
                wrong += &format!("{path}: \"{}\": {complaint}\n", case.title);
            }
            fixed += safe;
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(fixed > 100, "only {fixed} fixes are tried");
}

fn check_fixed(mut before: Vec<Problem>, after: &[Problem], safe: usize) -> Result<(), String> {
    // Hints may come: there is more to say of a program that is understood.
    let counts = |problem: &&Problem| ["error", "warning"].contains(&&*problem.severity);
    before.retain(|problem| counts(&problem));
    let after: Vec<&Problem> = after.iter().filter(counts).collect();
    let count = before.len();
    for problem in &after {
        match before.iter().position(|other| other.code == problem.code) {
            Some(known) => drop(before.remove(known)),
            None => return Err(format!("`--fix` brings {problem:?}")),
        }
    }
    if after.len() + safe > count { Err(format!("`--fix` leaves {after:?}")) } else { Ok(()) }
}

type Problems = BTreeMap<String, Vec<Problem>>;

fn by_file(problems: Vec<(String, Problem)>) -> Problems {
    let mut files = Problems::new();
    for (file, problem) in problems {
        files.entry(file).or_default().push(problem);
    }
    files
}
