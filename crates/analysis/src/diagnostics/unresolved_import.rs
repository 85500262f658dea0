//! `unresolved-import`: there is no such file, or imports may not lead to it.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::{Absence, Severity};

pub(super) static RULE: Rule = Rule {
    code: "unresolved-import",
    severity: Severity::Error,
    summary: "an imported file is missing, cannot be read, or is outside of the workspace",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The imported file does not exist, cannot be read, or is outside of the workspace.",
    why: "Nothing of that file can be used. The path counts from the folder of the program that imports it, not \
        from where a command is started, and its parts are separated by `/` on every system. To keep programs in \
        one piece, a path may not lead out of the workspace: the folders that are open in an editor or named on the \
        command line, and the folder of the nearest `pydslrep.toml`, or without one that of the program.",
    imports: &[("rover.pyr", "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5")],
    example: "\
import \"rovers.pyr\"

robot scout with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
import \"rover.pyr\"

robot scout with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Import(import)) = context.tree else { return };
    if !context.errors.is_empty() {
        return;
    }
    let (Some(written), Some(span)) = (&import.path, import.path_span) else { return };
    problems.extend(context.absence().map(|absence| match absence {
        Absence::Missing => RULE
            .problem(span, format!("there is no file `{written}`"))
            .help("check the spelling; the path counts from the folder of this file, with `/` between its parts"),
        Absence::Outside => RULE.problem(span, format!("`{written}` is outside of the workspace")).help(
            "move the file to where this one is, or put a `pydslrep.toml` into the folder that holds both; in an \
             editor, open that folder",
        ),
        Absence::Unreadable(why) => RULE
            .problem(span, format!("`{written}` cannot be read: {why}"))
            .help("programs are UTF-8 text files that you are allowed to read"),
    }));
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use crate::{Absence, Database, Diagnostic};

    const PROGRAM: &str =
        "import \"parts/x.pyr\"\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels";

    fn said(database: &Database) -> String {
        let file = database.file("main.pyr").unwrap();
        let say = |found: &Diagnostic| format!("{}: {}\n", found.code(), found.message);
        database.diagnostics(file).iter().map(say).collect()
    }

    fn check(absence: Absence, expected: &Expect) {
        let mut database = Database::new();
        let file = database.open("main.pyr", PROGRAM);
        assert_eq!(said(&database), "", "nothing is known of the file yet");
        database.set_absence(file, "parts/x.pyr", Some(absence));
        expected.assert_eq(&said(&database));
    }

    #[test]
    fn each_reason_is_told_and_what_would_be_there_is_no_second_problem() {
        check(
            Absence::Missing,
            &expect![[r#"
            unresolved-import: there is no file `parts/x.pyr`
        "#]],
        );
        check(
            Absence::Outside,
            &expect![[r#"
            unresolved-import: `parts/x.pyr` is outside of the workspace
        "#]],
        );
        check(
            Absence::Unreadable("line 3 is no text".to_owned()),
            &expect![[r#"
            unresolved-import: `parts/x.pyr` cannot be read: line 3 is no text
        "#]],
        );
    }

    #[test]
    fn a_file_that_comes_is_no_longer_missing() {
        let mut database = Database::new();
        let file = database.open("main.pyr", PROGRAM);
        database.set_absence(file, "parts/x.pyr", Some(Absence::Missing));
        let parts = database.open("parts/x.pyr", "wheel a with radius 4");
        assert_eq!(said(&database), "");
        database.close(parts);
        assert_eq!(said(&database), "", "nothing is known again");
        database.set_absence(file, "parts/x.pyr", Some(Absence::Missing));
        database.set_absence(file, "parts/x.pyr", None);
        assert_eq!(said(&database), "");
    }

    #[test]
    fn a_file_that_comes_is_not_missing_for_those_that_import_it_again() {
        let mut database = Database::new();
        let file = database.open("main.pyr", PROGRAM);
        database.set_absence(file, "parts/x.pyr", Some(Absence::Missing));
        database.open("main.pyr", "");
        database.open("parts/x.pyr", "wheel a with radius 4");
        database.open("main.pyr", PROGRAM);
        assert_eq!(said(&database), "");
    }

    #[test]
    fn a_file_outside_stays_there_when_it_is_open() {
        let mut database = Database::new();
        let file = database.open("main.pyr", PROGRAM);
        database.set_absence(file, "parts/x.pyr", Some(Absence::Outside));
        let parts = database.open("parts/x.pyr", "wheel a with radius 4\nenvironment e has {} robots");
        assert_eq!(said(&database), "unresolved-import: `parts/x.pyr` is outside of the workspace\n");
        assert_eq!(database.imported_files(file).count(), 0);
        let unused = |database: &Database| {
            database.diagnostics(parts).iter().filter(|found| found.code() == "unused-declaration").count()
        };
        assert_eq!(unused(&database), 1, "who may not import it does not use it");
        database.set_absence(file, "parts/x.pyr", None);
        assert_eq!(said(&database), "");
        assert_eq!(unused(&database), 0);
    }

    #[test]
    fn files_may_import_each_other_and_themselves() {
        let mut database = Database::new();
        let a = database.open("a.pyr", "import \"b.pyr\" import \"a.pyr\"\nwheel x with radius 4\nrobot r with port 1 has { x y } wheels");
        let b = database
            .open("b.pyr", "import \"a.pyr\"\nwheel y with radius 4\nrobot q with port 1 has { x y } wheels");
        for file in [a, b] {
            assert_eq!(database.diagnostics(file), []);
        }
        database.close(b);
        assert_eq!(database.diagnostics(a), []);
    }

    #[test]
    fn an_import_reaches_no_further_than_its_file() {
        let mut database = Database::new();
        database.open("c.pyr", "wheel y with radius 4");
        database.open("b.pyr", "import \"c.pyr\"\nwheel x with radius 4");
        let a = database.open("a.pyr", "import \"b.pyr\"\nrobot r with port 1 has { x y } wheels");
        let codes: Vec<_> = database.diagnostics(a).iter().map(Diagnostic::code).collect();
        assert_eq!(codes, ["unresolved-reference"], "`y` is imported by the import, not by this file");
    }
}
