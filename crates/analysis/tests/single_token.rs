//! One wrong token in a program of the article: it is reported where it is, about once, and nowhere else. Whether what
//! it leaves is still a program, and which problems it then has, is for the naive checker to decide.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::collections::BTreeSet;
use std::ops::Range;

use pydslrep_analysis::{Database, Diagnostic};
use pydslrep_naive::{Finding, declarations};
use pydslrep_syntax::{KEYWORDS, Span, Token, lex};

/// A program with one slip, and the place of the slip.
struct Slip {
    text: String,
    /// The replaced text, in the original program.
    was: Range<usize>,
    /// The text that replaces it.
    at: Range<usize>,
    what: String,
}

fn programs() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/paper");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let program = |path: std::path::PathBuf| {
        (path.file_stem().unwrap().to_string_lossy().into_owned(), std::fs::read_to_string(path).unwrap())
    };
    paths.into_iter().map(program).collect()
}

fn replace(text: &str, span: Span, by: &str, what: String) -> Slip {
    let mut changed = text.to_owned();
    let was = Range::<usize>::from(span);
    changed.replace_range(was.clone(), by);
    Slip { text: changed, at: was.start..was.start + by.len(), was, what }
}

fn deletions(text: &str, tokens: &[Token]) -> Vec<Slip> {
    tokens
        .iter()
        .map(|(_, span)| replace(text, *span, "", format!("without {:?}", span.text(text))))
        .collect()
}

fn duplications(text: &str, tokens: &[Token]) -> Vec<Slip> {
    let twice = |(_, span): &Token| {
        let word = span.text(text);
        replace(text, Span::at(span.end), &format!(" {word}"), format!("{word:?} twice"))
    };
    tokens.iter().map(twice).collect()
}

/// Something that does not belong before every token: a word, a name, a number, a sign.
fn insertions(text: &str, tokens: &[Token]) -> Vec<Slip> {
    let strangers = ["radius", "stranger", "7", "}", "until", ","];
    let before = |(index, (_, span)): (usize, &Token)| {
        let word = strangers[index % strangers.len()];
        replace(
            text,
            Span::at(span.start),
            &format!("{word} "),
            format!("{word:?} before {:?}", span.text(text)),
        )
    };
    tokens.iter().enumerate().map(before).collect()
}

/// Every keyword with its last letter missing, its first two letters swapped, and a letter too many.
fn misspellings(text: &str, tokens: &[Token]) -> Vec<Slip> {
    let mut slips = Vec::new();
    for (_, span) in tokens.iter().filter(|(token, span)| token.is_keyword() && span.len() > 2) {
        let word = span.text(text);
        let swapped = [&word[1..2], &word[..1], &word[2..]].concat();
        for slip in [word[..word.len() - 1].to_owned(), swapped, format!("{word}e")] {
            if !KEYWORDS.iter().any(|(_, keyword)| *keyword == slip) {
                slips.push(replace(text, *span, &slip, format!("{slip:?} for {word:?}")));
            }
        }
    }
    slips
}

fn is_syntax(diagnostic: &Diagnostic) -> bool {
    ["syntax-error", "invalid-character", "unterminated-comment", "unterminated-string"]
        .contains(&diagnostic.code())
}

fn finding(diagnostic: &Diagnostic) -> Finding {
    let Range { start, end } = Range::<usize>::from(diagnostic.span);
    Finding { start, end, code: diagnostic.code() }
}

impl Slip {
    /// The same place in the program as it was, for what is before or after the slip.
    fn place_before(&self, mut finding: Finding) -> Finding {
        for place in [&mut finding.start, &mut finding.end] {
            if *place >= self.at.end {
                *place = *place - self.at.end + self.was.end;
            }
        }
        finding
    }

    /// The entity with the slip in the program as it was, and the white space around it: what is right beside it.
    fn surroundings(&self, before: &str) -> Range<usize> {
        let entities = declarations(before).unwrap();
        let index = entities.iter().position(|entity| self.was.start <= entity.range.end).unwrap();
        let start = if index == 0 { 0 } else { entities[index - 1].range.end };
        let end = entities.get(index + 1).map_or(before.len(), |next| next.range.start);
        start..end
    }

