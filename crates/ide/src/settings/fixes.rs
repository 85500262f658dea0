//! Quick fixes in a settings file, and in any other that has keys.

use pydslrep_config::Config;
use pydslrep_schema::Problem;
use pydslrep_syntax::Span;

/// A fix with the problem it mends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFix {
    /// What it mends.
    pub problem: Problem,
    /// What it does, in words.
    pub title: String,
    /// What it replaces.
    pub span: Span,
    /// By what.
    pub text: String,
}

/// The fixes of all problems that touch a range of the text.
pub fn settings_fixes(text: &str, range: Span) -> Vec<KeyFix> {
    fixes(Config::from_toml(text).1, range)
}

/// The fixes of those problems that touch a range.
pub(crate) fn fixes(problems: Vec<Problem>, range: Span) -> Vec<KeyFix> {
    let fix = |problem: Problem| {
        let span = problem.span.filter(|span| span.start <= range.end && range.start <= span.end)?;
        let text = problem.replacement.clone()?;
        let title = format!("change to `{}`", text.trim_matches('"'));
        Some(KeyFix { problem, title, span, text })
    };
    problems.into_iter().filter_map(fix).collect()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::settings::at_cursor;

    /// The titles, and the text after each; the problem must be gone, and no other come.
    fn check(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let before = Config::from_toml(&text).1.len();
        let mut out = String::new();
        for fix in settings_fixes(&text, Span::at(offset)) {
            let mut mended = text.clone();
            mended.replace_range(std::ops::Range::from(fix.span), &fix.text);
            assert!(Config::from_toml(&mended).1.len() < before, "{mended}");
            out += &format!("{}\n{mended}\n", fix.title);
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn slips_are_mended() {
        check(
            "[sevrity$0]\nwheel-count = \"off\"",
            &expect![[r#"
            change to `severity`
            [severity]
            wheel-count = "off"
        "#]],
        );
        check(
            "target = \"v-rep$0\"",
            &expect![[r#"
            change to `vrep`
            target = "vrep"
        "#]],
        );
        check(
            "generateonsave$0 = true\ntarget = \"x\"",
            &expect![[r#"
            change to `generate-on-save`
            generate-on-save = true
            target = "x"
        "#]],
        );
        check(
            "[severity]\nwheel-counts$0 = \"off\"",
            &expect![[r#"
            change to `wheel-count`
            [severity]
            wheel-count = "off"
        "#]],
        );
        check(
            "[severity]\nwheel-count = \"warn$0\"",
            &expect![[r#"
            change to `warning`
            [severity]
            wheel-count = "warning"
        "#]],
        );
        check("targett = \"vrep\"\noutput = $0\"a\"", &expect![""]);
    }
}
