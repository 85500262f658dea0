//! Whatever lists keywords beside `token.rs`: the published grammar is held against it, and the lists of grammars and
//! editors are written from it (`UPDATE_EXPECT=1 cargo test -p pydslrep-syntax --test keywords`).

#![allow(clippy::unwrap_used, reason = "helpers of tests are tests, too")]

use std::collections::BTreeSet;
use std::path::Path;

use pydslrep_syntax::ast::Drive;
use pydslrep_syntax::{KEYWORDS, TokenKind};

const GRAMMAR: &str = include_str!("../../../grammar/pydslrep.ebnf");

/// Lines are no longer than this.
const WIDTH: usize = 120;

/// The quoted words of the rules, those of the tokens' own rules left out.
fn quoted_words() -> BTreeSet<&'static str> {
    let (rules, _) = GRAMMAR.split_once("(* Tokens.").unwrap_or((GRAMMAR, ""));
    let is_word = |text: &&str| text.chars().all(|c| c.is_ascii_alphabetic()) && !text.is_empty();
    rules.split('"').skip(1).step_by(2).filter(is_word).collect()
}

#[test]
fn the_grammar_has_every_keyword_and_no_other() {
    let keywords: BTreeSet<&str> = KEYWORDS.iter().map(|(_, word)| *word).collect();
    assert_eq!(quoted_words(), keywords);
}

#[test]
fn the_grammar_names_the_contextual_words() {
    let (_, tokens) = GRAMMAR.split_once("(* Tokens.").unwrap();
    let (comment, _) = tokens.split_once("*)").unwrap();
    let named: Vec<&str> = comment.split('"').skip(1).step_by(2).collect();
    assert_eq!(named, words(|kind| !kind.is_keyword()));
}

/// The words for types of robots, quoted, with `separator` between them.
fn drives(separator: &str) -> String {
    Drive::ALL.map(|drive| format!("\"{}\"", drive.word())).join(separator)
}

#[test]
fn the_grammars_have_every_type_of_robot() {
    assert!(GRAMMAR.contains(&format!("\"type\" ( {} )", drives(" | "))), "grammar/pydslrep.ebnf");
    let tree_sitter = include_str!("../../../grammar/tree-sitter/grammar.js");
    let clause = format!("incomplete(\"type\", choice({}))", drives(", "));
    assert!(tree_sitter.contains(&clause), "grammar/tree-sitter/grammar.js has no {clause}");
}

/// The words of the keywords that fulfil a condition.
fn words(condition: impl Fn(TokenKind) -> bool) -> Vec<&'static str> {
    KEYWORDS.iter().filter(|(kind, _)| condition(*kind)).map(|(_, word)| *word).collect()
}

/// The words of an action that is nothing but its keyword: tree-sitter calls the node what it calls the word.
fn is_node(kind: TokenKind) -> bool {
    kind.examples() == [kind.spelling().unwrap_or_default()]
}

/// Words on as many lines as they need, all of them indented.
fn wrapped(words: &[String], indent: &str) -> String {
    let mut lines = vec![String::new()];
    for word in words {
        let last = lines.last_mut().unwrap();
        if last.is_empty() {
            *last = format!("{indent}{word}");
        } else if last.len() + 1 + word.len() <= WIDTH - 3 {
            *last += &format!(" {word}");
        } else {
            lines.push(format!("{indent}{word}"));
        }
    }
    lines.join("\n")
}

fn quoted(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| format!("\"{word}\"")).collect()
}

/// Holds the lines of a file between its two comments that name `list` against `lines`.
#[track_caller]
fn check(path: &str, list: &str, lines: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let text = std::fs::read_to_string(&path).unwrap();
    let begin = text.find(&format!("{list}, which crates/syntax/tests/keywords.rs writes")).unwrap();
    let begin = begin + text[begin..].find('\n').unwrap() + 1;
    let end = begin + text[begin..].find("End of the").unwrap();
    let end = text[..end].rfind('\n').unwrap() + 1;
    let expected = format!("{}{lines}\n{}", &text[..begin], &text[end..]);
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, &expected).unwrap();
    } else {
        assert!(text == expected, "{} has other keywords; UPDATE_EXPECT=1 writes them", path.display());
    }
}

