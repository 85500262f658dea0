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
                .help(help(written))
                .suggestion(format!("remove `{written}`"), [context.replace(error.span, "")]),
        );
    }
}

/// What somebody who is used to these characters may not know of the language.
fn help(written: &str) -> &'static str {
    if written.chars().any(char::is_alphabetic) {
        "names are made of the letters a to z and A to Z, digits and `_`"
    } else if written.contains(';') {
        "nothing has to mark the end of a line; leave it out"
    } else if written.contains('=') {
        "a value comes right after its word, such as `radius 4.5`; leave it out"
    } else if written.contains(['(', ')', '[', ']', '<', '>']) {
        "lists and actions stand between `{` and `}`"
    } else if written.contains('#') {
        "a comment starts with `//`"
    } else {
        "leave it out; in a comment, after `//`, every character is fine"
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
                  help: leave it out; in a comment, after `//`, every character is fine
                  suggestion: remove `§§` -> wheel a with  radius 4.5;
                error[invalid-character] 1:29 ";" `;` has no meaning here
                  help: nothing has to mark the end of a line; leave it out
                  suggestion: remove `;` -> wheel a with §§ radius 4.5
            "#]],
        );
        check_clean("wheel a with radius 4.5 // §");
    }

    #[test]
    fn habits_from_elsewhere_are_known() {
        check(
            "wheel aä with radius 4.5",
            &expect![[r#"
            error[invalid-character] 1:8 "ä" `ä` has no meaning here
              help: names are made of the letters a to z and A to Z, digits and `_`
              suggestion: remove `ä` -> wheel a with radius 4.5
        "#]],
        );
        check(
            "wheel a with radius = 4.5",
            &expect![[r#"
            error[invalid-character] 1:21 "=" `=` has no meaning here
              help: a value comes right after its word, such as `radius 4.5`; leave it out
              suggestion: remove `=` -> wheel a with radius  4.5
        "#]],
        );
        check(
            "wheel a with radius 4.5 #",
            &expect![[r##"
            error[invalid-character] 1:25 "#" `#` has no meaning here
              help: a comment starts with `//`
              suggestion: remove `#` -> wheel a with radius 4.5 
        "##]],
        );
        check(
            "wheel a with radius (4.5",
            &expect![[r#"
            error[invalid-character] 1:21 "(" `(` has no meaning here
              help: lists and actions stand between `{` and `}`
              suggestion: remove `(` -> wheel a with radius 4.5
        "#]],
        );
    }
}
