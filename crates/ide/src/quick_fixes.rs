//! Quick fixes: the edits that mend the problems at a place.

use pydslrep_analysis::{Database, Diagnostic, FileId, Fix};
use pydslrep_syntax::Span;

/// A fix with the problem it mends.
#[derive(Debug, Clone, PartialEq)]
pub struct QuickFix {
    /// What it mends.
    pub diagnostic: Diagnostic,
    /// How.
    pub fix: Fix,
    /// Whether it can be taken for granted: the only fix of its problem, and a safe one.
    pub is_preferred: bool,
}

/// The fixes of all problems that touch a range.
pub fn quick_fixes(database: &Database, file: FileId, range: Span) -> Vec<QuickFix> {
    let touching =
        |diagnostic: &Diagnostic| diagnostic.span.start <= range.end && range.start <= diagnostic.span.end;
    let diagnostics = database.diagnostics(file).into_iter().filter(touching);
    diagnostics
        .flat_map(|diagnostic| {
            let only = diagnostic.fixes.len() == 1;
            diagnostic.fixes.clone().into_iter().map(move |fix| QuickFix {
                diagnostic: diagnostic.clone(),
                is_preferred: only && fix.safe,
                fix,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixes_are_found_where_their_problem_is() {
        let mut database = Database::new();
        let file = database.open("a.pyr", "wheel a radius 4\nwheel b with radius 450");
        let titles = |from, to| -> Vec<(String, bool)> {
            let fixes = quick_fixes(&database, file, Span::new(from, to));
            fixes.into_iter().map(|fix| (fix.fix.title, fix.is_preferred)).collect()
        };
        assert_eq!(titles(7, 7), [("insert `with`".to_owned(), true)]);
        assert_eq!(titles(38, 40), [("change to 45".to_owned(), false)]);
        assert_eq!(titles(18, 20), []);
    }
}
