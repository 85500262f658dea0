//! `empty-movement`: a movement without actions.

use pydslrep_syntax::ast::Entity;

use super::Rule;
use super::context::{Context, Problem};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "empty-movement",
    severity: Severity::Warning,
    summary: "a movement without actions",
    tag: None,
    seeks_names: false,
    check,
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let Some(body) = movement.body.filter(|_| movement.actions.is_empty() && context.errors.is_empty())
    else {
        return;
    };
    problems.push(
        RULE.problem(body, "this movement does nothing")
            .help("write actions between the braces, such as `move 1.0 meters` or `turn left`"),
    );
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str =
        "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has { a b } wheels\n";

    #[test]
    fn a_movement_does_something() {
        check(
            &format!("{PARTS}movement m of r {{ }}"),
            &expect![[r#"
                warning[empty-movement] 4:17 "{ }" this movement does nothing
                  help: write actions between the braces, such as `move 1.0 meters` or `turn left`
            "#]],
        );
        check_clean(&format!("{PARTS}movement m of r {{ turn left }}"));
    }
}
