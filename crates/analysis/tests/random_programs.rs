//! Programs at random: the parser takes them, the formatter keeps what they mean, and the database says of them what a
//! naive checker reads in the language's contract, also where a program is in several files. `PYDSLREP_PROGRAMS` says how
//! many to try.

use std::collections::BTreeSet;

use proptest::prelude::*;
use pydslrep_analysis::{Absence, Database, Edition, FileId, Target};
use pydslrep_naive::{Finding, Recipe, Source, Verdict};
use pydslrep_syntax::{format, parse};

/// Returns the diagnostics of a program, and their places.
fn diagnostics(text: &str) -> BTreeSet<Finding> {
    let mut database = Database::new();
    let file = database.open("random.pyr", text);
    findings(&database, file)
}

/// Returns the diagnostics of a program where the edition is the article's.
fn diagnostics_as_article(text: &str) -> BTreeSet<Finding> {
    let mut database = Database::new();
    let file = database.open("random.pyr", text);
    database.set_edition(file, Edition::Article);
    findings(&database, file)
}

fn findings(database: &Database, file: FileId) -> BTreeSet<Finding> {
    let finding = |diagnostic: &pydslrep_analysis::Diagnostic| Finding {
        start: diagnostic.span.start as usize,
        end: diagnostic.span.end as usize,
        code: diagnostic.code(),
    };
    database.diagnostics(file).iter().map(finding).collect()
}

/// Returns the diagnostics of each file of a project.
fn diagnostics_of_project(sources: &[Source]) -> Vec<BTreeSet<Finding>> {
    let mut database = Database::new();
    let files: Vec<FileId> = sources.iter().map(|source| database.open(source.path, &source.text)).collect();
    for (file, source) in files.iter().zip(sources) {
        database.set_target(*file, if source.for_vrep { Target::VRep } else { Target::CoppeliaSim });
        for path in database.imports(*file).to_vec() {
            if database.file(&path).is_none() {
                database.set_absence(*file, &path, Some(Absence::Missing));
            }
        }
    }
    files.into_iter().map(|file| findings(&database, file)).collect()
}

/// The trees of a text without their places; `None` where it has a syntax error.
fn meaning(text: &str) -> Option<Vec<String>> {
    let pieces = parse(text);
    let understood = pieces.iter().all(|(_, parse)| parse.errors.is_empty());
    let trees = pieces.iter().filter_map(|(_, parse)| parse.entity.as_ref());
    understood.then(|| trees.map(|tree| without_spans(&format!("{tree:?}"))).collect())
}

fn without_spans(tree: &str) -> String {
    let mut parts = tree.split("Span { start: ");
    let first = parts.next().unwrap_or_default().to_owned();
    let rest = parts.filter_map(|part| part.split_once(" }")).map(|(_, following)| following);
    first + &rest.collect::<String>()
}

fn check(text: &str) -> Result<(), TestCaseError> {
    let verdict = pydslrep_naive::check(text);
    prop_assert!(verdict.grammatical, "the naive checker does not understand this");
    let before = meaning(text);
    prop_assert!(before.is_some(), "the parser does not understand this");

    let formatted = format(text);
    prop_assert_eq!(meaning(&formatted), before, "formatting changes the meaning:\n{}", &formatted);
    prop_assert_eq!(format(&formatted), formatted.clone(), "formatting again changes something");

    compare(&diagnostics(text), verdict)?;
    compare(&diagnostics_as_article(text), pydslrep_naive::check_as_article(text))
}

/// Checks that the diagnostics are those of the naive checker.
fn compare(said: &BTreeSet<Finding>, verdict: Verdict) -> Result<(), TestCaseError> {
    let expected: BTreeSet<Finding> = verdict.findings.into_iter().collect();
    let excused: BTreeSet<Finding> = verdict.excused.into_iter().collect();
    let missing: Vec<_> = expected.difference(said).collect();
    let invented: Vec<_> = said.difference(&expected).filter(|finding| !excused.contains(finding)).collect();
    prop_assert!(missing.is_empty(), "not said: {:?}", missing);
    prop_assert!(invented.is_empty(), "said, but nothing in the contract: {:?}", invented);
    Ok(())
}

fn how_many() -> u32 {
    std::env::var("PYDSLREP_PROGRAMS").ok().and_then(|count| count.parse().ok()).unwrap_or(350)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: how_many(), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_mean_what_the_contract_says(text in pydslrep_naive::programs()) {
        check(&text)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: how_many() / 4, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn programs_in_several_files_mean_what_the_contract_says(sources in Recipe::default().projects()) {
        let verdicts = pydslrep_naive::check_project(&sources);
        prop_assert!(verdicts.is_some(), "the naive checker does not understand this");
        for ((source, said), verdict) in
            sources.iter().zip(diagnostics_of_project(&sources)).zip(verdicts.unwrap_or_default())
        {
            compare(&said, verdict).map_err(|error| TestCaseError::fail(format!("{}: {error}", source.path)))?;
        }
    }
}
