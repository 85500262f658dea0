//! `zero-distance`: a move that goes nowhere.

use pydslrep_syntax::ast::{ActionKind, Entity};

use super::context::{Context, Problem};
use super::{Rule, Tag};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "zero-distance",
    severity: Severity::Warning,
    summary: "a move over no distance does nothing",
    tag: Some(Tag::Unnecessary),
    seeks_names: false,
    check,
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    for action in &movement.actions {
        let ActionKind::Move(step) = &action.kind else { continue };
        if let Some(distance) = step.distance.as_ref().filter(|distance| distance.value == Some(0.0)) {
            problems.push(
                RULE.problem(distance.span, "this move goes nowhere")
                    .fix("remove the move", [context.remove(action.span)]),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    fn program(actions: &str) -> String {
        format!(
            "wheel a with radius 4\nwheel b with radius 4\nrobot r with port 1 has {{ a b }} wheels\nmovement m of r {{{actions}}}"
        )
    }

    #[test]
    fn the_move_is_removed() {
        check(
            &program("\n  turn left // first\n  move 0.0 meters\n  move -0 meters at 4\n  turn right\n"),
            &expect![[r#"
                warning[zero-distance] 6:8 "0.0" this move goes nowhere
                  fix: remove the move -> 
                warning[zero-distance] 7:8 "-0" this move goes nowhere
                  fix: remove the move -> 
            "#]],
        );
        check_clean(&program(" move 0.001 centimeters "));
    }
}
