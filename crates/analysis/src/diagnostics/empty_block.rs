//! `empty-block`: a `repeat`, `if` or `else` without an action.

use pydslrep_syntax::ast::{Action, ActionKind, Block, Branch, If, Repeat, Rounds, SensorState};
use pydslrep_syntax::{Span, TokenKind};

use super::context::Context;
use super::edits::ProblemEdit;
use super::example::sensing_trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "empty-block",
    severity: Severity::Warning,
    summary: "a `repeat`, `if` or `else` without an action",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "There is nothing between the braces of a `repeat`, an `if` or an `else`.",
    why: "Nothing is done there. Probably the actions are still missing. To let a robot stay where it is until \
        a sensor says something else, write `wait until`.",
    imports: &[],
    example: sensing_trip!("{ repeat until { front } clear { } move 1 meters }"),
    fixed: sensing_trip!("{ wait until { front } clear move 1 meters }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let empty = action.blocks().filter(|block| block.actions.is_empty() && is_understood(context, block));
        problems.extend(empty.map(|block| problem(context, action, block)));
    }
}

/// Returns whether the block has both its braces, and nothing in it was skipped.
fn is_understood(context: &Context<'_>, block: &Block) -> bool {
    let inside = |span: Span| block.span.start <= span.start && span.start <= block.span.end;
    block.span.len() >= 2 && !context.errors.iter().any(|error| inside(error.span))
}

fn problem(context: &Context<'_>, action: &Action, block: &Block) -> Problem {
    let problem = RULE
        .problem(block.span, "this block has no actions, so nothing is done there")
        .help("write actions between the braces, such as `move 1.0 meters` or `turn left`");
    match &action.kind {
        ActionKind::Repeat(Repeat { rounds: Some(Rounds::Until(until)), .. }) => {
            let before = Span::new(action.span.start, until.span.start);
            let after = Span::new(until.span.end, action.span.end);
            let edits = [context.replace(before, "wait "), context.replace(after, "")];
            problem.suggestion("wait until that is so", edits)
        }
        ActionKind::Repeat(_) => problem.suggestion("remove the `repeat`", [context.remove(action.span)]),
        ActionKind::If(choice) => of_if(context, action, choice, block, problem),
        _ => problem,
    }
}

fn of_if(context: &Context<'_>, action: &Action, choice: &If, block: &Block, problem: Problem) -> Problem {
    let is_it = |other: &Block| other.span == block.span;
    match (&choice.otherwise, choice.branches.as_slice()) {
        (Some(last), [.., before]) if is_it(last) => {
            let end = before.block.as_ref().map_or(before.span.end, |before| before.span.end);
            problem.suggestion("remove the `else`", [context.replace(Span::new(end, last.span.end), "")])
        }
        (Some(last), [only]) => match opposite(context, only, last) {
            Some(edits) => problem.suggestion("ask for the opposite", edits),
            None => problem,
        },
        (None, [_]) => problem.suggestion("remove the `if`", [context.remove(action.span)]),
        (None, [.., before, last]) if last.block.as_ref().is_some_and(is_it) => {
            let gap = Span::new(before.span.end, last.span.end);
            problem.suggestion("remove the `else if`", [context.replace(gap, "")])
        }
        _ => problem,
    }
}

/// The edits that leave of an `if` only its `else`: where the condition holds, nothing is done.
fn opposite(context: &Context<'_>, branch: &Branch, otherwise: &Block) -> Option<[ProblemEdit; 2]> {
    let (state, place) = branch.condition.as_ref()?.state?;
    let block = branch.block.as_ref().filter(|_| !otherwise.actions.is_empty())?;
    let word = match state {
        SensorState::Clear => TokenKind::Detect,
        SensorState::Detect => TokenKind::Clear,
    };
    let gap = Span::new(block.span.start, otherwise.span.start);
    Some([context.replace(place, word.spelling()?), context.replace(gap, "")])
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn what_does_nothing_is_removed() {
        check(
            &program("turn left repeat 2 times { }"),
            &expect![[r#"
            warning[empty-block] 6:44 "{ }" this block has no actions, so nothing is done there
              help: write actions between the braces, such as `move 1.0 meters` or `turn left`
              suggestion: remove the `repeat` -> movement m of r { turn left }
        "#]],
        );
        check(
            &program("repeat until { s } clear { } turn left"),
            &expect![[r#"
            warning[empty-block] 6:44 "{ }" this block has no actions, so nothing is done there
              help: write actions between the braces, such as `move 1.0 meters` or `turn left`
              suggestion: wait until that is so -> movement m of r { wait until { s } clear turn left }
        "#]],
        );
        check(
            &program("turn left if { s } clear { }"),
            &expect![[r#"
            warning[empty-block] 6:44 "{ }" this block has no actions, so nothing is done there
              help: write actions between the braces, such as `move 1.0 meters` or `turn left`
              suggestion: remove the `if` -> movement m of r { turn left }
        "#]],
        );
        check(
            &program("if { s } clear { turn left } else { }"),
            &expect![[r#"
            warning[empty-block] 6:53 "{ }" this block has no actions, so nothing is done there
              help: write actions between the braces, such as `move 1.0 meters` or `turn left`
              suggestion: remove the `else` -> movement m of r { if { s } clear { turn left } }
        "#]],
        );
        check(
            &program("if { s } clear { } else { turn left }"),
            &expect![[r#"
                warning[empty-block] 6:34 "{ }" this block has no actions, so nothing is done there
                  help: write actions between the braces, such as `move 1.0 meters` or `turn left`
                  suggestion: ask for the opposite -> movement m of r { if { s } detect { turn left } }
            "#]],
        );
        check(
            &program("if { s } clear within 1 meters { } else if { t } clear { turn left }"),
            &expect![[r#"
                warning[empty-block] 6:50 "{ }" this block has no actions, so nothing is done there
                  help: write actions between the braces, such as `move 1.0 meters` or `turn left`
            "#]],
        );
        check(
            &program("if { s } clear { turn left } else if { t } clear { } turn right"),
            &expect![[r#"
            warning[empty-block] 6:68 "{ }" this block has no actions, so nothing is done there
              help: write actions between the braces, such as `move 1.0 meters` or `turn left`
              suggestion: remove the `else if` -> movement m of r { if { s } clear { turn left } turn right }
        "#]],
        );
        check_clean(&program("repeat 2 times { turn left }"));
    }
}
