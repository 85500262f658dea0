//! Latency of editor requests without the protocol: `cargo bench --package pydslrep-ide`.
//!
//! Each is measured on programs of 100 to 100 000 lines, to show which ones grow with the file, and on such with blocks of
//! blocks, whose edits should cost what their length does.

use divan::{Bencher, black_box};
use pydslrep_analysis::{Database, FileId};
use pydslrep_ide as ide;
use pydslrep_syntax::{Span, lex, parse};

const LINES: [usize; 4] = [100, 1_000, 10_000, 100_000];

fn main() {
    divan::main();
}

/// Programs without diagnostics: sites with one robot, two movements and an environment each.
trait Shape {
    /// The lines of a site.
    const SITE: usize;
    /// The end of the line before a statement, up to the statement itself.
    const BEFORE_STATEMENT: &str;

    /// The movements of a site.
    fn movements(number: usize) -> String;
}

/// Movements without blocks.
struct Flat;

impl Shape for Flat {
    const SITE: usize = 20;
    const BEFORE_STATEMENT: &str = " at 12.5\n  ";

    fn movements(number: usize) -> String {
        format!(
            "movement patrol{number} of rover{number} {{\n  move 4.0 meters at 12.5\n  turn left 90\n  \
             move 50 centimeters\n  turn right until {{ front{number} }}\n}}\n\n\
             movement back{number} of rover{number} {{\n  turn left 180\n  move 2 meters\n}}\n\n"
        )
    }
}

/// The same actions in blocks of blocks, and a movement that is done.
struct Nested;

impl Shape for Nested {
    const SITE: usize = 30;
    const BEFORE_STATEMENT: &str = " at 12.5\n        ";

    fn movements(number: usize) -> String {
        format!(
            "movement patrol{number} of rover{number} {{\n  repeat 4 times {{\n    do back{number}\n    \
             if {{ front{number} }} detect within 40 centimeters {{\n      repeat 2 times {{\n        \
             move 4.0 meters at 12.5\n        turn left 90\n      }}\n    }} else {{\n      \
             move 50 centimeters\n      turn right until {{ front{number} }}\n    }}\n  }}\n}}\n\n\
             movement back{number} of rover{number} {{\n  repeat 2 times {{\n    turn left 180\n    move 2 meters\n  \
             }}\n}}\n\n"
        )
    }
}

fn program<S: Shape>(lines: usize) -> String {
    let site = |number: usize| {
        let movements = S::movements(number);
        format!(
            "// site {number}\n\
             wheel left{number} with radius 4.5\n\
             wheel right{number} with radius 4.5\n\
             sensor front{number}\n\
             robot rover{number} type tw with port 23000 has {{ left{number} right{number} }} wheels with sensors {{ front{number} }}\n\n\
             {movements}\
             environment yard{number} has {{ rover{number} }} robots with {{ patrol{number} back{number} }} moves\n\n"
        )
    };
    (0..lines.div_ceil(S::SITE)).map(site).collect()
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

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn lexing<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    bencher.bench(|| lex(black_box(&text)));
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn parsing<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    bencher.bench(|| parse(black_box(&text)));
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn opening<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    bencher.bench(|| opened(black_box(&text)));
}

/// Types and deletes one character, with all diagnostics after each edit.
fn keystroke<S: Shape>(bencher: Bencher, lines: usize, word: &str) {
    let text = program::<S>(lines);
    let (mut database, file) = opened(&text);
    let at = following(&text, word);
    bencher.bench_local(|| {
        database.edit(file, Span::at(at), "x");
        let broken = database.diagnostics(file).len();
        database.edit(file, Span::new(at, at + 1), "");
        (broken, database.diagnostics(file).len())
    });
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn two_keystrokes_in_a_number<S: Shape>(bencher: Bencher, lines: usize) {
    keystroke::<S>(bencher, lines, "move 4");
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn two_keystrokes_in_a_reference<S: Shape>(bencher: Bencher, lines: usize) {
    keystroke::<S>(bencher, lines, " of rover");
}

fn completion<S: Shape>(bencher: Bencher, lines: usize, before: &str) {
    let text = program::<S>(lines);
    let (database, file) = opened(&text);
    let position = ide::FilePosition { file, offset: following(&text, before) };
    bencher.bench_local(|| ide::completions(&database, position, ide::CompletionTrigger::Invoked, 9.0));
}

/// Of many: each site has one.
#[divan::bench(types = [Flat, Nested], args = LINES)]
fn completion_of_a_robot<S: Shape>(bencher: Bencher, lines: usize) {
    completion::<S>(bencher, lines, " of ");
}

/// Of those of the robot.
#[divan::bench(types = [Flat, Nested], args = LINES)]
fn completion_of_a_sensor<S: Shape>(bencher: Bencher, lines: usize) {
    completion::<S>(bencher, lines, "until { ");
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn completion_of_a_statement<S: Shape>(bencher: Bencher, lines: usize) {
    completion::<S>(bencher, lines, S::BEFORE_STATEMENT);
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn hover<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    let (database, file) = opened(&text);
    let position = ide::FilePosition { file, offset: following(&text, "move 4") };
    bencher.bench_local(|| ide::hover(&database, position));
}

/// The fixes of a misspelt name, two of which are validated.
#[divan::bench(types = [Flat, Nested], args = LINES)]
fn quick_fixes<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    let (mut database, file) = opened(&text);
    let at = following(&text, "until { front");
    database.edit(file, Span::at(at), "x");
    bencher.bench_local(|| ide::quick_fixes(&database, file, Span::at(at)).len());
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn hints_of_a_screen<S: Shape>(bencher: Bencher, lines: usize) {
    let text = program::<S>(lines);
    let (database, file) = opened(&text);
    let at = following(&text, "movement ");
    let places = ide::InlayHintPlaces { file, range: Span::new(at, at + 2_000), typed: &[] };
    let mut known = ide::KnownMovements::default();
    bencher.bench_local(|| {
        ide::inlay_hints(&database, places, ide::InlayHintOptions::default(), &mut known).len()
    });
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn semantic_tokens<S: Shape>(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program::<S>(lines));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::semantic_tokens(&file, None)));
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn outline<S: Shape>(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program::<S>(lines));
    bencher.bench_local(|| {
        database.snapshot(file, None).map(|file| ide::document_symbols(&file).collect::<Vec<_>>())
    });
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn folding<S: Shape>(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program::<S>(lines));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::folding_ranges(&file)));
}

#[divan::bench(types = [Flat, Nested], args = LINES)]
fn formatting<S: Shape>(bencher: Bencher, lines: usize) {
    let (database, file) = opened(&program::<S>(lines).replace(" of ", "  of "));
    bencher.bench_local(|| database.snapshot(file, None).map(|file| ide::format(&file)));
}
