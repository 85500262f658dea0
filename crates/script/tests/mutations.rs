//! Nested programs with one wrong token: they are checked, formatted, planned and become scripts without a panic, and one
//! mistake stays about one message. `PYDSLREP_MUTATIONS` says how many to try.

use pydslrep_analysis::{Database, FileId, Target};
use pydslrep_naive::{Recipe, Statements, mutated};
use pydslrep_syntax::format;

const MUTATIONS: u64 = 200;

/// Messages that one mistake may cost, and how many programs in a hundred may cost more.
const MESSAGES: usize = 2;
const EXCEPTIONS: u64 = 5;

fn how_many() -> u64 {
    std::env::var("PYDSLREP_MUTATIONS").ok().and_then(|count| count.parse().ok()).unwrap_or(MUTATIONS)
}

fn opened(text: &str) -> (Database, FileId) {
    let mut database = Database::new();
    let file = database.open("random.pyr", text);
    (database, file)
}

/// The number of syntax errors, including those of single characters.
fn syntax_errors(text: &str) -> usize {
    let (database, file) = opened(text);
    let diagnostics = database.diagnostics(file);
    let found = diagnostics.iter().map(pydslrep_analysis::Diagnostic::code);
    found.filter(|code| ["syntax-error", "invalid-character"].contains(code)).count()
}

/// Plans the environments of a program and makes their scripts.
fn plan_and_generate(text: &str) {
    let (database, file) = opened(text);
    for (id, _) in database.environments(file) {
        let Ok(environment) = database.environment(id) else { continue };
        let scene = pydslrep_analysis::scene(&environment);
        let plan = pydslrep_analysis::plan(&environment, &scene);
        assert!(plan.is_ok(), "robots of default size can be planned");
        for target in Target::ALL {
            // Some have no script, such as those whose names are too long; the test looks for panics only.
            let _ = pydslrep_script::generate(&environment, target, "random.pyr");
        }
    }
}

#[test]
fn one_wrong_token_costs_about_one_message() {
    let recipe = Recipe {
        lines: 40,
        mistakes: false,
        odd_layout: false,
        older_spellings: false,
        imports: false,
        statements: Statements::Any,
    };
    let (mut tried, mut costly) = (0, Vec::new());
    for seed in 0..how_many() {
        let text = mutated(&recipe.seeded(seed), seed, 1);
        let formatted = format(&text);
        assert_eq!(format(&formatted), formatted, "formatting again changes something:\n{text}");
        plan_and_generate(&text);
        let errors = syntax_errors(&text);
        tried += 1;
        if errors > MESSAGES {
            costly.push((errors, text));
        }
    }
    let first = costly.iter().max_by_key(|(errors, _)| *errors);
    assert!(
        costly.len() as u64 * 100 <= tried * EXCEPTIONS,
        "{} of {tried}, such as {first:?}",
        costly.len()
    );
}
