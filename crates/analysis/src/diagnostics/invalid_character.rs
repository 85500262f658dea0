//! `invalid-character`: characters no token starts with.

use pydslrep_syntax::SyntaxErrorKind;

use super::context::{Context, Problem};
use super::{Page, Remedy, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "invalid-character",
    severity: Severity::Error,
    summary: "a character that has no meaning in the language",
    tag: None,
    remedy: Remedy::Suggested,
    seeks_names: false,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "A character that means nothing in the language, such as `;`, `=` or `ä`. Several in a row are \
        reported together. Inside a comment every character is fine.",
    why: "Names consist of the letters a to z and A to Z, digits and `_`, and nothing has to mark the end of a \
        line. A character from elsewhere often shows that a sentence was meant differently, so have a look \
        before you remove it.",
    imports: &[],
    example: "wheel wheelL with radius 4.5;",
    fixed: "wheel wheelL with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for error in context.errors {
        let SyntaxErrorKind::InvalidCharacter { written } = &error.kind else { continue };
        let plural = if written.chars().count() > 1 { "have" } else { "has" };
        problems.push(
            RULE.problem(error.span, format!("`{written}` {plural} no meaning here"))
                .help("names are made of the letters a to z and A to Z, digits and `_`")
                .suggestion(format!("remove `{written}`"), [context.replace(error.span, "")]),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn adjacent_ones_are_one_problem() {
        check(
            "wheel a with §§ radius 4.5;",
            &expect![[r#"
            error[invalid-character] 1:14 "§§" `§§` have no meaning here
              help: names are made of the letters a to z and A to Z, digits and `_`
              suggestion: remove `§§` -> wheel a with  radius 4.5;
            error[invalid-character] 1:29 ";" `;` has no meaning here
              help: names are made of the letters a to z and A to Z, digits and `_`
              suggestion: remove `;` -> wheel a with §§ radius 4.5
        "#]],
        );
        check_clean("wheel a with radius 4.5 // §");
    }
}
