//! `deprecated-ip-clause`: `environment a, ip1 has …`.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "deprecated-ip-clause",
    severity: Severity::Warning,
    summary: "an environment's ip is written after a comma",
    tag: Some(Tag::Deprecated),
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "An environment's ip is written after a comma: `environment yard, lab has …`.",
    why: "This is an older spelling. It still works, but a reader has to guess what the second name is for. `with ip` \
        is explicit.",
    imports: &[],
    example: "\
ip lab 192.168.0.12
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard, lab has { rover } robots with { trip } moves",
    fixed: "\
ip lab 192.168.0.12
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard with ip lab has { rover } robots with { trip } moves",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    let Some(clause) = environment.ip.as_ref().filter(|clause| clause.with_comma) else { return };
    let Some(name) = &clause.name else { return };
    let comma = Span::new(clause.span.start, name.span.start);
    problems.push(
        RULE.problem(
            clause.span,
            format!("an environment's ip is written `with ip {}`, without a comma", name.text),
        )
        .fix(format!("write `with ip {}`", name.text), [context.replace(comma, " with ip ")]),
    );
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "ip here 127.0.0.1\nwheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n";

    #[test]
    fn the_comma_becomes_words() {
        check(
            &format!("{PARTS}environment e, here has {{ r }} robots"),
            &expect![[r#"
                warning[deprecated-ip-clause] 5:14 ", here" an environment's ip is written `with ip here`, without a comma
                  fix: write `with ip here` -> environment e with ip here has { r } robots
            "#]],
        );
        check_clean(&format!("{PARTS}environment e with ip here has {{ r }} robots"));
    }
}
