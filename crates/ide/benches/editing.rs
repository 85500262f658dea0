//! Latency of editor requests without the protocol: `cargo bench --package pydslrep-ide`.
//!
//! Each is measured on programs of 100 to 100 000 lines, to show which ones grow with the file.

use divan::{Bencher, black_box};
use pydslrep_analysis::{Database, FileId};
use pydslrep_ide as ide;
use pydslrep_syntax::{Span, lex, parse};

const LINES: [usize; 4] = [100, 1_000, 10_000, 100_000];

fn main() {
    divan::main();
}

/// A program without diagnostics: sites with one robot, two movements and an environment each.
fn program(lines: usize) -> String {
    const SITE: usize = 20;
    let site = |number: usize| {
        format!(
            "// site {number}\n\
             wheel left{number} with radius 4.5\n\
             wheel right{number} with radius 4.5\n\
             sensor front{number}\n\
             robot rover{number} type tw with port 19997 has {{ left{number} right{number} }} wheels with sensors {{ front{number} }}\n\n\
             movement patrol{number} of rover{number} {{\n  move 4.0 meters at 12.5\n  turn left 90\n  \
             move 50 centimeters\n  turn right until {{ front{number} }}\n}}\n\n\
             movement back{number} of rover{number} {{\n  turn left 180\n  move 2 meters\n}}\n\n\
             environment yard{number} has {{ rover{number} }} robots with {{ patrol{number} back{number} }} moves\n\n"
        )
    };
    (0..lines.div_ceil(SITE)).map(site).collect()
}

fn opened(text: &str) -> (Database, FileId) {
    let mut database = Database::new();
    let file = database.open("bench.pyr", text);
    assert_eq!(database.diagnostics(file), []);
    (database, file)
}

/// The end of a word in the middle of the program.
fn following(text: &str, word: &str) -> u32 {
    let middle = text.len() / 2;
    let at = text[middle..].find(word).map(|at| middle + at + word.len());
    at.and_then(|at| u32::try_from(at).ok()).unwrap_or_default()
}

#[divan::bench(args = LINES)]
fn lexing(bencher: Bencher, lines: usize) {
    let text = program(lines);
    bencher.bench(|| lex(black_box(&text)));
}

#[divan::bench(args = LINES)]
fn parsing(bencher: Bencher, lines: usize) {
    let text = program(lines);
    bencher.bench(|| parse(black_box(&text)));
}

#[divan::bench(args = LINES)]
fn opening(bencher: Bencher, lines: usize) {
    let text = program(lines);
    bencher.bench(|| opened(black_box(&text)));
}

/// Types and deletes one character, with all diagnostics after each edit.
fn keystroke(bencher: Bencher, lines: usize, word: &str) {
    let text = program(lines);
    let (mut database, file) = opened(&text);
    let at = following(&text, word);
    bencher.bench_local(|| {
        database.edit(file, Span::at(at), "x");
        let broken = database.diagnostics(file).len();
        database.edit(file, Span::new(at, at + 1), "");
        (broken, database.diagnostics(file).len())
    });
}

#[divan::bench(args = LINES)]
fn two_keystrokes_in_a_number(bencher: Bencher, lines: usize) {
    keystroke(bencher, lines, "move 4");
}

#[divan::bench(args = LINES)]
fn two_keystrokes_in_a_reference(bencher: Bencher, lines: usize) {
    keystroke(bencher, lines, " of rover");
}

#[divan::bench(args = LINES)]
fn completion(bencher: Bencher, lines: usize) {
    let text = program(lines);
    let (database, file) = opened(&text);
    let position = ide::FilePosition { file, offset: following(&text, " of ") };
    bencher.bench_local(|| ide::completions(&database, position, ide::CompletionTrigger::Invoked, 9.0));
}

#[divan::bench(args = LINES)]
fn hover(bencher: Bencher, lines: usize) {
    let text = program(lines);
    let (database, file) = opened(&text);
    let position = ide::FilePosition { file, offset: following(&text, "move 4") };
    bencher.bench_local(|| ide::hover(&database, position));
}

/// The fixes of a misspelt name, two of which are validated.
#[divan::bench(args = LINES)]
fn quick_fixes(bencher: Bencher, lines: usize) {
    let text = program(lines);
    let (mut database, file) = opened(&text);
    let at = following(&text, "until { front");
    database.edit(file, Span::at(at), "x");
    bencher.bench_local(|| ide::quick_fixes(&database, file, Span::at(at)).len());
}

#[divan::bench(args = LINES)]
fn hints_of_a_screen(bencher: Bencher, lines: usize) {
    let text = program(lines);
    let (database, file) = opened(&text);
    let at = following(&text, "movement ");
    let places = ide::InlayHintPlaces { file, range: Span::new(at, at + 2_000), typed: &[] };
    let mut known = ide::KnownMovements::default();
    bencher.bench_local(|| {
        ide::inlay_hints(&database, places, ide::InlayHintOptions::default(), &mut known).len()
    });
}

#[divan::bench(args = LINES)]
fn semantic_tokens(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program(lines));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::semantic_tokens(&file, None)));
}

#[divan::bench(args = LINES)]
fn outline(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program(lines));
    bencher.bench_local(|| {
        database.snapshot(file, None).map(|file| ide::document_symbols(&file).collect::<Vec<_>>())
    });
}

#[divan::bench(args = LINES)]
fn folding(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program(lines));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::folding_ranges(&file)));
}

#[divan::bench(args = LINES)]
fn formatting(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program(lines).replace(" of ", "  of "));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::format(&file)));
}
