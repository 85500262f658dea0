//! `unterminated-string`: `"` without its end on the line.

use pydslrep_syntax::{Span, SyntaxErrorKind};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "unterminated-string",
    severity: Severity::Error,
    summary: "a path in quotes that has no closing quote on its line",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The path after `import` begins with a `\"`, but the line ends before a second `\"` closes it.",
    why: "The second quote ends the path. Without it the file is not read, and its declarations are missing here.",
    imports: &[("wheels.pyr", "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5")],
    example: "\
import \"wheels.pyr

robot rover with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
import \"wheels.pyr\"

robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for error in context.errors.iter().filter(|error| error.kind == SyntaxErrorKind::UnterminatedString) {
        let problem = RULE.problem(error.span, "this path has no closing quote on its line");
        problems.push(if error.span.len() > 1 {
            let close = context.replace(Span::at(error.span.end), "\"");
            problem.help("end it with `\"`").fix("add the closing quote", [close])
        } else {
            problem.help("write the path of the other file and end it with `\"`")
        });
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn the_quote_is_added() {
        check(
            "import \"parts.pyr\nwheel a with radius 4",
            &expect![[r#"
            error[unterminated-string] 1:8 "\"parts.pyr" this path has no closing quote on its line
              help: end it with `"`
              fix: add the closing quote -> import "parts.pyr"
        "#]],
        );
        check_clean("import \"parts.pyr\"\nwheel a with radius 4");
    }
}
