//! `duplicate-name`: one name, two entities of a kind.

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "duplicate-name",
    severity: Severity::Error,
    summary: "two things of one kind have the same name",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "Two things of the same kind have the same name in one file. (`wheel` and `wheelH` are one kind. A \
        wheel and a sensor may share a name.)",
    why: "A reference to the name is ambiguous. Often the second line is a copy of the first whose name was not \
        changed.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelL with radius 4.5",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some((kind, name)) = context.declared() else { return };
    let first = context.declarations(kind, name).first();
    let Some(first) = first.filter(|first| **first != context.id) else { return };
    let Some(first_name) = context.name_of(*first) else { return };
    let free = free_name(context, kind, &name.text);
    problems.push(
        RULE.problem(name.span, format!("there is already {} called `{}`", kind.a_noun(), name.text))
            .related(*first, first_name.span, "first declared here")
            .help("give one of them another name")
            .suggestion(format!("rename this one to `{free}`"), [context.replace(name.span, &free)]),
    );
}

/// The name with the first number after it that nobody of the kind has.
fn free_name(context: &Context<'_>, kind: pydslrep_syntax::EntityKind, name: &str) -> String {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    let stem = if stem.is_empty() { name } else { stem };
    let mut candidates = (2_u32..).map(|number| format!("{stem}_{number}"));
    candidates.find(|candidate| !context.is_declared(kind, candidate)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    #[test]
    fn the_second_is_reported_and_points_at_the_first() {
        check(
            "wheel a with radius 4\nwheelH a with radius 5\nwheel a_2 with radius 6",
            &expect![[r#"
            error[duplicate-name] 2:8 "a" there is already a wheel called `a`
              see 1:7 "a" first declared here
              help: give one of them another name
              suggestion: rename this one to `a_3` -> wheelH a_3 with radius 5
        "#]],
        );
        check(
            "sensor s_1\nsensor s_1\nsensor s_1",
            &expect![[r#"
            error[duplicate-name] 2:8 "s_1" there is already a sensor called `s_1`
              see 1:8 "s_1" first declared here
              help: give one of them another name
              suggestion: rename this one to `s_2` -> sensor s_2
            error[duplicate-name] 3:8 "s_1" there is already a sensor called `s_1`
              see 1:8 "s_1" first declared here
              help: give one of them another name
              suggestion: rename this one to `s_2` -> sensor s_2
        "#]],
        );
    }

    #[test]
    fn kinds_do_not_share_names() {
        check_clean("wheel a with radius 4\nsensor a\nip a 127.0.0.1");
    }
}
