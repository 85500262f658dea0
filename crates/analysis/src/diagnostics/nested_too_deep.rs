//! `nested-too-deep`: more than 16 blocks, one in another, or too many movements that do each other.

use pydslrep_syntax::ast::{Action, Entity, Movement};
use pydslrep_syntax::{EntityKind, escape, format};

use super::calls::{self, Calls, MAX_CALL_DEPTH};
use super::context::Context;
use super::edits::ProblemEdit;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;

pub(super) static RULE: Rule = Rule {
    code: "nested-too-deep",
    severity: Severity::Error,
    summary: "more than 16 blocks, one in another",
    tag: None,
    applicability: Applicability::Suggested,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "More than 16 blocks are one in another, or more than 200 movements do each other in a row.",
    why: "Python, in which scripts are written, has a limit for blocks within each other, and nobody can \
        follow so many. Put the inner ones into a movement of their own, and `do` that.",
    imports: &[],
    example: trip!(
        "{ 
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
 }"
    ),
    fixed: trip!("{ repeat 2 times { turn left } }"),
};

/// The maximum depth of nested blocks.
pub const MAX_BLOCK_DEPTH: usize = 16;

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    let Some(Entity::Movement(movement)) = context.tree else { return };
    let mut found = Vec::new();
    too_deep(&movement.actions, 0, &mut found);
    problems.extend(found.into_iter().map(|action| problem(context, movement, action)));
    let done = calls::of(context).filter(|(_, calls)| matches!(calls, Calls::TooMany));
    problems.extend(done.map(|(name, _)| {
        RULE.problem(
            name.span,
            format!("more than {MAX_CALL_DEPTH} movements do each other in a row from here"),
        )
        .help("put what they do into fewer movements")
    }));
}

/// The actions whose blocks are one too many. The parser has left out what is much deeper.
fn too_deep<'a>(actions: &'a [Action], depth: usize, found: &mut Vec<&'a Action>) {
    for action in actions {
        let mut blocks = action.blocks().peekable();
        if depth == MAX_BLOCK_DEPTH && blocks.peek().is_some() {
            found.push(action);
            continue;
        }
        blocks.for_each(|block| too_deep(&block.actions, depth + 1, found));
    }
}

fn problem(context: &Context<'_>, movement: &Movement, action: &Action) -> Problem {
    let keyword = context.tokens.iter().find(|(_, span)| span.start == action.span.start);
    let span = keyword.map_or(action.span, |(_, span)| *span);
    let problem = RULE
        .problem(span, format!("more than {MAX_BLOCK_DEPTH} blocks are one in another here"))
        .help("put the inner blocks into a movement of their own, and `do` that");
    match extraction(context, movement, action) {
        Some((name, edits)) => problem.suggestion(format!("extract into new movement `{name}`"), edits),
        None => problem,
    }
}

/// The edits that put an action into a movement of its own, which is done in its place, and the name of that.
fn extraction(
    context: &Context<'_>,
    movement: &Movement,
    action: &Action,
) -> Option<(String, [ProblemEdit; 2])> {
    let (own, robot) = (movement.name.as_ref()?, movement.robot.as_ref()?);
    if !context.errors.is_empty() {
        return None;
    }
    let mut names = (2_u32..).map(|number| format!("{}_{number}", own.text));
    let name = names.find(|name| !context.is_declared(EntityKind::Movement, name))?;
    let (robot, moved) = (escape(&robot.text), context.text(action.span).replace("\r\n", "\n"));
    let declaration = format(&format!("movement {name} of {robot} {{\n{moved}\n}}\n"));
    let call = context.replace(action.span, format!("do {name}"));
    Some((name, [context.declare(format!("{}\n\n", declaration.trim_end())), call]))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{PARTS, check, check_clean, program};

    #[test]
    fn blocks_are_nested_to_sixteen() {
        let nested =
            |count: usize| format!("{}turn left{}", "repeat 2 times { ".repeat(count), " }".repeat(count));
        check(
            &program(&nested(18)),
            &expect![[r#"
                error[nested-too-deep] 6:291 "repeat" more than 16 blocks are one in another here
                  help: put the inner blocks into a movement of their own, and `do` that
                  suggestion: extract into new movement `m_2` -> movement m_2 of r { ⏎   repeat 2 times { ⏎     repeat 2 times { ⏎       turn left ⏎     } ⏎   } ⏎ } ⏎  ⏎ movement m of r { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { do m_2 } } } } } } } } } } } } } } } } }
            "#]],
        );
        check_clean(&program(&nested(16)));
        assert_eq!(count(&program(&nested(17))), 1);
    }

    /// Returns how often it is reported.
    fn count(text: &str) -> usize {
        let mut database = crate::Database::new();
        let file = database.open("a.pyr", text);
        database.diagnostics(file).iter().filter(|found| found.code() == super::RULE.code).count()
    }

    #[test]
    fn blocks_of_what_is_done_do_not_count() {
        let nested = |inner: &str| format!("{}{inner}{}", "repeat 2 times { ".repeat(16), " }".repeat(16));
        let other = format!("\nmovement n of r {{ {} }}", nested("turn left"));
        assert_eq!(count(&(program(&nested("do n")) + &other)), 0);
    }

    #[test]
    fn movements_do_each_other_two_hundred_times() {
        let row = |count: usize, last: &str| {
            let each = (1..count).map(|n| format!("movement m{n} of r {{ do m{} }}\n", n + 1));
            format!("{PARTS}{}movement m{count} of r {{ {last} }}\n", each.collect::<String>())
        };
        assert_eq!(count(&row(200, "turn left")), 0);
        assert_eq!(count(&row(201, "turn left")), 0, "the first one does two hundred");
        assert_eq!(count(&row(203, "turn left")), 2);
        // Too large a circle to be called one, but not too large to be reported.
        assert_eq!(count(&row(300, "do m1")), 300);
    }
}
