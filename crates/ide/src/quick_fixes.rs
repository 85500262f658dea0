//! Quick fixes: the fixes of the diagnostics at a position.

use pydslrep_analysis::{Database, Diagnostic, FileId, Fix, Offers};
use pydslrep_syntax::Span;

/// A fix and its diagnostic.
#[derive(Debug, Clone, PartialEq)]
pub struct QuickFix {
    /// The diagnostic that it fixes.
    pub diagnostic: Diagnostic,
    /// The fix.
    pub fix: Fix,
    /// True for the preferred fix: the only one of its diagnostic, and safe.
    pub is_preferred: bool,
}

/// The maximum number of suggestions: each is validated on a copy of the database, and nobody reads more.
const MAX_SUGGESTIONS: usize = 64;

/// The fixes of all diagnostics that touch a range; the command offers the same ([`Offers`]).
pub fn quick_fixes(database: &Database, file: FileId, range: Span) -> Vec<QuickFix> {
    let mut offers = Offers::new(database, MAX_SUGGESTIONS);
    let mut found = Vec::new();
    for diagnostic in database.diagnostics_at(file, range) {
        let mut fixes = diagnostic.fixes.clone();
        fixes.retain(|fix| offers.include(&diagnostic, fix));
        let is_only = fixes.len() == 1;
        found.extend(fixes.into_iter().map(|fix| QuickFix {
            diagnostic: diagnostic.clone(),
            is_preferred: is_only && fix.safe,
            fix,
        }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixes_are_offered_at_their_diagnostic() {
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

    #[test]
    fn the_port_of_the_other_target_can_be_changed() {
        let (mut database, position) = crate::fixture::at_cursor(
            "wheel a with radius 4\nwheel b with radius 4\n\
             robot r with port 23000 has { a b } wheels\nrobot q with port 1$09999 has { a b } wheels",
        );
        let titles = |database: &Database| -> Vec<(String, bool)> {
            let fixes = quick_fixes(database, position.file, Span::at(position.offset));
            fixes.into_iter().map(|fix| (fix.fix.title, fix.is_preferred)).collect()
        };
        assert_eq!(titles(&database), [("change the port to 23000".to_owned(), false)]);
        database.set_target(position.file, pydslrep_analysis::Target::VRep);
        assert_eq!(titles(&database), []);
    }
}
