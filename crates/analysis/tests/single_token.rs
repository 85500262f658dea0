//! One wrong token in a program of the article: it is reported where it is, about once, and nowhere else.

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use pydslrep_analysis::{Database, Diagnostic};
use pydslrep_syntax::{KEYWORDS, Lexeme, Span, lex, parse};

/// What one slip makes of a program, and where the slip is.
struct Slip {
    text: String,
    at: Span,
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
    changed.replace_range(std::ops::Range::from(span), by);
    let end = span.start + u32::try_from(by.len()).unwrap();
    Slip { text: changed, at: Span::new(span.start, end), what }
}

fn deletions(text: &str, lexemes: &[Lexeme]) -> Vec<Slip> {
    lexemes
        .iter()
        .map(|(_, span)| replace(text, *span, "", format!("without {:?}", span.text(text))))
        .collect()
}

fn duplications(text: &str, lexemes: &[Lexeme]) -> Vec<Slip> {
    let twice = |(_, span): &Lexeme| {
        let word = span.text(text);
        replace(text, Span::at(span.end), &format!(" {word}"), format!("{word:?} twice"))
    };
    lexemes.iter().map(twice).collect()
}

/// Something that does not belong before every token: a word, a name, a number, a sign.
fn insertions(text: &str, lexemes: &[Lexeme]) -> Vec<Slip> {
    let strangers = ["radius", "stranger", "7", "}", "until", ","];
    let before = |(index, (_, span)): (usize, &Lexeme)| {
        let word = strangers[index % strangers.len()];
        replace(
            text,
            Span::at(span.start),
            &format!("{word} "),
            format!("{word:?} before {:?}", span.text(text)),
        )
    };
    lexemes.iter().enumerate().map(before).collect()
}

/// Every keyword with its last letter missing, its first two letters swapped, and a letter too many.
fn misspellings(text: &str, lexemes: &[Lexeme]) -> Vec<Slip> {
    let mut slips = Vec::new();
    for (_, span) in lexemes.iter().filter(|(token, span)| token.is_keyword() && span.len() > 2) {
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

/// The entity that the slip is in, with its neighbours: what is right beside it.
fn neighbourhood(slip: &Slip) -> Span {
    let pieces = parse(&slip.text);
    let touched = |span: &Span| span.start <= slip.at.end && slip.at.start <= span.end;
    let touching: Vec<usize> = (0..pieces.len()).filter(|index| touched(&pieces[*index].0)).collect();
    let (first, last) = (touching[0], touching[touching.len() - 1]);
    pieces[first.saturating_sub(1)].0.to(pieces[(last + 1).min(pieces.len() - 1)].0)
}

fn check(slip: &Slip, program: &str, complaints: &mut Vec<String>) -> u32 {
    let mut database = Database::new();
    let file = database.open("slip.pyr", &slip.text);
    let diagnostics = database.diagnostics(file);
    let syntax: Vec<&Diagnostic> = diagnostics.iter().filter(|diagnostic| is_syntax(diagnostic)).collect();
    let near = neighbourhood(slip);
    let is_near = |diagnostic: &&Diagnostic| near.touches(diagnostic.span.start);
    let mut complain =
        |what: &str| complaints.push(format!("{program}, {}: {what}\n{diagnostics:#?}", slip.what));
    if !syntax.iter().all(is_near) {
        complain("a syntax error far from the slip");
    }
    if !syntax.is_empty() && !syntax.iter().any(is_near) {
        complain("nothing is said near the slip");
    }
    if syntax.len() > 2 {
        complain("a cascade");
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
                let count = check(&slip, &program, &mut complaints);
                reported += u32::from(count > 0);
                errors += count;
            }
        }
        let average = f64::from(errors) / f64::from(reported);
        assert!(reported > 300 && average <= FEW, "{reported} slips make {average:.3} errors each");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
