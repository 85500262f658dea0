//! `repeated-wheel`: a robot lists a wheel twice.

use pydslrep_syntax::ast::{Entity, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "repeated-wheel",
    severity: Severity::Error,
    summary: "a robot lists a wheel twice",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot's list of wheels has the same wheel twice.",
    why: "In the simulator each wheel has its own motor, which the name identifies. Declare one wheel per motor, even \
        if they are of equal size.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelL } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    for (first, again) in robot.wheels.iter().flat_map(|list| repeats(&list.names)) {
        problems.push(
            RULE.problem(
                again.span,
                format!(
                    "`{}` is listed twice, but each wheel of a robot needs a name of its own",
                    again.text
                ),
            )
            .related(context.id, first.span, "first listed here")
            .help("declare one more wheel, and list that one here"),
        );
    }
}

/// The names that are in a list again, each with its first mention.
pub(super) fn repeats(names: &[Name]) -> Vec<(&Name, &Name)> {
    let first = |index: usize| names[..index].iter().find(|other| other.text == names[index].text);
    (0..names.len()).filter_map(|index| Some((first(index)?, &names[index]))).collect()
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const WHEELS: &str = "wheel a with radius 4\nwheel b with radius 4\n";

    #[test]
    fn a_wheel_is_listed_once() {
        check(
            &format!("{WHEELS}robot r with port 1 has {{ a a }} wheels"),
            &expect![[r#"
                error[repeated-wheel] 3:29 "a" `a` is listed twice, but each wheel of a robot needs a name of its own
                  see 3:27 "a" first listed here
                  help: declare one more wheel, and list that one here
            "#]],
        );
        check_clean(&format!("{WHEELS}robot r with port 1 has {{ a b }} wheels"));
    }
}
