//! `repeated-robot`: an environment lists a robot twice.

use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::example::trip;
use super::problem::Problem;
use super::repeated_wheel::repeats;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "repeated-robot",
    severity: Severity::Warning,
    summary: "an environment lists a robot twice",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "An environment lists the same robot twice.",
    why: "A robot is in an environment once, so the second mention adds nothing. Maybe you meant a different robot. \
        (Movements may be repeated; they then run each time.)",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { move 1 meters }

environment yard has { rover rover } robots with { trip } moves",
    fixed: trip!("{ move 1 meters }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Environment(environment)) = context.tree else { return };
    for (first, again) in environment.robots.iter().flat_map(|list| repeats(&list.names)) {
        problems.push(
            RULE.problem(again.span, format!("`{}` is in this environment already", again.text))
                .related(context.id, first.span, "first listed here")
                .fix(format!("remove the second `{}`", again.text), context.remove_item(again.span)),
        );
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\nmovement m of r { turn left }\n";

    #[test]
    fn a_robot_is_listed_once() {
        check(
            &format!("{PARTS}environment e has {{ r, r }} robots with {{ m }} moves"),
            &expect![[r#"
            warning[repeated-robot] 5:24 "r" `r` is in this environment already
              see 5:21 "r" first listed here
              fix: remove the second `r` -> environment e has { r } robots with { m } moves
        "#]],
        );
        check_clean(&format!("{PARTS}environment e has {{ r }} robots with {{ m m }} moves"));
    }
}
