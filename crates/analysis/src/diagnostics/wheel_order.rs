//! `wheel-order`: two wheels look as if they stood right before left.

use pydslrep_syntax::ast::{Entity, Name};

use super::context::Context;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use super::wheel_count::wheel_orders;
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "wheel-order",
    severity: Severity::Hint,
    summary: "a wheel named as a right one is where the left one belongs",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "Two wheels look swapped: their names differ in one letter only, and the one with R is listed before \
        the one with L, although left wheels come first.",
    why: "The order in the list decides which wheel is left and which is right, whatever their names. If two are \
        swapped, the robot turns right where it should turn left.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelR wheelL } wheels",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels",
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Robot(robot)) = context.tree else { return };
    let names = robot.wheels.as_ref().map_or(&[][..], |list| &list.names);
    for (index, first) in names.iter().enumerate() {
        let is_its_left = |second: &Name| is_right_of(&first.text, &second.text);
        if let Some(other) = names.iter().rposition(is_its_left).filter(|other| *other > index) {
            let second = &names[other];
            // Two wheels are listed left, right; of four, the left two come before the right two.
            let half = names.len() / 2;
            problems.push(if index < half && other >= half {
                swapped(context, first, second)
            } else {
                alternating(context, first, second, names)
            });
        }
    }
}

fn swapped(context: &Context<'_>, first: &Name, second: &Name) -> Problem {
    let swap = [
        context.replace(first.span, context.text(second.span)),
        context.replace(second.span, context.text(first.span)),
    ];
    RULE.problem(first.span, format!("`{}` is in the place of the left wheel", first.text))
        .related(context.id, second.span, format!("and `{}` in the place of the right wheel", second.text))
        .help(wheel_orders())
        .suggestion(format!("swap `{}` and `{}`", first.text, second.text), swap)
}

/// Right and left on the same side of the list, as in `{ wheelR0 wheelL0 wheelR1 wheelL1 }`.
fn alternating(context: &Context<'_>, first: &Name, second: &Name, names: &[Name]) -> Problem {
    let message = format!("`{}` comes before `{}`, but left wheels come first", first.text, second.text);
    let problem = RULE
        .problem(first.span, message)
        .related(context.id, second.span, format!("`{}` is here", second.text))
        .help(wheel_orders());
    let has_right = |name: &Name| names.iter().any(|other| is_right_of(&other.text, &name.text));
    let has_left = |name: &Name| names.iter().any(|other| is_right_of(&name.text, &other.text));
    let lefts = names.iter().filter(|name| has_right(name) && !has_left(name));
    let rights = names.iter().filter(|name| has_left(name) && !has_right(name));
    let sorted: Vec<&Name> = lefts.chain(rights).collect();
    // The side of a wheel without a counterpart, or with two, is unknown.
    if sorted.len() != names.len() {
        return problem;
    }
    let moved = names.iter().zip(sorted).filter(|(old, new)| old.text != new.text);
    let edits: Vec<_> = moved.map(|(old, new)| context.replace(old.span, context.text(new.span))).collect();
    problem.suggestion("list the left wheels first", edits)
}

/// Returns whether the names differ in exactly one letter, R in the first and L in the second.
fn is_right_of(first: &str, second: &str) -> bool {
    let mut differences = first.chars().zip(second.chars()).filter(|(a, b)| a != b);
    let one = differences.next();
    first.len() == second.len()
        && differences.next().is_none()
        && matches!(one, Some(('R', 'L') | ('r', 'l')))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const WHEELS: &str = "wheel wheelL with radius 4\nwheel wheelR with radius 4\nwheel wlf with radius 4\nwheel wlr with radius 4\nwheel wrf with radius 4\nwheel wrr with radius 4\n";

    #[test]
    fn left_comes_before_right() {
        check(
            &format!("{WHEELS}robot r with port 1 has {{ wheelR wheelL }} wheels"),
            &expect![[r#"
                hint[wheel-order] 7:27 "wheelR" `wheelR` is in the place of the left wheel
                  see 7:34 "wheelL" and `wheelL` in the place of the right wheel
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
                  suggestion: swap `wheelR` and `wheelL` -> robot r with port 1 has { wheelL wheelR } wheels
            "#]],
        );
        check(
            &format!("{WHEELS}robot r with port 1 has {{ wrf wrr wlf wlr }} wheels"),
            &expect![[r#"
                hint[wheel-order] 7:27 "wrf" `wrf` is in the place of the left wheel
                  see 7:35 "wlf" and `wlf` in the place of the right wheel
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
                  suggestion: swap `wrf` and `wlf` -> robot r with port 1 has { wlf wrr wrf wlr } wheels
                hint[wheel-order] 7:31 "wrr" `wrr` is in the place of the left wheel
                  see 7:39 "wlr" and `wlr` in the place of the right wheel
                  help: list two wheels as left, right; or four as left front, left rear, right front, right rear
                  suggestion: swap `wrr` and `wlr` -> robot r with port 1 has { wrf wlr wlf wrr } wheels
            "#]],
        );
        check(
            &format!("{WHEELS}robot r with port 1 has {{ wrf wlf wrr wlr }} wheels"),
            &expect![[r#"
            hint[wheel-order] 7:27 "wrf" `wrf` comes before `wlf`, but left wheels come first
              see 7:31 "wlf" `wlf` is here
              help: list two wheels as left, right; or four as left front, left rear, right front, right rear
              suggestion: list the left wheels first -> robot r with port 1 has { wlf wlr wrf wrr } wheels
            hint[wheel-order] 7:35 "wrr" `wrr` comes before `wlr`, but left wheels come first
              see 7:39 "wlr" `wlr` is here
              help: list two wheels as left, right; or four as left front, left rear, right front, right rear
              suggestion: list the left wheels first -> robot r with port 1 has { wlf wlr wrf wrr } wheels
        "#]],
        );
        check_clean(&format!("{WHEELS}robot r with port 1 has {{ wheelL wheelR }} wheels"));
        check_clean(&format!("{WHEELS}robot r with port 1 has {{ wlf wlr wrf wrr }} wheels"));
    }
}