    /// Returns the diagnostics of other entities that may follow: those from before, as an entity with a syntax error
    /// still declares its name; where the slip took that very name, those without the entity; and where it took the
    /// name of another entity, that nothing uses that one.
    fn true_consequences(&self, before: &str) -> BTreeSet<Finding> {
        let mut programs = vec![before.to_owned()];
        for entity in declarations(before).unwrap() {
            let touched = self.was.start <= entity.name_range.end && entity.name_range.start <= self.was.end;
            if touched {
                let mut without = before.to_owned();
                without.replace_range(entity.range.clone(), &" ".repeat(entity.range.len()));
                programs.push(without);
            }
        }
        let lost: Vec<_> = declarations(before).unwrap();
        let lost = lost.iter().filter(|entity| self.at.is_empty() && entity.name == before[self.was.clone()]);
        let unused = lost.map(|entity| {
            let Range { start, end } = entity.name_range.clone();
            Finding { start, end, code: "unused-declaration" }
        });
        let verdicts = programs.iter().map(|program| pydslrep_naive::check(program));
        verdicts.flat_map(|verdict| [verdict.findings, verdict.excused].concat()).chain(unused).collect()
    }
}

/// Where the slip leaves a program, exactly the problems of the contract are reported.
fn check_program(verdict: pydslrep_naive::Verdict, reported: &BTreeSet<Finding>) -> Result<(), String> {
    let expected: BTreeSet<Finding> = verdict.findings.into_iter().collect();
    let invented = |finding: &&Finding| !expected.contains(finding) && !verdict.excused.contains(finding);
    match (expected.difference(reported).next(), reported.iter().find(invented)) {
        (None, None) => Ok(()),
        (missing, invented) => Err(format!("not reported: {missing:?}; not in the contract: {invented:?}")),
    }
}

/// Where it does not, one or two syntax errors are reported near the slip, and elsewhere only true problems.
fn check_broken(slip: &Slip, before: &str, reported: &[Finding], syntax: &[Finding]) -> Result<(), String> {
    let near = slip.surroundings(before);
    let is_near = |finding: &Finding| near.start <= finding.start && finding.start <= near.end;
    if !syntax.iter().any(|finding| is_near(&slip.place_before(finding.clone()))) {
        return Err("nothing is reported near the slip".to_owned());
    }
    if syntax.len() > 2 {
        return Err("a cascade".to_owned());
    }
    let truth = slip.true_consequences(before);
    let far =
        reported.iter().map(|finding| slip.place_before(finding.clone())).filter(|finding| !is_near(finding));
    match far.into_iter().find(|finding| !truth.contains(finding)) {
        Some(untrue) => Err(format!("no true consequence: {untrue:?}")),
        None => Ok(()),
    }
}

/// Returns the number of syntax errors reported.
fn check(slip: &Slip, program: &str, before: &str, complaints: &mut Vec<String>) -> u32 {
    let mut database = Database::new();
    let file = database.open("slip.pyr", &slip.text);
    let diagnostics = database.diagnostics(file);
    let reported: Vec<Finding> = diagnostics.iter().map(finding).collect();
    let syntax: Vec<Finding> =
        diagnostics.iter().filter(|diagnostic| is_syntax(diagnostic)).map(finding).collect();
    let verdict = pydslrep_naive::check(&slip.text);
    let outcome = if verdict.grammatical {
        check_program(verdict, &reported.into_iter().collect())
    } else {
        check_broken(slip, before, &reported, &syntax)
    };
    if let Err(complaint) = outcome {
        complaints.push(format!("{program}, {}: {complaint}", slip.what));
    }
    u32::try_from(syntax.len()).unwrap()
}

/// Most syntax errors that a kind of slip may make on average.
const FEW: f64 = 1.05;

#[test]
fn a_slip_is_reported_where_it_is_and_about_once() {
    let mut complaints = Vec::new();
    for kind in [deletions, duplications, insertions, misspellings] {
        let (mut reported, mut errors) = (0_u32, 0_u32);
        for (program, text) in programs() {
            for slip in kind(&text, &lex(&text)) {
                let count = check(&slip, &program, &text, &mut complaints);
                reported += u32::from(count > 0);
                errors += count;
            }
        }
        let average = f64::from(errors) / f64::from(reported);
        assert!(reported > 300 && average <= FEW, "{reported} slips make {average:.3} errors each");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
