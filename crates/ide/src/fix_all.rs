//! Fix all: fixes many diagnostics at once, either all of one code or all that have a safe fix.

use pydslrep_analysis::{Database, Diagnostic, Edit, FileId, Fixing};

/// The codes among the `shown` diagnostics that occur at least twice in the file with a safe fix.
pub fn codes_to_fix_all(database: &Database, file: FileId, shown: &[Diagnostic]) -> Vec<&'static str> {
    let mut codes: Vec<&'static str> = Vec::new();
    for code in shown.iter().map(Diagnostic::code) {
        if !codes.contains(&code) {
            codes.push(code);
        }
    }
    let all = database.diagnostics(file);
    let fixable =
        |code: &&str| all.iter().filter(|other| other.code() == *code && has_safe_fix(other)).count() >= 2;
    codes.retain(fixable);
    codes
}

/// Returns whether a diagnostic has a safe fix.
pub fn has_safe_fix(diagnostic: &Diagnostic) -> bool {
    diagnostic.fixes.iter().any(|fix| fix.safe)
}

/// The edits of one file that fix its `wanted` diagnostics, as far as safe fixes within the file do. Fixes are applied to
/// a copy in rounds, so that diagnostics exposed by one fix are fixed too.
pub fn fix_all(database: &Database, file: FileId, wanted: impl Fn(&Diagnostic) -> bool) -> Vec<Edit> {
    let mut copy = database.clone();
    let mut fixing = Fixing::new(&copy, &[file]);
    loop {
        let mut problems = copy.diagnostics(file);
        problems.retain(&wanted);
        if !fixing.round(&mut copy, &problems) {
            return fixing.edits();
        }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;
    use crate::fixture::applied;

    const PROGRAM: &str = "wheel a radius 4\nwheel b with radius 4\nrobot type tw r with port 1 has { a b } wheels\n\
                           movement m of r {\n  move 0 meters\n  move 0 meters\n  move 1 meters\n  turn left 0\n}\n\
                           environment e has { r r } robots with { m } moves\n";

    #[test]
    fn all_of_one_code_are_fixed_and_nothing_else() {
        let mut database = Database::new();
        let file = database.open("test.pyr", PROGRAM);
        let shown = database.diagnostics(file);
        assert_eq!(
            codes_to_fix_all(&database, file, &shown),
            ["zero-distance"],
            "of the others there is one each"
        );
        let edits = fix_all(&database, file, |problem| problem.code() == "zero-distance");
        expect![[r#"
            wheel a radius 4
            wheel b with radius 4
            robot type tw r with port 1 has { a b } wheels
            movement m of r {
              move 1 meters
              turn left 0
            }
            environment e has { r r } robots with { m } moves
        "#]]
        .assert_eq(&applied(&database, file, &edits));
    }

    #[test]
    fn fixes_are_applied_until_none_is_left() {
        let mut database = Database::new();
        let file = database.open("test.pyr", PROGRAM);
        let edits = fix_all(&database, file, |_| true);
        expect![[r#"
            wheel a with radius 4
            wheel b with radius 4
            robot r type tw with port 1 has { a b } wheels
            movement m of r {
              move 1 meters
            }
            environment e has { r } robots with { m } moves
        "#]]
        .assert_eq(&applied(&database, file, &edits));
        assert_eq!(database.text(file).unwrap().to_string(), PROGRAM, "the database itself is unchanged");
    }
}
