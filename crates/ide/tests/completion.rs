//! Completion offers exactly what the grammar allows, including the next word of every program. `PYDSLREP_COMPLETED` says
//! how many random programs are tried.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests are tests, too")]

use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use pydslrep_analysis::{Database, FileId};
use pydslrep_ide::{
    Completion, CompletionKind, CompletionTrigger, Definition, FilePosition, completions, goto_definition,
};
use pydslrep_syntax::{Found, KEYWORDS, Span, SyntaxErrorKind, Token, TokenKind, cut, lex, parse};

/// How many random programs are tried by default.
const COMPLETED: u64 = 20;

/// The paper's programs and variants of them.
fn paper_programs() -> Vec<String> {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests");
    let mut programs = Vec::new();
    for folder in ["paper", "programs"] {
        let mut files: Vec<_> =
            std::fs::read_dir(tests.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.retain(|file| file.extension().is_some_and(|ending| ending == "pyr"));
        files.sort();
        programs.extend(files.into_iter().map(|file| std::fs::read_to_string(file).unwrap()));
    }
    assert!(programs.len() >= 7);
    programs
}

fn tokens(text: &str) -> Vec<Token> {
    lex(text).into_iter().filter(|(token, _)| !token.is_comment()).collect()
}

fn length(text: &str) -> u32 {
    u32::try_from(text.len()).unwrap()
}

fn offered(database: &Database, file: FileId, offset: u32) -> Vec<Completion> {
    completions(database, FilePosition { file, offset }, CompletionTrigger::Invoked, 9.0)
}

/// The first words of the offered items; commas are never offered.
fn words(items: &[Completion]) -> BTreeSet<&str> {
    let words =
        items.iter().filter(|item| matches!(item.kind, CompletionKind::Keyword | CompletionKind::Snippet));
    words.map(|item| item.insert.split_whitespace().next().unwrap()).collect()
}

fn allowed(beginning: &str) -> BTreeSet<&'static str> {
    let mut allowed = pydslrep_naive::continuations(beginning).unwrap_or_else(|| panic!("{beginning}"));
    allowed.remove(",");
    allowed
}

/// Returns whether a text has no error except that it is incomplete.
fn is_beginning(text: &str) -> bool {
    let pieces = parse(text);
    let last = pieces.len() - 1;
    pieces.iter().enumerate().all(|(index, (_, piece))| {
        piece.errors.iter().all(|error| {
            index == last && matches!(&error.kind, SyntaxErrorKind::Missing { found: Found::End, .. })
        })
    })
}

/// Fills names into tab stops without a default.
fn filled_in(insert: &str) -> String {
    (1..9).fold(insert.to_owned(), |text, number| {
        text.replace(&format!("${number} "), "x ").replace(&format!("${number}\n"), "x\n")
    })
}

/// The distinguishing context of a position: the entity's keyword and the last tokens, regardless of names and numbers.
/// (No rule of the grammar looks back further than its own clause, which has fewer than seven tokens.)
fn context(entity: &[Token], may_import: bool) -> (Vec<TokenKind>, bool) {
    let kind = |(token, _): &Token| if *token == TokenKind::Float { TokenKind::Integer } else { *token };
    let last = entity.len().saturating_sub(7).max(1);
    (entity.iter().take(1).chain(entity.iter().skip(last)).map(kind).collect(), may_import)
}

/// Types a program token by token and compares the offered words after each with the reference checker: every offered
/// word can come next in some program, and every such word is offered. (This only holds at the end of the text: in the
/// middle, the text after the cursor may not fit until more is typed.) Inserting an item leaves an incomplete program
/// without other errors.
///
/// Each [`context`] is checked once.
fn check_while_typed(text: &str, seen: &mut HashSet<(Vec<TokenKind>, bool)>) {
    let mut database = Database::new();
    let file = database.open("a.pyr", " ");
    let tokens = tokens(text);
    let starts = cut(text, &tokens);
    let (mut typed, mut entity, mut imports) = (String::new(), Vec::new(), true);
    for index in 0..=tokens.len() {
        let end = if index == 0 { 0 } else { tokens[index - 1].1.end as usize };
        if index > 0 {
            let token = tokens[index - 1];
            if starts.contains(&(index - 1)) {
                entity.clear();
                imports &= token.0 == TokenKind::Import;
            }
            entity.push(token);
        }
        if !seen.insert(context(&entity, imports)) {
            continue;
        }
        let more = &text[typed.len()..end];
        database.edit(file, Span::at(length(&typed)), more);
        typed.push_str(more);
        let start = database.entity_at(file, length(&typed)).unwrap().span.start;
        let items = offered(&database, file, length(&typed) + 1);
        let begun = &typed[start as usize..];
        // Earlier entities only matter for imports.
        let beginning = if imports { typed.clone() } else { format!("sensor s {begun}") };
        assert_eq!(words(&items), allowed(&beginning), "after {begun:?}");
        for mut item in items.into_iter().filter(|item| !matches!(item.kind, CompletionKind::Reference(_))) {
            item.insert = filled_in(&item.insert);
            let whole = format!("{begun} {}", item.plain());
            // Without a name after it, `} wheel` is a typo of `} wheels`; without `until`, `move at` lacks its distance.
            let ends = ["", " x", " 9 until { x }"];
            assert!(ends.iter().any(|end| is_beginning(&format!("{whole}{end}"))), "{whole:?}");
        }
    }
}

