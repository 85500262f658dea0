//! The acceptance test of the incremental database: after any edit, the answers to all requests of an editor equal those
//! of a fresh database with the same texts.
//!
//! `cargo test` makes 500 random edits and compares after each of them; `PYDSLREP_EDITS=10000000
//! PYDSLREP_COMPARE_EVERY=25 cargo test --release -p pydslrep-ide --test incremental` makes ten million and compares after
//! every 25th: the edits between ask for diagnostics only, as an editor does between two keys. Failures shrink: first the
//! edits before, then the initial programs, then the texts right before the failing edit.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

mod answers;
mod editing;
mod panics;
mod programs;
mod smallest;

use std::cell::Cell;

use proptest::test_runner::{Config, TestCaseError, TestError, TestRunner};

use crate::editing::{Editing, Step};
use crate::panics::Silence;
use crate::programs::Start;

/// The default number of edits.
const EDITS: u32 = 500;

/// The greatest number of edits per set of files.
const IN_A_ROW: usize = 40;

/// The least average number of edits per set of files, so that enough sets are made.
const AVERAGE: u32 = 32;

/// The number of edits between progress messages of a long run.
const TELL_EVERY: u64 = 100_000;

#[test]
fn an_edited_database_answers_as_a_fresh_one() {
    let wanted = std::env::var("PYDSLREP_EDITS").ok();
    let edits: u32 =
        wanted.as_deref().map_or(EDITS, |number| number.parse().expect("PYDSLREP_EDITS is a number"));
    let every = std::env::var("PYDSLREP_COMPARE_EVERY").ok();
    let every = every.map_or(1, |number| number.parse().expect("PYDSLREP_COMPARE_EVERY is a number"));
    let config = Config {
        cases: edits.div_ceil(AVERAGE),
        max_shrink_iters: 20_000,
        failure_persistence: None,
        ..Config::default()
    };
    let done = Cell::new(0_u64);
    let silence = Silence::new();
    let outcome = TestRunner::new(config).run(&editing::strategy(IN_A_ROW), |(start, steps)| {
        if done.get() >= u64::from(edits) {
            return Ok(());
        }
        let mut editing = Editing::new(&start, every);
        for step in &steps {
            let edits = editing.take(step).map_err(|failure| TestCaseError::fail(failure.difference))?;
            let before = done.replace(done.get() + edits);
            if wanted.is_some() && before / TELL_EVERY != done.get() / TELL_EVERY {
                tell(done.get());
            }
        }
        Ok(())
    });
    let failure = match outcome {
        Ok(()) => None,
        Err(TestError::Fail(_, (start, steps))) => Some(explain(&start, &steps, every)),
        Err(TestError::Abort(reason)) => Some(reason.to_string()),
    };
    drop(silence);
    if wanted.is_some() {
        tell(done.get());
    }
    if let Some(failure) = failure {
        panic!("{failure}");
    }
    assert!(done.get() >= u64::from(edits), "only {} of {edits} edits were made: lower AVERAGE", done.get());
}

/// The first failure, shrunk.
fn explain(start: &Start, steps: &[Step], every: usize) -> String {
    let mut editing = Editing::new(start, every);
    let failure = steps.iter().find_map(|step| editing.take(step).err());
    failure.map_or_else(|| "it fails no more".to_owned(), |failure| failure.smallest().to_string())
}

/// Prints the progress of a long run.
#[expect(clippy::print_stderr, reason = "somebody waits for it")]
fn tell(done: u64) {
    eprintln!("{done} edits");
}
