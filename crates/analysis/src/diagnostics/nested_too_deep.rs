//! `nested-too-deep`: more than 16 blocks, one in another.

use pydslrep_syntax::ast::{Action, Entity};

use super::context::Context;
use super::problem::Problem;
use super::{Applicability, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "nested-too-deep",
    severity: Severity::Error,
    summary: "more than 16 blocks, one in another",
    tag: None,
    applicability: Applicability::Never,
    page: PAGE,
    check,
};

const PAGE: Page = Page {
    what: "More than 16 blocks are one in another, or more than 100 movements do each other in a row.",
    why: "Python, in which scripts are written, has a limit for blocks within each other, and nobody can \
        follow so many. Put the inner ones into a movement of their own, and `do` that.",
    imports: &[],
    example: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { 
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  repeat 2 times {
  turn left
  } } } } } } } } } } } } } } } } } 
 }

environment yard has { rover } robots with { trip } moves",
    fixed: "\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover with port 23000 has { wheelL wheelR } wheels

movement trip of rover { repeat 2 times { turn left } }

environment yard has { rover } robots with { trip } moves",
};

/// How many blocks may be one in another.
pub const MOST_BLOCKS: usize = 16;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    too_deep(context, &movement.actions, 0, problems);
}

/// The actions whose blocks are one too many. The parser has left out what is much deeper.
fn too_deep(context: &Context<'_>, actions: &[Action], depth: usize, problems: &mut Vec<Problem>) {
    for action in actions {
        let mut blocks = action.blocks().peekable();
        if depth == MOST_BLOCKS && blocks.peek().is_some() {
            problems.push(problem(context, action));
            continue;
        }
        blocks.for_each(|block| too_deep(context, &block.actions, depth + 1, problems));
    }
}

fn problem(context: &Context<'_>, action: &Action) -> Problem {
    let keyword = context.tokens.iter().find(|(_, span)| span.start == action.span.start);
    let span = keyword.map_or(action.span, |(_, span)| *span);
    RULE.problem(span, format!("more than {MOST_BLOCKS} blocks are one in another here"))
        .help("put the inner blocks into a movement of their own, and `do` that")
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean};

    const PARTS: &str = "wheel a with radius 4\nwheel b with radius 4\nsensor s\nsensor t : bumper\n\
        robot r with port 1 has { a b } wheels with sensors { s, t }\n";

    fn program(actions: &str) -> String {
        format!("{PARTS}movement m of r {{ {actions} }}")
    }

    #[test]
    fn blocks_are_nested_to_sixteen() {
        let nested =
            |count: usize| format!("{}turn left{}", "repeat 2 times { ".repeat(count), " }".repeat(count));
        check(
            &program(&nested(18)),
            &expect![[r#"
            error[nested-too-deep] 6:291 "repeat" more than 16 blocks are one in another here
              help: put the inner blocks into a movement of their own, and `do` that
        "#]],
        );
        check_clean(&program(&nested(16)));
    }
}
