//! Refactorings preserve behaviour and introduce no diagnostics: applied everywhere in the paper's programs and in random
//! programs. `PYDSLREP_REFACTORED` sets the number of each kind.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]
#![allow(clippy::print_stderr, reason = "what a long run has tried")]

mod behaviour;

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use pydslrep_analysis::{Database, Edit, FileId};
use pydslrep_ide::{Refactoring, fix_all, has_safe_fix, refactorings};
use pydslrep_naive::{Recipe, Statements};
use pydslrep_syntax::ast::{Action, Entity};
use pydslrep_syntax::{Span, lex};

use self::behaviour::{Behaviour, behaviours};

fn opened(text: &str) -> (Database, FileId) {
    let mut database = Database::new();
    let file = database.open("test.pyr", text);
    (database, file)
}

fn applied(text: &str, edits: &[Edit]) -> String {
    let mut edits: Vec<&Edit> = edits.iter().collect();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    assert!(edits.windows(2).all(|pair| pair[0].span.end <= pair[1].span.start), "{edits:?}");
    let mut text = text.to_owned();
    for edit in edits.into_iter().rev() {
        text.replace_range(std::ops::Range::from(edit.span), &edit.text);
    }
    text
}

/// Selections to try: entities, their names, actions, and pairs of adjacent actions, in blocks too.
fn selections(database: &Database, file: FileId) -> Vec<Span> {
    let mut found = Vec::new();
    for entity in database.entities(file) {
        found.push(Span::at(entity.span.start));
        let Some(tree) = &entity.parse.entity else { continue };
        found.extend(tree.name().map(|name| name.span.shifted(entity.span.start)));
        if let Entity::Movement(movement) = tree {
            let blocks = movement.all_actions().flat_map(Action::blocks).map(|block| &block.actions);
            for actions in std::iter::once(&movement.actions).chain(blocks) {
                let spans: Vec<Span> =
                    actions.iter().map(|action| action.span.shifted(entity.span.start)).collect();
                found.extend(spans.iter().map(|span| Span::at(span.start)));
                found.extend(&spans);
                found.extend(spans.windows(2).map(|pair| pair[0].to(pair[1])));
            }
        }
    }
    found
}

/// The number of diagnostics per code.
fn problems(database: &Database, file: FileId) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    for problem in database.diagnostics(file) {
        *counts.entry(problem.code()).or_default() += 1;
    }
    counts
}

/// The titles of refactorings of statements: they keep what is done to the letter, comments, and the canonical layout.
const OF_STATEMENTS: [&str; 5] = ["extract", "roll up", "unroll", "inline movement", "invert"];

/// Those that say so.
const CHANGES_THE_PATH: &str = "(changes the path)";

fn has_title(title: &str, beginnings: &[&str]) -> bool {
    beginnings.iter().any(|beginning| title.starts_with(beginning))
}

/// Applies every refactoring and counts them by the first words of their titles.
fn try_all(text: &str, tried: &mut BTreeMap<String, usize>) {
    let (database, file) = opened(text);
    let (problems_before, before) = (problems(&database, file), behaviours(&database, file));
    let is_canonical = pydslrep_syntax::format(text) == text;
    let mut seen = HashSet::new();
    for selection in selections(&database, file) {
        for offer in refactorings(&database, file, selection) {
            let Ok(edits) = offer.edits else { continue };
            let title = offer.title.as_str();
            let kind: Vec<&str> = title.split(' ').take(2).collect();
            *tried.entry(kind.join(" ")).or_default() += 1;
            let after = applied(text, &edits);
            if !seen.insert(after.clone()) {
                continue;
            }
            let (database, file) = opened(&after);
            let case = format!("{title} at {selection:?} of\n{text}\nmakes\n{after}");
            for (code, count) in problems(&database, file) {
                let before = problems_before.get(code).copied().unwrap_or(0);
                assert!(count <= before || may_grow(title, code, before), "a new {code}: {case}");
            }
            let now = behaviours(&database, file);
            let keeps_path = !title.ends_with(CHANGES_THE_PATH);
            // There may be more environments without errors: fewer blocks are one in another, a turn is on a circle.
            for (name, before) in &before {
                assert!(now.contains_key(name), "{name} is gone: {case}");
                if keeps_path {
                    assert_same(title, before, &now[name], &case);
                }
            }
            assert_eq!(lost_comment(text, &after), None, "{case}");
            if is_canonical && has_title(title, &OF_STATEMENTS[1..]) {
                assert_eq!(pydslrep_syntax::format(&after), after, "{case}");
            }
        }
    }
}

/// Diagnostics of a movement apply to its parts and copies, too.
fn may_grow(title: &str, code: &str, before: usize) -> bool {
    let copies = has_title(title, &["extract", "unroll", "inline movement"]) && before > 0;
    copies || title.starts_with("inline movement") && code == "unused-declaration"
}

fn assert_same(title: &str, before: &Behaviour, now: &Behaviour, case: &str) {
    let other_time = has_title(title, &["use ", "make `"]);
    assert!(before.has_same_legs(now, !other_time), "{before:?} {now:?} {case}");
    assert!(before.has_same_duration(now) || other_time, "{before:?} {now:?} {case}");
    if has_title(title, &OF_STATEMENTS) {
        assert_eq!(before.statements, now.statements, "{case}");
    }
}

/// A comment that another text does not have.
fn lost_comment(before: &str, after: &str) -> Option<String> {
    let squeezed = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let after = squeezed(after);
    let comments = lex(before).into_iter().filter(|(token, _)| token.is_comment());
    let mut texts = comments.map(|(_, span)| squeezed(span.text(before)));
    texts.find(|comment| !after.contains(comment))
}

