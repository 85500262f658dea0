//! `ambiguous-import`: two imported files declare what a name could mean.

use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::Name;

use crate::EntityId;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "ambiguous-import",
    severity: Severity::Error,
    summary: "a name that two imported files both declare",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A name is used here, and two of the imported files both declare it.",
    why: "They may differ, and which one your robot gets would be arbitrary. Import only the file that you mean, \
        rename one of the two, or declare the name in this file: your own declaration takes precedence.",
    imports: &[
        ("rover.pyr", "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5"),
        ("truck.pyr", "wheel wheelL with radius 12"),
    ],
    example: "\
import \"rover.pyr\"
import \"truck.pyr\"

robot scout with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
import \"rover.pyr\"

robot scout with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for (kind, name) in &context.references {
        if !context.declarations(*kind, name).is_empty() {
            continue;
        }
        if let [first, second, ..] = context.imported_declarations(*kind, name)[..] {
            problems.push(problem(context, *kind, name, [first, second]));
        }
    }
}

fn problem(context: &Context<'_>, kind: EntityKind, name: &Name, declared: [EntityId; 2]) -> Problem {
    let problem = RULE
        .problem(name.span, format!("two imported files declare {} called `{}`", kind.a_noun(), name.text))
        .help(
            "import only one of the files, rename one of the two, or declare the one you mean in this file",
        );
    declared.into_iter().fold(problem, |problem, id| match context.name_of(id) {
        Some(name) => problem.related(id, name.span, "declared here"),
        None => problem,
    })
}

#[cfg(test)]
mod tests {
    use crate::Database;

    #[test]
    fn a_name_comes_from_one_file() {
        let mut database = Database::new();
        database.open("a.pyr", "wheel w with radius 4");
        let b = database.open("b.pyr", "wheel w with radius 5 wheel v with radius 5");
        let file = database
            .open("main.pyr", "import \"a.pyr\" import \"b.pyr\"\nrobot r with port 1 has { w v } wheels");
        let codes = |database: &Database| -> Vec<_> {
            database.diagnostics(file).iter().map(crate::Diagnostic::code).collect()
        };
        assert_eq!(codes(&database), ["ambiguous-import", "mixed-radii"]);
        assert_eq!(database.diagnostics(file)[0].related.len(), 2);
        database.open("b.pyr", "wheel v with radius 4");
        assert_eq!(codes(&database), [""; 0]);
        database.close(b);
        assert_eq!(codes(&database), [""; 0]);
    }
}
