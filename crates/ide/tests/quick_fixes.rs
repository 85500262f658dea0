//! Every quick fix for programs with errors fixes its diagnostic and changes nothing else: applied to random programs,
//! half of them with an additional typo. `PYDSLREP_FIXED` sets their number.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::collections::BTreeMap;
use std::ops::Range;

use pydslrep_analysis::{Database, Diagnostic, Edit, FileId, Severity};
use pydslrep_ide::{QuickFix, quick_fixes};
use pydslrep_naive::{Recipe, declarations};
use pydslrep_syntax::{Span, lex, parse};

/// Diagnostics of invalid code; fixing one may reveal others.
const OF_INVALID_CODE: [&str; 4] =
    ["syntax-error", "invalid-character", "unterminated-comment", "unterminated-string"];

/// Diagnostics related to another one: with the same cause, or caused by it.
const RELATED: [(&str, &[&str]); 9] = [
    ("movement-robot-missing", &["movement-robot-missing", "empty-environment"]),
    ("unresolved-reference", &["unresolved-reference", "movement-robot-missing", "sensor-not-on-robot"]),
    ("sensor-not-on-robot", &["sensor-not-on-robot"]),
    // A radius in metres differs from one in centimetres.
    ("implausible-radius", &["mixed-radii"]),
    ("unused-declaration", &["duplicate-name"]),
    ("wheel-count", &["slam-robot"]),
    // One block less.
    ("invalid-count", &["nested-too-deep"]),
    ("empty-block", &["nested-too-deep"]),
    // One brace of a pair; a name that others refer to.
    ("syntax-error", &["syntax-error", "unresolved-reference"]),
];

fn opened(text: &str) -> (Database, FileId) {
    let mut database = Database::new();
    let file = database.open("test.pyr", text);
    (database, file)
}

/// Edits in text order, which must not overlap.
fn in_order(edits: &[Edit]) -> Vec<Edit> {
    let mut edits = edits.to_vec();
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    assert!(edits.windows(2).all(|pair| pair[0].span.end <= pair[1].span.start), "{edits:?}");
    edits
}

fn applied(text: &str, edits: &[Edit]) -> String {
    let mut text = text.to_owned();
    for edit in edits.iter().rev() {
        text.replace_range(Range::from(edit.span), &edit.text);
    }
    text
}

/// The new offset of a position after edits; `None` if one of them changes it.
fn moved(span: Span, edits: &[Edit]) -> Option<Span> {
    let mut shift = 0;
    for edit in edits {
        let (length, new) = (i64::from(edit.span.len()), i64::try_from(edit.text.len()).unwrap());
        // Missing tokens are reported at the end of the previous one.
        let is_beside = span.is_empty() && length > 0 && edit.span.touches(span.start);
        if is_beside || (edit.span.start < span.end && span.start < edit.span.end) {
            return None;
        }
        if edit.span.end <= span.start {
            shift += new - length;
        }
    }
    let moved = |offset: u32| u32::try_from(i64::from(offset) + shift).unwrap();
    Some(Span::new(moved(span.start), moved(span.end)))
}

/// A random program with typos.
fn program(seed: u64) -> String {
    let text = Recipe { lines: 12, ..Recipe::default() }.seeded(seed);
    let tokens = lex(&text);
    if seed.is_multiple_of(2) || tokens.is_empty() {
        return text;
    }
    let (_, span) = tokens[usize::try_from(seed * 7919).unwrap() % tokens.len()];
    let word = span.text(&text);
    let slip = match seed % 3 {
        0 => String::new(),
        1 => format!("{word} {word}"),
        _ => word.chars().take(word.chars().count() - 1).collect(),
    };
    let mut text = text.clone();
    text.replace_range(Range::from(span), &slip);
    text
}

/// Applies a fix; `index` is that of its diagnostic among those `before`.
fn try_out(text: &str, database: &Database, before: &[Diagnostic], index: usize, offer: &QuickFix) {
    let fixed = &before[index];
    let entity = |span: Span| database.entity_at(fixed.file, span.start).map(|entity| entity.id);
    let is_of_invalid_code = OF_INVALID_CODE.contains(&fixed.code());
    let edits = in_order(&offer.fix.edits);
    let after_text = applied(text, &edits);
    let (database, file) = opened(&after_text);
    let mut after = database.diagnostics(file);
    let case = format!("{}: {} in\n{text}\nmakes\n{after_text}", fixed.message, offer.fix.title);

    let mut gone = Vec::new();
    for (_, other) in before.iter().enumerate().filter(|(other, _)| *other != index) {
        let span = moved(other.span, &edits);
        match after.iter().position(|left| left.code() == other.code() && Some(left.span) == span) {
            Some(left) => drop(after.remove(left)),
            None => gone.push((other, span)),
        }
    }
    for (other, span) in gone {
        // A diagnostic of a list may move within the list.
        if let Some(elsewhere) = after.iter().position(|left| left.code() == other.code()) {
            after.remove(elsewhere);
            continue;
        }
        let goes_along =
            RELATED.iter().any(|(code, along)| *code == fixed.code() && along.contains(&other.code()));
        // Partially valid code may change its meaning.
        let is_read_again = is_of_invalid_code && entity(other.span) == entity(fixed.span);
        // One hint may replace another: an unused declaration may be used now.
        let may_go = span.is_none() || goes_along || is_read_again || other.severity == Severity::Hint;
        assert!(may_go, "{} {:?} is gone, too: {case}", other.code(), other.message);
    }
    for new in after {
        assert!(new.message != fixed.message, "it is still there: {case}");
        // More of the code is valid.
        let came_to_light = is_of_invalid_code
            && (!OF_INVALID_CODE.contains(&new.code()) || new.span.start > fixed.span.start);
        let may_come = if offer.fix.safe { Severity::Warning } else { Severity::Hint };
        assert!(
            new.severity <= may_come || came_to_light,
            "it brings {} {:?}: {case}",
            new.code(),
            new.message
        );
    }
}