#[test]
fn tree_sitter_queries_have_the_keywords() {
    let nodes: Vec<String> = words(is_node).iter().map(|node| format!("({node}) @keyword\n")).collect();
    let nodes = nodes.concat();
    let tokens = wrapped(&quoted(&words(|kind| !is_node(kind))), "  ");
    let reserved = wrapped(&quoted(&words(TokenKind::is_keyword)), "    ");
    let lines = format!(
        "[\n{tokens}\n] @keyword\n{nodes}((ERROR (name) @keyword)\n  (#any-of? @keyword\n{reserved}))"
    );
    check("grammar/tree-sitter/queries/highlights.scm", "The keywords", &lines);
    let actions: Vec<String> = words(TokenKind::is_action).iter().map(|word| format!("({word})")).collect();
    let lines = format!("[{}] @statement.outer", actions.join(" "));
    check("grammar/tree-sitter/queries/textobjects.scm", "The actions", &lines);
}

#[test]
fn emacs_has_the_keywords() {
    let list = |name: &str, words: &[String], doc: &str| {
        format!("(defconst {name}\n  '(\n{})\n  \"{doc}\")", wrapped(words, "    "))
    };
    let nodes: Vec<String> = words(is_node).into_iter().map(str::to_owned).collect();
    let lines = [
        list(
            "pydslrep-keywords",
            &quoted(&words(TokenKind::is_keyword)),
            "The keywords; contextual ones are left out.",
        ),
        list(
            "pydslrep-keyword-tokens",
            &quoted(&words(|kind| !is_node(kind))),
            "The keywords that are tokens of the parser.",
        ),
        list("pydslrep-keyword-nodes", &nodes, "The keywords that are nodes of the parser."),
    ];
    check("editors/emacs/pydslrep-mode.el", "The keywords", &lines.join("\n\n"));
}

#[test]
fn kakoune_has_the_keywords() {
    let reserved = words(TokenKind::is_keyword).join("|");
    let lines =
        format!(r"add-highlighter shared/pydslrep/code/ regex '(?<![\w^])({reserved})(?!\w)' 0:keyword");
    check("editors/kakoune/pydslrep.kak", "The keywords", &lines);
    let actions = words(|kind| kind.only_before().has(TokenKind::Integer)).join("|");
    let lines = format!(
        r"add-highlighter shared/pydslrep/code/ regex '(?<!ip\s)(?<![\w^])({actions})\s+(?:-?\d+(?:\.\d+)?(?![.\d])|until(?!\w))' 1:keyword"
    );
    check("editors/kakoune/pydslrep.kak", "The actions before a number", &lines);
}

#[test]
fn neovim_has_the_keywords() {
    // Those that a name follows are written there with the group of the name.
    let is_before_name = |kind: TokenKind| {
        kind == TokenKind::Of || kind.entity_kind().is_some() && kind != TokenKind::Parallel
    };
    let others = words(|kind| kind.is_keyword() && !is_before_name(kind));
    let others: Vec<String> = others.into_iter().map(str::to_owned).collect();
    let indent = "syn keyword pydslrepKeyword ";
    check("editors/neovim/syntax/pydslrep.vim", "The other keywords", &wrapped(&others, indent));
    // Those outside of movements are written there with what is around them, and so is `do` with its name.
    let elsewhere = [TokenKind::Distance, TokenKind::Bumper, TokenKind::Import, TokenKind::Do];
    let contextual = words(|kind| !kind.is_keyword() && !elsewhere.contains(&kind));
    let contextual: Vec<String> = contextual.into_iter().map(str::to_owned).collect();
    let lines = wrapped(&contextual, "syn keyword pydslrepWord contained ");
    check("editors/neovim/syntax/pydslrep.vim", "The contextual keywords", &lines);
}
