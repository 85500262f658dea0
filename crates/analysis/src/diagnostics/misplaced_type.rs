//! `misplaced-type`: `robot type tw name`, as the article's grammar prints it.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Entity;

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "misplaced-type",
    severity: Severity::Warning,
    summary: "a robot's type is written before its name",
    tag: Some(Tag::Deprecated),
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "A robot's type is written before its name: `robot type tw rover`.",
    why: "This is an older spelling. It still works, but everywhere else the name follows the keyword, which makes \
        names easy to find.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot type tw rover with port 23000 has { wheelL wheelR } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    let (Some(clause), Some(name)) = (robot.drive.filter(|clause| clause.before_name), &robot.name) else {
        return;
    };
    let moved = context.text(clause.span);
    let edits = [
        context.replace(Span::new(clause.span.start, name.span.start), ""),
        context.replace(Span::at(name.span.end), format!(" {moved}")),
    ];
    problems.push(
        RULE.problem(
            clause.span,
            format!("a robot's type comes after its name: `robot {} {moved}`", name.text),
        )
        .fix("move it after the name", edits),
    );
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const WHEELS: &str = "wheel a with radius 4\nwheel b with radius 4\n";

    #[test]
    fn it_is_moved_behind_the_name() {
        check(
            &format!("{WHEELS}robot type tw r with port 1 has {{ a b }} wheels"),
            &expect![[r#"
                warning[misplaced-type] 3:7 "type tw" a robot's type comes after its name: `robot r type tw`
                  fix: move it after the name -> robot r type tw with port 1 has { a b } wheels
            "#]],
        );
        check_clean(&format!("{WHEELS}robot r type tw with port 1 has {{ a b }} wheels"));
    }
}
