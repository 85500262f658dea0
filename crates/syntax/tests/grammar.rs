//! The published grammar and the lexer have the same words.

use std::collections::BTreeSet;

use pydslrep_syntax::KEYWORDS;

const GRAMMAR: &str = include_str!("../../../grammar/pydslrep.ebnf");

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
