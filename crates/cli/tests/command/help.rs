//! `--help` in terminals of different widths.

use std::collections::BTreeSet;

use crate::process::{Done, Place};

const WIDTHS: [usize; 3] = [60, 80, 120];

/// Every command, from the lists of commands in the help itself.
fn commands(place: &Place) -> BTreeSet<Vec<String>> {
    let mut found = BTreeSet::from([Vec::new()]);
    let mut unread = vec![Vec::new()];
    while let Some(command) = unread.pop() {
        let help = help(place, &command, "--help", 120);
        for name in section(&help, "Commands:").iter().filter_map(|line| name_in(line)) {
            let below: Vec<String> = command.iter().cloned().chain([name.to_owned()]).collect();
            if name != "help" && found.insert(below.clone()) {
                unread.push(below);
            }
        }
    }
    assert!(found.len() > 15, "{found:?}");
    found
}

fn name_in(line: &str) -> Option<&str> {
    let rest = line.strip_prefix("  ")?;
    if rest.starts_with(' ') { None } else { rest.split_whitespace().next() }
}

fn help(place: &Place, command: &[String], option: &str, columns: usize) -> String {
    let arguments: Vec<&str> = command.iter().map(String::as_str).chain([option]).collect();
    let output = place.command(&arguments).env("COLUMNS", columns.to_string()).output().unwrap();
    let done = Done::from(output);
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""), "{command:?}");
    done.out
}

/// The lines below a heading, up to the next blank one.
fn section<'a>(help: &'a str, heading: &str) -> Vec<&'a str> {
    help.lines().skip_while(|line| *line != heading).skip(1).take_while(|line| !line.is_empty()).collect()
}

#[test]
fn no_line_is_wider_than_the_terminal() {
    let place = Place::new();
    for command in commands(&place) {
        for (option, columns) in
            ["-h", "--help"].into_iter().flat_map(|option| WIDTHS.map(|columns| (option, columns)))
        {
            let help = help(&place, &command, option, columns);
            let wide: Vec<&str> =
                help.lines().filter(|line| line.chars().count() > columns.min(100)).collect();
            assert!(wide.is_empty(), "pydslrep {command:?} {option} at {columns} columns: {wide:#?}");
        }
    }
}

/// An example is one command, indented by two blanks; its continuation and its explanation are indented further.
#[test]
fn an_example_looks_like_one_command_at_any_width() {
    let place = Place::new();
    for command in commands(&place) {
        let expected = examples(&help(&place, &command, "--help", 120));
        for columns in WIDTHS {
            let help = help(&place, &command, "--help", columns);
            assert_eq!(examples(&help), expected, "pydslrep {command:?} at {columns} columns: {help}");
        }
    }
}

/// The commands of the examples, without explanations; broken ones in one piece.
fn examples(help: &str) -> Vec<String> {
    let lines = section(help, "Examples:");
    let mut found: Vec<String> = Vec::new();
    let mut is_broken = false;
    for line in lines {
        let text = line.trim_start();
        let command = text.split("   ").next().unwrap_or_default().trim_end();
        let part = command.strip_suffix('\\').unwrap_or(command);
        match (line.len() - text.len(), is_broken) {
            (2, _) => found.push(part.to_owned()),
            (_, true) => found.last_mut().unwrap().push_str(part),
            (indent, false) => assert!(indent > 2, "{line:?} is no example and no explanation: {help}"),
        }
        is_broken = command.ends_with('\\');
    }
    for example in &found {
        assert!(example.starts_with("pydslrep ") || example.starts_with("python3 "), "{example:?}: {help}");
    }
    found
}

/// A paragraph is broken once: only its last line is short of the next word.
#[test]
fn a_note_is_wrapped_once() {
    let place = Place::new();
    for command in commands(&place) {
        for columns in WIDTHS {
            let help = help(&place, &command, "--help", columns);
            let notes: Vec<&str> = help.lines().skip_while(|line| *line != "Examples:").collect();
            for pair in notes.windows(2) {
                let [line, next] = [pair[0], pair[1]];
                let is_text = |line: &str| !line.is_empty() && !line.starts_with(' ') && line != "Examples:";
                if !is_text(line) || !is_text(next) {
                    continue;
                }
                let word = next.split(' ').next().unwrap_or_default();
                let fits = line.chars().count() + 1 + word.chars().count() <= columns.min(100);
                assert!(!fits, "pydslrep {command:?} at {columns} columns: `{word}` fits after `{line}`");
            }
        }
    }
}
