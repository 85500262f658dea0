//! `misplaced-type`: `robot type tw name`, as the article's grammar prints it.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Entity;

use super::context::{Context, Problem};
use super::{Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "misplaced-type",
    severity: Severity::Warning,
    summary: "a robot's type stands before its name",
    tag: Some(Tag::Deprecated),
    seeks_names: false,
    check,
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
        RULE.problem(clause.span, format!("the type stands behind the name: `robot {} {moved}`", name.text))
            .fix("move it behind the name", edits),
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
            warning[misplaced-type] 3:7 "type tw" the type stands behind the name: `robot r type tw`
              fix: move it behind the name -> robot r type tw with port 1 has { a b } wheels
        "#]],
        );
        check_clean(&format!("{WHEELS}robot r type tw with port 1 has {{ a b }} wheels"));
    }
}
