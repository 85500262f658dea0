//! `empty-environment`: an environment without robots.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "empty-environment",
    severity: Severity::Warning,
    summary: "an environment without robots",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "An environment lists no robots.",
    why: "An environment becomes the script that drives its robots. Without robots the script would start and end.",
    imports: &[],
    example: "environment yard has { } robots",
    fixed: trip!("{ move 1 meters turn left }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    let Some(list) = &environment.robots else { return };
    if list.names.is_empty() && !list.broken && context.errors.is_empty() {
        problems.push(
            RULE.problem(list.span, "this environment has no robots, so nothing drives in it")
                .help("name its robots between the braces"),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\nmovement m of r { turn left }\n";

    #[test]
    fn an_environment_has_robots() {
        check(
            "environment e has { } robots",
            &expect![[r#"
            warning[empty-environment] 1:19 "{ }" this environment has no robots, so nothing drives in it
              help: name its robots between the braces
        "#]],
        );
        check_clean(&format!("{PARTS}environment e has {{ r }} robots with {{ m }} moves"));
    }
}
