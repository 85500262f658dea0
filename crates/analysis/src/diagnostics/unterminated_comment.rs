//! `unterminated-comment`: `/*` without `*/`.

use pydslrep_syntax::{Span, SyntaxErrorKind, offset};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "unterminated-comment",
    severity: Severity::Error,
    summary: "a comment that is never closed and hides the rest of the file",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A comment begins with `/*`, and no `*/` ends it. (The first `*/` ends a comment, even after two `/*`. A \
        comment that begins with `//` ends with its line.)",
    why: "Everything from `/*` to the end of the file is a comment. You still see your robots and movements there, but \
        the program does not contain them.",
    imports: &[],
    example: "\
/* The wheels of my first robot
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5",
    fixed: "\
/* The wheels of my first robot */
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for error in context.errors.iter().filter(|error| error.kind == SyntaxErrorKind::UnterminatedComment) {
        let line_end =
            context.tokens.iter().map(|(_, span)| span).find(|span| span.start == error.span.start).map_or(
                error.span.end,
                |span| {
                    let text = context.text(*span);
                    let line = text.find(['\n', '\r']).unwrap_or(text.len());
                    span.start + offset(line)
                },
            );
        problems.push(
            RULE.problem(error.span, "this comment is never closed, so everything after it is ignored")
                .help("end it with `*/`")
                .suggestion("close it at the end of the line", [context.replace(Span::at(line_end), " */")]),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn it_is_reported_at_its_opening_and_hides_what_it_swallows() {
        check(
            "robot r with port 1 has { a b } wheels\n/* wheels\nwheel a with radius 4\nwheel b with radius 4",
            &expect![[r#"
                error[unterminated-comment] 2:1 "/*" this comment is never closed, so everything after it is ignored
                  help: end it with `*/`
                  suggestion: close it at the end of the line -> /* wheels */
            "#]],
        );
        check_clean("wheel a with radius 4 /* wheel */");
    }
}
