//! Fix all: many problems mended at once, all of one code, or all that leave nothing to decide.

use pydslrep_analysis::{Database, Diagnostic, Edit, FileId, Fixing};

/// The code of the first problem at a place, if there are several of that code in the file that can be fixed safely.
pub fn codes_to_fix_all(database: &Database, file: FileId, shown: &[Diagnostic]) -> Vec<&'static str> {
    let all = database.diagnostics(file);
    let mut codes: Vec<&'static str> = Vec::new();
    for code in shown.iter().map(Diagnostic::code) {
        let fixable = all.iter().filter(|other| other.code() == code && is_safely_fixed(other));
        if !codes.contains(&code) && fixable.count() >= 2 {
            codes.push(code);
        }
    }
    codes
}

/// Whether a problem has a fix that leaves nothing to decide.
pub fn is_safely_fixed(diagnostic: &Diagnostic) -> bool {
    diagnostic.fixes.iter().any(|fix| fix.safe)
}

/// The edits of one file that mend all its `wanted` problems, as far as they can be mended safely and without touching
/// another file. They are tried, round after round: what one fix brings to light is mended too.
pub fn fix_all(database: &Database, file: FileId, wanted: impl Fn(&Diagnostic) -> bool) -> Vec<Edit> {
    let mut tried = database.clone();
    let mut fixing = Fixing::new(&tried, &[file]);
    loop {
        let mut problems = tried.diagnostics(file);
        problems.retain(&wanted);
        if !fixing.round(&mut tried, &problems) {
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
    fn all_of_one_code_are_mended_and_nothing_else() {
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
    fn all_are_mended_until_none_is_left() {
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
        assert_eq!(database.text(file).unwrap().to_string(), PROGRAM, "it was only tried");
    }
}