#[test]
fn the_words_offered_are_those_that_fit() {
    let mut seen = HashSet::new();
    for text in paper_programs() {
        check_while_typed(&text, &mut seen);
    }
    let count =
        std::env::var("PYDSLREP_COMPLETED").ok().and_then(|count| count.parse().ok()).unwrap_or(COMPLETED);
    for seed in 0..count {
        check_while_typed(&pydslrep_naive::program(seed, 30), &mut seen);
    }
    let imports = pydslrep_naive::Recipe { imports: true, lines: 5, ..pydslrep_naive::Recipe::default() };
    for seed in 0..count / 10 {
        check_while_typed(&imports.seeded(seed), &mut seen);
    }
    assert!(seen.len() > 1_000, "only {} places", seen.len());
    let contextual = [TokenKind::Distance, TokenKind::Bumper, TokenKind::Import];
    for (token, word) in KEYWORDS.iter().filter(|(token, _)| token.is_keyword() || contextual.contains(token))
    {
        let used = |(tokens, _): &(Vec<TokenKind>, bool)| tokens.contains(token);
        assert!(seen.iter().any(used), "no program has `{word}`");
    }
}

/// Returns whether completion can offer a token: a keyword, a brace, or a declared name.
fn can_be_offered(database: &Database, file: FileId, token: TokenKind, span: Span) -> bool {
    if token == TokenKind::Comma || token.is_number() || token == TokenKind::String {
        return false;
    }
    let declared = |offset| goto_definition(database, FilePosition { file, offset });
    let is_declaration =
        |found: Definition| found.targets.iter().any(|target| target.file == file && target.focus == span);
    !token.is_name() || declared(span.start).is_some_and(|found| !is_declaration(found))
}

/// Checks that a word typed up to `typed` and followed by `after` is replaced and offered.
fn check_half_typed(before: &str, word: &str, typed: usize, after: &str) {
    let mut database = Database::new();
    let file = database.open("a.pyr", &format!("{before}{}{after}", &word[..typed]));
    let items = offered(&database, file, length(before) + u32::try_from(typed).unwrap());
    let place = || format!("{:?}|{:?}", &before[before.len().saturating_sub(60)..], &word[..typed]);
    let begins = |item: &&Completion| item.insert.split_whitespace().next() == Some(word);
    let Some(item) = items.iter().find(begins) else { panic!("no {word:?} at {}", place()) };
    let replaced = Span::new(length(before), length(before) + u32::try_from(typed).unwrap());
    assert_eq!(item.replace, replaced, "{word:?} at {}", place());
}

#[test]
fn a_half_typed_word_is_replaced_by_what_it_was_going_to_be() {
    for text in paper_programs() {
        let mut database = Database::new();
        let file = database.open("a.pyr", &text);
        for (token, span) in tokens(&text) {
            if !can_be_offered(&database, file, token, span) {
                continue;
            }
            let (start, end) = (span.start as usize, span.end as usize);
            let word = &text[start..end];
            // Right after a word, the cursor is still in that word.
            let touches = text[..start].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
            // Almost complete words are not offered.
            for typed in usize::from(touches)..word.len().saturating_sub(3) {
                // A complete keyword such as `wheel` gets no list.
                if !token.is_name() && KEYWORDS.iter().any(|(_, keyword)| *keyword == &word[..typed]) {
                    continue;
                }
                check_half_typed(&text[..start], word, typed, &text[end..]);
                if !token.is_name() {
                    check_half_typed(&text[..start], word, typed, "");
                }
            }
        }
    }
}

/// The labels of the items at `$0`.
fn labels(fixture: &str) -> Vec<String> {
    let offset = fixture.find("$0").unwrap();
    let mut database = Database::new();
    let file = database.open("a.pyr", &fixture.replace("$0", ""));
    offered(&database, file, u32::try_from(offset).unwrap()).into_iter().map(|item| item.label).collect()
}

#[test]
fn the_body_of_a_misspelt_declaration_completes() {
    const BEFORE: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\n\
                          robot r with port 1 has { a b } wheels with sensors { s }\n";
    for (misspelt, right) in [
        ("movment m of r {\n  m$0\n}", "movement m of r {\n  m$0\n}"),
        ("Movement m of r {\n  move 2 $0\n}", "movement m of r {\n  move 2 $0\n}"),
        ("movemnet m of $0", "movement m of $0"),
        ("enviroment e has { $0 } robots", "environment e has { $0 } robots"),
        ("robbot q type $0 with port 2 has { } wheels", "robot q type $0 with port 2 has { } wheels"),
    ] {
        // Even with other errors.
        for before in [BEFORE.to_owned(), format!("{BEFORE}wheel c radius 4\n")] {
            let found = labels(&format!("{before}{misspelt}"));
            assert!(!found.is_empty(), "{misspelt}");
            assert_eq!(found, labels(&format!("{before}{right}")), "{misspelt}");
        }
    }
}
