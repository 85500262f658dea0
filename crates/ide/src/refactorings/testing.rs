//! Shared checks for the tests of refactorings.

use std::fmt::Write as _;

use expect_test::Expect;
use pydslrep_analysis::{Database, Edition};
use pydslrep_syntax::Span;

use super::refactorings;
use crate::fixture::{PARTS, applied};

/// The refactorings in the actions of a movement, with the lines they change.
#[track_caller]
pub(super) fn check(actions: &str, expected: &Expect) {
    check_whole(&program(actions), expected);
}

/// Those with a word in their titles, in the actions of a movement.
#[track_caller]
pub(super) fn check_only(word: &str, actions: &str, expected: &Expect) {
    check_only_whole(word, &program(actions), expected);
}

/// The refactorings in a complete program; two `$0` mark a selection.
#[track_caller]
pub(super) fn check_whole(fixture: &str, expected: &Expect) {
    check_only_whole("", fixture, expected);
}

/// Those with a word in their titles.
#[track_caller]
pub(super) fn check_only_whole(word: &str, fixture: &str, expected: &Expect) {
    expected.assert_eq(&report(&[], fixture, word, Edition::Current));
}

/// Those with a word in their titles, in a program that imports others, each `(path, text)`.
#[track_caller]
pub(super) fn check_importing(word: &str, others: &[(&str, &str)], fixture: &str, expected: &Expect) {
    expected.assert_eq(&report(others, fixture, word, Edition::Current));
}

/// The titles in the article's edition, in the actions of a movement.
#[track_caller]
pub(super) fn check_titles_of_article(actions: &str, expected: &Expect) {
    let report = report(&[], &program(actions), "", Edition::Article);
    let titles = report.lines().filter(|line| !line.starts_with(' '));
    expected.assert_eq(&titles.fold(String::new(), |titles, title| titles + title + "\n"));
}

fn program(actions: &str) -> String {
    format!(
        "{PARTS}movement tour of rover {{\n{actions}\n}}\n\
         environment yard has {{ rover }} robots with {{ tour }} moves\n"
    )
}

fn report(others: &[(&str, &str)], fixture: &str, word: &str, edition: Edition) -> String {
    let start = fixture.find("$0").expect("the fixture has no `$0`");
    let text = fixture.replacen("$0", "", 1);
    let end = text.find("$0").unwrap_or(start);
    let text = text.replacen("$0", "", 1);
    let mut database = Database::new();
    for (path, text) in others {
        database.open(path, text);
    }
    let file = database.open("test.pyr", &text);
    database.set_edition(file, edition);
    let range = Span::new(u32::try_from(start).unwrap(), u32::try_from(end).unwrap());
    let mut report = String::new();
    for offer in refactorings(&database, file, range) {
        if !offer.title.contains(word) {
            continue;
        }
        match offer.edits {
            Err(reason) => {
                writeln!(report, "{:?}: {}\n  not here: {reason}", offer.kind, offer.title).unwrap();
            }
            Ok(edits) => {
                writeln!(report, "{:?}: {}", offer.kind, offer.title).unwrap();
                let after = applied(&database, file, &edits);
                report += &changed(&text, &after);
            }
        }
    }
    report
}

/// The changed lines.
fn changed(before: &str, after: &str) -> String {
    let (before, after): (Vec<&str>, Vec<&str>) = (before.lines().collect(), after.lines().collect());
    let head = before.iter().zip(&after).take_while(|(a, b)| a == b).count();
    let most = before.len().min(after.len()) - head;
    let tail = before.iter().rev().zip(after.iter().rev()).take(most).take_while(|(a, b)| a == b).count();
    after[head..after.len() - tail].iter().fold(String::new(), |lines, line| lines + "    | " + line + "\n")
}
