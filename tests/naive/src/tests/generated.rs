//! Random programs with the statements of "The language grows".

use crate::program::{Action, ActionKind, Body};
use crate::tokens::{Kind, Token};
use crate::{Recipe, Statements, check, grammar, mutated, tokens};

const PROGRAMS: u64 = 300;

fn recipe(statements: Statements) -> Recipe {
    Recipe { lines: 40, statements, ..Recipe::default() }
}

/// Each statement of a program, and how many blocks it is in.
fn statements(text: &str) -> Vec<(String, usize)> {
    let program = grammar::read(&tokens::read(text).0, text.len()).expect("a program");
    let mut found = Vec::new();
    for entity in &program.entities {
        if let Body::Movement(movement) = &entity.body {
            collect(text, &movement.actions, 0, &mut found);
        }
    }
    found
}

fn collect(text: &str, actions: &[Action], depth: usize, found: &mut Vec<(String, usize)>) {
    for action in actions {
        found.push((text[action.keyword.clone()].to_owned(), depth));
        for part in std::iter::successors(Some(action), |action| action.else_if()) {
            for block in part.blocks() {
                collect(text, &block.actions, depth + 1, found);
            }
        }
    }
}

fn words(text: &str) -> Vec<Token> {
    tokens::read(text).0
}

#[test]
fn a_good_share_is_flat_and_some_is_deeper_than_it_may_be() {
    let deepest =
        |seed| statements(&recipe(Statements::Any).seeded(seed)).iter().map(|(_, depth)| *depth).max();
    let depths: Vec<usize> = (0..PROGRAMS).filter_map(deepest).collect();
    let share =
        |fits: fn(&usize) -> bool| depths.iter().filter(|depth| fits(depth)).count() * 100 / depths.len();
    assert!(share(|depth| *depth == 0) >= 25, "{depths:?}");
    assert!(share(|depth| *depth >= 3) >= 25, "{depths:?}");
    assert!(share(|depth| *depth == 16) >= 2, "{depths:?}");
    assert!(share(|depth| *depth > 16) >= 2, "{depths:?}");
}

#[test]
fn every_statement_occurs() {
    let all: Vec<(String, usize)> =
        (0..PROGRAMS).flat_map(|seed| statements(&recipe(Statements::Any).seeded(seed))).collect();
    for word in ["move", "turn", "wait", "repeat", "if", "do", "slam"] {
        let count = all.iter().filter(|(other, _)| other == word).count();
        let in_blocks = all.iter().filter(|(other, depth)| other == word && *depth > 0).count();
        assert!(count >= 50 && in_blocks >= 8, "{count} `{word}`, {in_blocks} in blocks");
    }
}

#[test]
fn flat_programs_have_only_old_statements_and_names() {
    for seed in 0..PROGRAMS {
        let text = recipe(Statements::Flat).seeded(seed);
        for token in words(&text) {
            let is_new =
                ["wait", "repeat", "if", "else", "do", "times", "clear", "detect", "within", "seconds", "in"]
                    .contains(&token.text.as_str());
            assert!(!is_new, "seed {seed}: {}", token.text);
        }
        assert!(statements(&text).iter().all(|(word, depth)| *depth == 0 && word != "wait"), "seed {seed}");
    }
}

#[test]
fn known_programs_have_a_plan_and_no_errors() {
    let recipe = Recipe { mistakes: false, older_spellings: false, ..recipe(Statements::Known) };
    let (mut nested, mut done) = (0, 0);
    for seed in 0..PROGRAMS {
        let text = recipe.seeded(seed);
        let is_unknown =
            |token: &Token| token.kind == Kind::Keyword && ["until", "slam"].contains(&token.text.as_str());
        assert!(!words(&text).iter().any(is_unknown), "seed {seed}:\n{text}");
        let statements = statements(&text);
        assert!(statements.iter().all(|(word, _)| word != "if"), "seed {seed}:\n{text}");
        nested += usize::from(statements.iter().any(|(_, depth)| *depth > 1));
        done += usize::from(statements.iter().any(|(word, _)| word == "do"));
        let errors =
            ["invalid-time", "invalid-arc", "number-out-of-range", "recursive-movement", "nested-too-deep"];
        let verdict = check(&text);
        let is_error = |code: &&str| verdict.findings.iter().any(|finding| finding.code == *code);
        assert!(!errors.iter().any(is_error), "seed {seed}: {verdict:?}\n{text}");
        assert!(verdict.excused.is_empty(), "seed {seed}: {verdict:?}\n{text}");
    }
    assert!(nested * 2 > 300 && done * 3 > 300, "{nested} nested, {done} do another");
}

#[test]
fn mutations_are_reproducible_and_change_about_one_token() {
    let mut grammatical = 0;
    for seed in 0..PROGRAMS {
        let text = recipe(Statements::Any).seeded(seed);
        let changed = mutated(&text, seed, 1);
        assert_eq!(changed, mutated(&text, seed, 1));
        grammatical += u64::from(check(&changed).grammatical);
    }
    assert!(grammatical * 20 > PROGRAMS && grammatical * 2 < PROGRAMS, "{grammatical} of {PROGRAMS}");
}

#[test]
fn an_else_if_is_a_statement_of_its_own() {
    let text =
        "movement m of r { if { a } clear { slam } else if { a } clear { do m } else { wait 1 seconds } }";
    let program = grammar::read(&words(text), text.len()).expect("a program");
    let Body::Movement(movement) = &program.entities[0].body else { panic!("no movement") };
    let kinds: Vec<&str> = movement.statements().iter().map(|action| &text[action.keyword.clone()]).collect();
    assert_eq!(kinds, ["if", "slam", "if", "do", "wait"]);
    assert!(matches!(movement.actions[0].kind, ActionKind::If { .. }));
}
