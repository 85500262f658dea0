//! `invalid-count`: a block is repeated once, or no whole number of times from 1 to 10000.

use pydslrep_syntax::ast::{Action, Block, Number};
use pydslrep_syntax::{Span, Token};

use super::context::Context;
use super::edits::ProblemEdit;
use super::example::trip;
use super::problem::Problem;
use super::rule::{Applicability, Checks, Page, Rule};
use crate::Severity;
use crate::environment::COUNTS;

pub(super) static RULE: Rule = Rule {
    code: "invalid-count",
    severity: Severity::Warning,
    summary: "a block is repeated once; an error if not a whole number of times from 1 to 10000",
    tag: None,
    applicability: Applicability::Safe,
    page: PAGE,
    checks: Checks::of_entity(check),
};

const PAGE: Page = Page {
    what: "The number before `times` is 1, or it is an error: no whole number, or not from 1 to 10000.",
    why: "A block cannot be done two and a half times. For more than 10000 rounds, put one `repeat` into \
        another; there is no endless one. A block that is repeated once is done without `repeat` as well.",
    imports: &[],
    example: trip!("{ repeat 1 times { move 1 meters turn left } }"),
    fixed: trip!("{ move 1 meters turn left }"),
};

fn check(context: &Context<'_>, problems: &mut Vec<Problem>) {
    for action in context.actions() {
        let Some(count) = action.count() else { continue };
        let block = action.blocks().next();
        match count.value.filter(|value| value.is_finite()) {
            Some(1.0) => problems.extend(block.map(|block| once(context, action, count, block))),
            Some(value) if value.fract() != 0.0 || !COUNTS.contains(&value) => {
                problems.push(none(context, action, count));
            }
            _ => {}
        }
    }
}

fn none(context: &Context<'_>, action: &Action, count: &Number) -> Problem {
    let written = context.short_text(count.span);
    let (min, max) = (COUNTS.start(), COUNTS.end());
    let keyword = action.keyword();
    let (what, more) = if keyword.begins_block() {
        ("a block is repeated".to_owned(), "; for more rounds, put one `repeat` into another")
    } else {
        (format!("a {} is done", keyword.spelling().unwrap_or_default()), "")
    };
    RULE.problem(count.span, format!("{what} from {min} to {max} times, a whole number, not {written}"))
        .severity(Severity::Error)
        .help(format!("write how often{more}"))
}

fn once(context: &Context<'_>, action: &Action, count: &Number, block: &Block) -> Problem {
    let problem = RULE.problem(count.span, "a block that is repeated once is done without `repeat` as well");
    let edits = if block.actions.is_empty() { None } else { unrolled(context, action, block) };
    match edits {
        Some(edits) => problem.fix("remove `repeat`", edits),
        None => problem,
    }
}

/// The edits that leave of an action only what is in its block, with the comments there.
fn unrolled(context: &Context<'_>, action: &Action, block: &Block) -> Option<[ProblemEdit; 2]> {
    let head = Span::new(action.span.start, block.span.start);
    let is_comment = |(token, span): &Token| token.is_comment() && head.touches(span.start);
    if block.span.len() < 2 || context.tokens.iter().any(is_comment) {
        return None;
    }
    let (_, first) = context.tokens.iter().find(|(_, span)| span.start > block.span.start)?;
    let brace = Span::new(block.span.end - 1, block.span.end);
    Some([context.replace(Span::new(action.span.start, first.start), ""), context.remove(brace)])
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::diagnostics::testing::{check, check_clean, program};

    #[test]
    fn counts_are_whole_and_not_too_large() {
        for count in ["0", "-2", "2.5", "10001"] {
            let text = program(&format!("repeat {count} times {{ turn left }}"));
            let mut database = crate::Database::new();
            let file = database.open("a.pyr", &text);
            let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
            assert!(codes.contains(&"invalid-count"), "{count}: {codes:?}");
        }
        check(
            &program("repeat 2.5 times { turn left }"),
            &expect![[r#"
            error[invalid-count] 6:26 "2.5" a block is repeated from 1 to 10000 times, a whole number, not 2.5
              help: write how often; for more rounds, put one `repeat` into another
        "#]],
        );
        check_clean(&program(
            "repeat 2 times { turn left } repeat 3.0 times { turn left } repeat 10000 times { turn left }",
        ));
    }

    #[test]
    fn once_is_no_repetition() {
        check(
            &program("repeat 1 times { turn left move 1 meters }"),
            &expect![[r#"
            warning[invalid-count] 6:26 "1" a block that is repeated once is done without `repeat` as well
              fix: remove `repeat` -> movement m of r { turn left move 1 meters }
        "#]],
        );
        check(
            &program("repeat 1 times { // how\n turn left // why\n }"),
            &expect![[r#"
                warning[invalid-count] 6:26 "1" a block that is repeated once is done without `repeat` as well
                  fix: remove `repeat` -> movement m of r { // how ⏎  }
            "#]],
        );
        check(
            &program("repeat 1 times /* it */ { turn left }"),
            &expect![[r#"
            warning[invalid-count] 6:26 "1" a block that is repeated once is done without `repeat` as well
        "#]],
        );
    }
}
