//! The language reference has the pages of keywords that hovers show, and the published grammar: what is between comments
//! in `docs/language.md` is written from them (`UPDATE_EXPECT=1 cargo test -p pydslrep-ide --test language_page`).

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, too")]

use std::fmt::Write as _;
use std::path::Path;

use expect_test::expect_file;
use pydslrep_ide::{KeywordPage, keyword_page};
use pydslrep_syntax::{KEYWORDS, TokenKind};

const GRAMMAR: &str = include_str!("../../../grammar/pydslrep.ebnf");
const START: &str = "<!-- from the code: ";
const END: &str = "<!-- end -->";

/// Returns the text between the comments with this name: a keyword, `contextual`, `keywords` or `grammar`.
fn generated(name: &str) -> String {
    match name {
        "grammar" => format!("```ebnf\n{GRAMMAR}```"),
        "contextual" => TokenKind::CONTEXTUAL.map(quoted).join(", "),
        "keywords" => table(),
        word => section(&page_of(word)),
    }
}

fn quoted(token: TokenKind) -> String {
    format!("`{}`", token.spelling().unwrap())
}

fn page_of(word: &str) -> KeywordPage {
    let token = KEYWORDS.iter().find(|(_, spelling)| *spelling == word);
    token.and_then(|(token, _)| keyword_page(*token)).unwrap_or_else(|| panic!("no keyword `{word}`"))
}

fn section(page: &KeywordPage) -> String {
    format!(
        "```text\n{}\n```\n\n{}\n\n```pydslrep fragment\n{}\n```",
        page.syntax, page.meaning, page.example
    )
}

fn table() -> String {
    let mut table = "| keyword | syntax | meaning |\n|---|---|---|".to_owned();
    for (_, word) in KEYWORDS {
        let page = page_of(word);
        let forms: Vec<String> =
            page.syntax.lines().map(|form| format!("`{}`", form.replace('|', "\\|"))).collect();
        write!(table, "\n| `{word}` | {} | {} |", forms.join("<br>"), page.meaning).unwrap();
    }
    table
}

#[test]
fn the_language_page_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/language.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let mut parts = page.split(START);
    let mut expected = parts.next().unwrap().to_owned();
    for part in parts {
        let (name, rest) = part.split_once(" -->\n").unwrap();
        let (_, after) = rest.split_once(END).unwrap();
        write!(expected, "{START}{name} -->\n\n{}\n\n{END}{after}", generated(name)).unwrap();
    }
    expect_file![path].assert_eq(&expected);
    for token in TokenKind::ACTIONS.into_iter().chain(TokenKind::DRIVES) {
        let (mark, word) = (format!("{START}{} -->", token.spelling().unwrap()), quoted(token));
        assert!(
            page.contains(&mark),
            "docs/language.md has no section of {word}: write `{mark}` and `{END}` below a heading"
        );
    }
}
