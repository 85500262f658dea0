//! `repeated-sensor`: a list names a sensor twice.

use pydslrep_syntax::ast::{Action, Entity, References};

use super::context::Context;
use super::problem::Problem;
use super::repeated_wheel::repeats;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "repeated-sensor",
    severity: Severity::Warning,
    summary: "a list names a sensor twice",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A list of sensors names the same sensor twice.",
    why: "The second mention adds nothing. Maybe you meant a different sensor there.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor back

robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front, back, front }",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor back

robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front, back }",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for list in lists(context) {
        for (first, again) in repeats(&list.names) {
            problems.push(
                RULE.problem(again.span, format!("`{}` is in this list already", again.text))
                    .related(context.id, first.span, "first listed here")
                    .fix(format!("remove the second `{}`", again.text), context.remove_item(again.span)),
            );
        }
    }
}

fn lists<'a>(context: &Context<'a>) -> Vec<&'a References> {
    if let Some(Entity::Robot(robot)) = context.tree {
        return robot.sensors.iter().collect();
    }
    let conditions = context.actions().flat_map(Action::conditions);
    let mut lists: Vec<&References> = conditions.map(|condition| &condition.sensors).collect();
    lists.sort_by_key(|list| list.span.start);
    lists
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\nsensor t\n";

    #[test]
    fn a_sensor_is_listed_once() {
        check(
            &format!(
                "{PARTS}robot r with port 1 has {{ a b }} wheels with sensors {{ s, t, s }}\nmovement m of r {{ turn left until {{ t, t }} }}"
            ),
            &expect![[r#"
                warning[repeated-sensor] 5:61 "s" `s` is in this list already
                  see 5:55 "s" first listed here
                  fix: remove the second `s` -> robot r with port 1 has { a b } wheels with sensors { s, t }
                warning[repeated-sensor] 6:40 "t" `t` is in this list already
                  see 6:37 "t" first listed here
                  fix: remove the second `t` -> movement m of r { turn left until { t } }
            "#]],
        );
        check_clean(&format!("{PARTS}robot r with port 1 has {{ a b }} wheels with sensors {{ s, t }}"));
    }
}
