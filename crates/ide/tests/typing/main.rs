//! Measures how much completion helps: types the paper's programs, the examples and generated ones optimally, key by
//! key. The figures are in `docs/performance.md`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, too")]

mod keys;
mod ranks;
mod snippet;
mod typed;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use expect_test::expect_file;
use pydslrep_naive::Recipe;

use self::keys::keys;
use self::ranks::{Ranks, ranks};

/// The maximum ratio of keys to characters over all programs.
const MAX_KEYS: f64 = 0.55;
/// The minimum share of positions where the next word ranks first.
const FIRST: f64 = 0.9;
/// How many generated programs are typed.
const GENERATED: u64 = 10;

struct Program {
    name: String,
    text: String,
}

struct Figures {
    name: String,
    characters: usize,
    /// Characters in comments, which cannot be completed.
    comments: usize,
    keys: usize,
    ranks: Ranks,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn in_folder(folder: &str) -> Vec<Program> {
    let files = std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        files.filter(|file| file.extension().is_some_and(|extension| extension == "pyr")).collect();
    files.sort();
    let program = |file: PathBuf| Program {
        name: file.file_stem().unwrap().to_string_lossy().into_owned(),
        text: pydslrep_syntax::format(&std::fs::read_to_string(&file).unwrap()),
    };
    files.into_iter().map(program).collect()
}

fn generated() -> Vec<Program> {
    let recipe =
        Recipe { lines: 8, mistakes: false, odd_layout: false, older_spellings: false, ..Recipe::default() };
    let program = |seed: u64| Program {
        name: format!("generated_{seed:02}"),
        text: pydslrep_syntax::format(&recipe.seeded(seed)),
    };
    (0..GENERATED).map(program).collect()
}

fn figures(program: &Program) -> Figures {
    Figures {
        name: program.name.clone(),
        characters: program.text.chars().count(),
        comments: comments(&program.text),
        keys: keys(&program.text),
        ranks: ranks(&program.text),
    }
}

fn comments(text: &str) -> usize {
    let tokens = pydslrep_syntax::lex(text);
    let comments = tokens.iter().filter(|(token, _)| token.is_comment());
    comments.map(|(_, span)| span.text(text).chars().count()).sum()
}

fn total(name: &str, parts: &[Figures]) -> Figures {
    let ranks = parts.iter().fold(Ranks::default(), |sum, part| sum.and(&part.ranks));
    Figures {
        name: name.to_owned(),
        characters: parts.iter().map(|part| part.characters).sum(),
        comments: parts.iter().map(|part| part.comments).sum(),
        keys: parts.iter().map(|part| part.keys).sum(),
        ranks,
    }
}

#[allow(clippy::cast_precision_loss, reason = "programs are short")]
fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}

fn table(rows: &[Figures]) -> String {
    let mut table = String::from(
        "| program | characters | of these comments | keys | saved | places | word is first |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let saved = 100.0 * (1.0 - share(row.keys, row.characters));
        let first = 100.0 * share(row.ranks.first, row.ranks.places);
        writeln!(
            table,
            "| {} | {} | {} | {} | {saved:.0} % | {} | {first:.0} % |",
            row.name, row.characters, row.comments, row.keys, row.ranks.places
        )
        .unwrap();
    }
    table
}

#[test]
fn completion_saves_half_the_keys_and_has_the_right_word_first() {
    let mut rows: Vec<Figures> =
        in_folder("tests/paper").iter().chain(&in_folder("examples")).map(figures).collect();
    let generated: Vec<Figures> = generated().iter().map(figures).collect();
    let written = total("all of these", &rows);
    for figures in rows.iter().chain(&generated) {
        assert!(figures.keys < figures.characters, "{}", figures.name);
    }
    rows.push(written);
    rows.push(total(&format!("{GENERATED} generated programs"), &generated));
    for row in &rows[rows.len() - 2..] {
        assert!(share(row.keys, row.characters) <= MAX_KEYS, "{} keys of {}", row.keys, row.characters);
        assert!(share(row.ranks.first, row.ranks.places) >= FIRST, "{:?}", row.ranks);
    }
    let page = root().join("docs/performance.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let (start, end) = ("<!-- typing: made by crates/ide/tests/typing -->\n", "<!-- end of typing -->");
    let (before, rest) = text.split_once(start).unwrap();
    let (_, after) = rest.split_once(end).unwrap();
    expect_file![page].assert_eq(&format!("{before}{start}\n{}\n{end}{after}", table(&rows)));
}
