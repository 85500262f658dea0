//! Fixes tried on a copy of the database, to see what they leave.

use std::collections::BTreeMap;

use pydslrep_syntax::offset;

use crate::{Database, Diagnostic, Edit, FileId, Fix, Severity};

/// The maximum number of steps for trying suggestions, each about as long as looking at one problem: as one suggestion
/// takes longer the more problems a file has, all of them would take the square of their number. It is a second.
const MAX_STEPS: usize = 4_000_000;

/// Steps for each entity that is checked again.
const STEPS_OF_A_CHECK: usize = 64;

/// Which fixes are offered to people: safe ones, and suggestions that hold when they are tried. Trying takes its time, so
/// that only so many suggestions are tried, in so many steps, and those beyond are not offered.
#[derive(Debug)]
pub struct Offers<'a> {
    database: &'a Database,
    validator: Option<FixValidator>,
    left: usize,
}

impl<'a> Offers<'a> {
    /// Offers for a database as it is now, of at most so many suggestions.
    pub fn new(database: &'a Database, most_suggestions: usize) -> Self {
        Self { database, validator: None, left: most_suggestions }
    }

    /// Returns whether to offer a fix.
    pub fn include(&mut self, problem: &Diagnostic, fix: &Fix) -> bool {
        if fix.safe {
            return true;
        }
        let validator = self.validator.get_or_insert_with(|| FixValidator::new(self.database));
        if self.left == 0 || validator.steps >= MAX_STEPS {
            return false;
        }
        self.left -= 1;
        validator.holds(problem, fix)
    }

    /// Leaves of each problem only the fixes that are offered.
    pub fn retain(&mut self, problems: &mut [Diagnostic]) {
        for problem in problems {
            let fixes = std::mem::take(&mut problem.fixes);
            problem.fixes = fixes.into_iter().filter(|fix| self.include(problem, fix)).collect();
        }
    }
}

/// A database to try fixes in; the one it was made of stays as it is.
#[derive(Debug)]
pub struct FixValidator {
    tried: Database,
    /// The number of problems compared so far, plus [`STEPS_OF_A_CHECK`] for each entity that was checked again.
    steps: usize,
}