#[test]
fn every_fix_mends_its_problem_and_nothing_else_changes() {
    let count = std::env::var("PYDSLREP_FIXED").ok().and_then(|count| count.parse().ok()).unwrap_or(400);
    let mut tried: BTreeMap<&'static str, usize> = BTreeMap::new();
    for text in (0..count).map(program) {
        let (database, file) = opened(&text);
        let before = database.diagnostics(file);
        for (index, problem) in before.iter().enumerate() {
            for offer in quick_fixes(&database, file, problem.span) {
                if offer.diagnostic == *problem {
                    try_out(&text, &database, &before, index, &offer);
                    *tried.entry(problem.code()).or_default() += 1;
                }
            }
        }
    }
    assert!(tried.len() > 15 && tried.values().sum::<usize>() > 500, "{tried:?}");
}

/// Typical typos.
fn slips(word: &str) -> Vec<String> {
    let letters: Vec<char> = word.chars().collect();
    let swapped: String = letters.iter().take(2).rev().chain(letters.iter().skip(2)).collect();
    let last_missing: String = letters.iter().take(letters.len() - 1).collect();
    let capitalised: String =
        letters.iter().take(1).map(char::to_ascii_uppercase).chain(letters.iter().skip(1).copied()).collect();
    let alike =
        [swapped, last_missing, capitalised, format!("{word}-1"), format!("{word}x"), format!("\"{word}\"")];
    let others = [
        String::new(),
        format!("{word} {word}"),
        "=".to_owned(),
        "(".to_owned(),
        "{".to_owned(),
        "}".to_owned(),
    ];
    alike.into_iter().chain(others).collect()
}

/// A program with some typos and the ranges of its entities.
fn broken(seed: u64) -> (String, Vec<Range<usize>>) {
    let mut text = Recipe { lines: 10, ..Recipe::default() }.seeded(seed);
    let mut entities: Vec<_> = declarations(&text).unwrap().into_iter().map(|entity| entity.range).collect();
    for turn in 0..=seed % 3 {
        let tokens: Vec<_> = lex(&text).into_iter().filter(|(token, _)| !token.is_comment()).collect();
        let chosen = usize::try_from(seed * 7919 + turn * 104_729).unwrap();
        let Some((_, span)) = tokens.get(chosen % tokens.len().max(1)) else { continue };
        let slips = slips(span.text(&text));
        let slip = &slips[chosen / tokens.len() % slips.len()];
        let range = Range::<usize>::from(*span);
        text.replace_range(range.clone(), slip);
        let moved =
            |offset: usize| if offset >= range.end { offset + slip.len() - range.len() } else { offset };
        for entity in &mut entities {
            *entity = moved(entity.start)..moved(entity.end);
        }
    }
    (text, entities)
}

/// Codes whose fix may change another entity than that of the diagnostic: the robot that lacks a sensor.
const CONCERN_OTHERS: [&str; 1] = ["sensor-not-on-robot"];

#[test]
fn a_fix_never_lands_inside_another_entity() {
    let (mut declared, mut inserted) = (0, 0);
    for seed in 0..600 {
        let (text, entities) = broken(seed);
        let (database, file) = opened(&text);
        for problem in database.diagnostics(file) {
            let concerned = |entity: &Range<usize>| {
                entity.start <= problem.span.end as usize && problem.span.start as usize <= entity.end
            };
            for edit in problem.fixes.iter().flat_map(|fix| &fix.edits) {
                let at = edit.span.start as usize;
                let declares = edit.span.is_empty()
                    && edit.text.ends_with('\n')
                    && parse(&edit.text)
                        .iter()
                        .all(|(_, piece)| piece.entity.is_some() && piece.errors.is_empty());
                declared += usize::from(declares);
                inserted += usize::from(edit.span.is_empty());
                for entity in entities.iter().filter(|entity| entity.start < at && at < entity.end) {
                    assert!(
                        !declares && (concerned(entity) || CONCERN_OTHERS.contains(&problem.code())),
                        "{}: {:?} at {at} is inside of {:?} in\n{text}",
                        problem.message,
                        edit.text,
                        &text[entity.clone()]
                    );
                }
            }
        }
    }
    assert!(declared > 50 && inserted > 200, "{declared} declarations, {inserted} insertions");
}
