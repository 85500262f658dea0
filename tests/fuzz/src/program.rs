//! Bytes as a program: lexer, parser, checks and formatter.

use pydslrep_analysis::{Database, Diagnostic, Severity};
use pydslrep_syntax::{format, lex};

/// Inputs are cut here: longer ones are slower, and find no more.
const MAX_LENGTH: usize = 4096;

/// Checks and formats a program. Formatting twice is formatting once, and it breaks no program.
pub(crate) fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(&data[..data.len().min(MAX_LENGTH)]);
    assert!(lex(&text).windows(2).all(|pair| pair[0].1.end <= pair[1].1.start), "tokens overlap");
    let formatted = format(&text);
    assert_eq!(format(&formatted), formatted, "not stable: {text:?}");
    if !has_errors(&text) {
        assert!(!has_errors(&formatted), "broken by formatting: {text:?}");
    }
}

fn has_errors(text: &str) -> bool {
    let mut database = Database::new();
    let file = database.open("/fuzz/main.pyr", text);
    let diagnostics = database.diagnostics(file);
    let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
    assert!(diagnostics.iter().all(|found| found.span.end <= length), "a problem after the end: {text:?}");
    let is_error = |found: &Diagnostic| found.severity == Severity::Error;
    diagnostics.iter().any(is_error)
}