/// The number of problems by file and code. Hints are left out: they point at possible improvements, which fixing
/// something may well lead to.
type Counts = BTreeMap<(FileId, &'static str), usize>;

/// The problems of some files.
#[derive(Debug, Default)]
struct Found {
    counts: Counts,
    /// The number of mistakes up to the one that a problem is about; 0 for other problems.
    understood: usize,
}

impl FixValidator {
    /// Validates fixes for a database as it is now.
    pub fn new(database: &Database) -> Self {
        Self { tried: database.clone(), steps: 0 }
    }

    /// Returns whether a fix solves its problem and brings no other into the files it changes. Problems in text that
    /// was not understood before were hidden, and do not count; nor does a mistake that comes to light after it,
    /// because more of the text is understood.
    pub fn holds(&mut self, problem: &Diagnostic, fix: &Fix) -> bool {
        let mut files: Vec<FileId> = fix.edits.iter().map(|edit| edit.file).collect();
        files.push(problem.file);
        files.sort_unstable();
        files.dedup();
        let before = self.look(&files, problem);
        let back = self.apply(&fix.edits);
        let after = self.look(&files, problem);
        self.apply(&back);
        let count = |counts: &Counts, key: &(FileId, &'static str)| counts.get(key).copied().unwrap_or(0);
        let key = (problem.file, problem.code());
        let is_brought =
            |key: &(FileId, &'static str)| count(&after.counts, key) > count(&before.counts, key);
        let is_solved =
            count(&after.counts, &key) < count(&before.counts, &key) || after.understood < before.understood;
        is_solved && !after.counts.keys().any(is_brought)
    }

    fn look(&mut self, files: &[FileId], problem: &Diagnostic) -> Found {
        let of_text = problem.rule.is_of_text();
        let mut found = Found::default();
        for file in files {
            self.tried.visit_diagnostics(*file, |rule, severity, start| {
                self.steps += 1;
                let is_like_it = rule == problem.rule;
                if is_like_it || (severity > Severity::Hint && (!of_text || rule.is_of_text())) {
                    *found.counts.entry((*file, rule.code)).or_default() += 1;
                }
                let is_before = of_text && *file == problem.file && start <= problem.span.start;
                found.understood += usize::from(is_before && rule.is_of_text());
            });
        }
        found
    }

    /// Makes edits that are apart from each other; returns those that take them back.
    fn apply(&mut self, edits: &[Edit]) -> Vec<Edit> {
        let mut edits: Vec<&Edit> = edits.iter().collect();
        edits.sort_by_key(|edit| std::cmp::Reverse((edit.file, edit.span.start, edit.span.end)));
        let mut back: Vec<Edit> = Vec::new();
        for edit in edits {
            let removed = self.tried.slice(edit.file, edit.span);
            self.tried.edit(edit.file, edit.span, &edit.text);
            self.steps += self.tried.last_edit().revalidated * STEPS_OF_A_CHECK;
            let following = edit.span.start + offset(edit.text.len());
            let grown = i64::from(following) - i64::from(edit.span.end);
            for later in back.iter_mut().filter(|later| later.file == edit.file) {
                let moved = |offset: u32| u32::try_from(i64::from(offset) + grown).unwrap_or_default();
                later.span = pydslrep_syntax::Span::new(moved(later.span.start), moved(later.span.end));
            }
            let span = pydslrep_syntax::Span::new(edit.span.start, following);
            back.push(Edit { file: edit.file, span, text: removed });
        }
        back
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The titles of the fixes that hold; the database must be the same afterwards.
    fn held(text: &str) -> Vec<String> {
        let mut database = Database::new();
        let file = database.open("a.pyr", text);
        let mut validator = FixValidator::new(&database);
        let problems = database.diagnostics(file);
        let fixes = problems.iter().flat_map(|problem| problem.fixes.iter().map(move |fix| (problem, fix)));
        let held =
            fixes.filter(|(problem, fix)| validator.holds(problem, fix)).map(|(_, fix)| fix.title.clone());
        let held = held.collect();
        assert_eq!(validator.tried.diagnostics(file), problems);
        let mut visited = Vec::new();
        database.visit_diagnostics(file, |rule, severity, start| {
            visited.push((start, rule.code, severity));
        });
        visited.sort_unstable();
        let mut whole: Vec<_> =
            problems.iter().map(|found| (found.span.start, found.code(), found.severity)).collect();
        whole.sort_unstable();
        assert_eq!(visited, whole);
        assert_eq!(validator.tried.text(file), database.text(file));
        held
    }

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\n\
                         robot r type tw with port 1 has { a b } wheels with sensors { s }\n\
                         environment e has { r } robots with { m } moves\n";

    #[test]
    fn what_moves_a_problem_elsewhere_does_not_hold() {
        let program = |sensor: &str| format!("{PARTS}movement m of r {{ turn left until {{ {sensor} }} }}");
        assert_eq!(held(&program("ss")), ["change to `s`"], "nobody carries a new sensor");
    }

    #[test]
    fn what_was_hidden_may_come_to_light() {
        let program = format!("{PARTS}movement m off r {{ move 0 meters }}");
        assert_eq!(held(&program), ["change to `of`", "remove the move"]);
    }

    #[test]
    fn trying_suggestions_comes_to_an_end() {
        let mut database = Database::new();
        let file = database.open("a.pyr", &"wheel a with radius 4\n".repeat(300));
        let mut problems = database.diagnostics(file);
        let mut offers = Offers::new(&database, usize::MAX);
        offers.retain(&mut problems);
        let offered = problems.iter().filter(|problem| !problem.fixes.is_empty()).count();
        assert!((1..200).contains(&offered), "each renaming asks all 300 again: {offered}");
        let steps = offers.validator.map_or(0, |validator| validator.steps);
        assert!(steps < MAX_STEPS + MAX_STEPS / 10, "{steps}");
    }

    #[test]
    fn several_edits_are_taken_back() {
        let program =
            format!("{PARTS}movement m of r {{ slam }} robot type tw q with port 2 has {{ b c }} wheels");
        assert_eq!(held(&program), ["move it after the name", "declare the wheel `c`"]);
    }
}
