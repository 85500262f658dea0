//! Refactorings preserve behaviour and introduce no diagnostics: applied everywhere in the paper's programs and in random
//! programs. `PYDSLREP_REFACTORED` sets their number.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::collections::BTreeMap;
use std::path::Path;

use pydslrep_analysis::{Database, Edit, FileId, plan, scene};
use pydslrep_ide::{fix_all, has_safe_fix, refactorings};
use pydslrep_naive::Recipe;
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Action, Entity};

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

/// The planned behaviour of an environment's robots: their poses after each action, the remaining actions, and the total
/// duration.
#[derive(Debug)]
struct Driven {
    poses: Vec<Vec<[f64; 3]>>,
    duration: Option<f64>,
}

fn driven(database: &Database, file: FileId) -> BTreeMap<String, Driven> {
    let mut all = BTreeMap::new();
    for (id, name) in database.environments(file) {
        let Ok(environment) = database.environment(id) else { continue };
        let plan = plan(&environment, &scene(&environment)).unwrap();
        let poses = |robot: &pydslrep_kinematics::RobotPath| {
            robot.legs.iter().map(|leg| [leg.to.x, leg.to.y, leg.to.theta]).collect()
        };
        let driven = Driven { poses: plan.robots.iter().map(poses).collect(), duration: plan.duration };
        all.insert(name.text.to_string(), driven);
    }
    all
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs())
}

fn same_poses(a: &Driven, b: &Driven) -> bool {
    let near = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).all(|(a, b)| close(*a, *b));
    let same =
        |a: &Vec<[f64; 3]>, b: &Vec<[f64; 3]>| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b));
    a.poses.len() == b.poses.len() && a.poses.iter().zip(&b.poses).all(|(a, b)| same(a, b))
}

/// Applies every refactoring and counts them by the first words of their titles.
fn try_all(text: &str, tried: &mut BTreeMap<String, usize>) {
    let (database, file) = opened(text);
    let (problems_before, driven_before) = (problems(&database, file), driven(&database, file));
    for selection in selections(&database, file) {
        for offer in refactorings(&database, file, selection) {
            let Ok(edits) = offer.edits else { continue };
            let kind: Vec<&str> = offer.title.split(' ').take(2).collect();
            *tried.entry(kind.join(" ")).or_default() += 1;
            let after = applied(text, &edits);
            let (database, file) = opened(&after);
            let case = format!("{} at {selection:?} of\n{text}\nmakes\n{after}", offer.title);
            for (code, count) in problems(&database, file) {
                let before = problems_before.get(code).copied().unwrap_or(0);
                // Diagnostics of a movement apply to its parts, too.
                let may_grow = offer.title.starts_with("extract") && before > 0;
                assert!(count <= before || may_grow, "a new {code}: {case}");
            }
            let now = driven(&database, file);
            assert_eq!(now.keys().collect::<Vec<_>>(), driven_before.keys().collect::<Vec<_>>(), "{case}");
            for (before, now) in driven_before.values().zip(now.values()) {
                assert!(same_poses(before, now), "{before:?} {now:?} {case}");
                let same_time = match (before.duration, now.duration) {
                    (Some(before), Some(now)) => close(before, now),
                    (before, now) => before.is_some() == now.is_some(),
                };
                let other_time = ["use ", "make `"].iter().any(|word| offer.title.starts_with(word));
                assert!(same_time || other_time, "{before:?} {now:?} {case}");
            }
        }
    }
}

fn random_programs() -> impl Iterator<Item = String> {
    let count = std::env::var("PYDSLREP_REFACTORED").ok().and_then(|count| count.parse().ok()).unwrap_or(20);
    let recipe = |seed: u64| Recipe { lines: 30, mistakes: seed.is_multiple_of(2), ..Recipe::default() };
    (0..count).map(move |seed| recipe(seed).seeded(seed))
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
                let Some(after) = chosen(&text, selection, there) else { continue };
                let again = chosen(&after, Span::at(selection.start), back);
                assert_eq!(again.as_deref(), Some(text.as_str()), "{there}");
            }
        }
    }
}

fn chosen(text: &str, selection: Span, title: &str) -> Option<String> {
    let (database, file) = opened(text);
    let only_one = Span::at(selection.start);
    let offer = refactorings(&database, file, only_one).into_iter().find(|offer| offer.title == title)?;
    Some(applied(text, &offer.edits.unwrap()))
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