fn count() -> u64 {
    std::env::var("PYDSLREP_REFACTORED").ok().and_then(|count| count.parse().ok()).unwrap_or(6)
}

fn random_programs() -> impl Iterator<Item = String> {
    let recipe = |seed: u64| Recipe { lines: 30, mistakes: seed.is_multiple_of(2), ..Recipe::default() };
    (0..2 * count()).map(move |seed| recipe(seed).seeded(seed))
}

/// Programs without errors, some of them in canonical layout.
fn known_programs(statements: Statements) -> impl Iterator<Item = String> {
    let recipe = Recipe { lines: 25, mistakes: false, statements, ..Recipe::default() };
    let laid_out =
        |(seed, text): (u64, String)| if seed % 2 == 0 { pydslrep_syntax::format(&text) } else { text };
    (0..count()).map(move |seed| laid_out((seed, recipe.seeded(seed))))
}

fn paper_programs() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/paper");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let programs = paths.filter(|path| path.extension().is_some_and(|ending| ending == "pyr"));
    let texts: Vec<String> = programs.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    assert!(texts.len() > 5);
    texts
}

#[test]
fn refactorings_keep_what_programs_do() {
    let mut tried = BTreeMap::new();
    for text in paper_programs().into_iter().chain(random_programs()) {
        try_all(&text, &mut tried);
    }
    for kind in ["add `type", "convert to", "convert all", "extract into", "omit the", "make the", "use "] {
        assert!(tried.keys().any(|tried| tried.starts_with(kind)), "{kind} was never tried: {tried:?}");
    }
    assert!(tried.keys().any(|tried| tried.starts_with("make `")), "{tried:?}");
}

/// Also in what unrolling and inlining make of programs, which has equal actions in rows.
fn refactorings_keep(statements: Statements, kinds: &[&str]) {
    let mut tried = BTreeMap::new();
    for text in known_programs(statements) {
        try_all(&text, &mut tried);
        try_all(&with_rows(text), &mut tried);
    }
    for kind in kinds {
        assert!(tried.contains_key(*kind), "{kind} was never tried: {tried:?}");
    }
    if std::env::var_os("PYDSLREP_REFACTORED").is_some() {
        eprintln!("{statements:?}: {tried:?}");
    }
}

#[test]
fn refactorings_keep_known_paths() {
    let kinds = ["roll up", "unroll `repeat", "inline movement", "turn on", "turn in", "extract into"];
    refactorings_keep(Statements::Known, &kinds);
}

#[test]
fn refactorings_keep_the_trees_of_unknown_paths() {
    let kinds = ["roll up", "unroll `repeat", "inline movement", "invert `if`", "turn on", "turn in"];
    refactorings_keep(Statements::Any, &kinds);
}

/// A program after its first movements are inlined and its first loops unrolled.
fn with_rows(mut text: String) -> String {
    for _ in 0..4 {
        let (database, file) = opened(&text);
        let offers = selections(&database, file).into_iter();
        let mut offers = offers.flat_map(|selection| refactorings(&database, file, selection));
        let is_wanted = |offer: &Refactoring| has_title(&offer.title, &["unroll", "inline movement"]);
        let Some(edits) = offers.find_map(|offer| is_wanted(&offer).then(|| offer.edits.ok())?) else {
            break;
        };
        text = applied(&text, &edits);
    }
    text
}

/// Rolling up what was unrolled gives the same text.
#[test]
fn unrolled_and_rolled_up_again() {
    let mut restored = 0;
    for text in known_programs(Statements::Known).map(|text| pydslrep_syntax::format(&text)) {
        let (database, file) = opened(&text);
        for selection in selections(&database, file) {
            let Some(unrolled) = chosen(&text, selection, |title| title.starts_with("unroll")) else {
                continue;
            };
            let again = chosen(&unrolled, selection, |title| title.starts_with("roll up"));
            restored += usize::from(again.as_deref() == Some(text.as_str()));
        }
    }
    assert!(restored > 5, "{restored}");
}

/// Pairs of inverse refactorings, such as converting units back and forth, restore the text.
#[test]
fn there_and_back_again() {
    for text in paper_programs() {
        let (database, file) = opened(&text);
        for selection in selections(&database, file) {
            for (there, back) in [
                ("convert to centimeters", "convert to meters"),
                ("omit the default speed of 9.0 cm/s", "make the default speed explicit"),
            ] {
                let Some(after) = chosen(&text, selection, |title| title == there) else { continue };
                let again = chosen(&after, selection, |title| title == back);
                assert_eq!(again.as_deref(), Some(text.as_str()), "{there}");
            }
        }
    }
}

/// A text after a refactoring at the start of a selection.
fn chosen(text: &str, selection: Span, is_meant: impl Fn(&str) -> bool) -> Option<String> {
    let (database, file) = opened(text);
    let only_one = Span::at(selection.start);
    let offer = refactorings(&database, file, only_one).into_iter().find(|offer| is_meant(&offer.title))?;
    Some(applied(text, &offer.edits.ok()?))
}

#[test]
fn nothing_is_left_that_can_be_fixed_safely() {
    let mut fixed = 0;
    for text in random_programs() {
        let (database, file) = opened(&text);
        let edits = fix_all(&database, file, |_| true);
        fixed += edits.len();
        let after = applied(&text, &edits);
        let (database, file) = opened(&after);
        let left = database.diagnostics(file).into_iter().find(has_safe_fix);
        assert_eq!(left, None, "of\n{text}\nbecame\n{after}");
    }
    assert!(fixed > 0);
}
