//! Shared checks for the tests of refactorings.

use std::fmt::Write as _;

use expect_test::Expect;
use pydslrep_analysis::Database;
use pydslrep_syntax::Span;

use super::refactorings;
use crate::fixture::{PARTS, applied};

/// The refactorings in the actions of a movement, with the lines they change.
#[track_caller]
pub(super) fn check(actions: &str, expected: &Expect) {
    let program = format!("{PARTS}movement tour of rover {{\n{actions}\n}}\n");
    check_whole(
        &format!("{program}environment yard has {{ rover }} robots with {{ tour }} moves\n"),
        expected,
    );
}

/// The same in a complete program; two `$0` mark a selection.
#[track_caller]
pub(super) fn check_whole(fixture: &str, expected: &Expect) {
    let start = fixture.find("$0").expect("the fixture has no `$0`");
    let text = fixture.replacen("$0", "", 1);
    let end = text.find("$0").unwrap_or(start);
    let text = text.replacen("$0", "", 1);
    let mut database = Database::new();
    let file = database.open("test.pyr", &text);
    let range = Span::new(u32::try_from(start).unwrap(), u32::try_from(end).unwrap());
    let mut report = String::new();
    for offer in refactorings(&database, file, range) {
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
    expected.assert_eq(&report);
}

/// The changed lines.
fn changed(before: &str, after: &str) -> String {
    let (before, after): (Vec<&str>, Vec<&str>) = (before.lines().collect(), after.lines().collect());
    let head = before.iter().zip(&after).take_while(|(a, b)| a == b).count();
    let most = before.len().min(after.len()) - head;
    let tail = before.iter().rev().zip(after.iter().rev()).take(most).take_while(|(a, b)| a == b).count();
    after[head..after.len() - tail].iter().fold(String::new(), |lines, line| lines + "    | " + line + "\n")
}
