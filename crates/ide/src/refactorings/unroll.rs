//! Unroll a `repeat N times` into its rounds.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{ActionKind, Block, Repeat, Rounds, nested};

use super::{Refactoring, Selection};

/// More statements than these are not for people.
const MAX_ACTIONS: usize = 200;

/// The refactoring for the chosen `repeat`.
pub(super) fn unroll(selection: &Selection<'_>) -> Option<Refactoring> {
    let (_, action) = selection.action()?;
    let ActionKind::Repeat(Repeat { rounds: Some(Rounds::Times(count)), block: Some(block) }) = &action.kind
    else {
        return None;
    };
    let rounds = count.value.filter(|value| value.fract() == 0.0 && *value >= 1.0)?;
    if block.actions.is_empty() {
        return None;
    }
    let title = format!("unroll `repeat {rounds} times`");
    let Some(rounds) = bounded(rounds, block) else {
        let reason = format!("that would be more than {MAX_ACTIONS} actions");
        return Some(Refactoring::no_rewrite(title, reason));
    };
    let head = selection.comment_lines(Span::new(action.span.start, block.span.start));
    let round = selection.inner_text(block.span);
    let text = vec![round.trim(); rounds].join("\n");
    let edit = selection.rewrite(&[selection.in_place_of(action.span, &head, &text)])?;
    Some(Refactoring::rewrite(title, edit))
}

/// The number of rounds, if they are not too many actions.
fn bounded(rounds: f64, block: &Block) -> Option<usize> {
    let statements = nested(&block.actions).count();
    let is_it =
        |count: &usize| u32::try_from(*count).is_ok_and(|count| f64::from(count).total_cmp(&rounds).is_eq());
    (1..=MAX_ACTIONS / statements.max(1)).find(is_it)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_only;

    #[test]
    fn rounds_in_a_row() {
        check_only(
            "unroll",
            "  $0repeat 3 times {\n    move 1 meters\n    turn left\n  }\n  slam",
            &expect![[r#"
                Rewrite: unroll `repeat 3 times`
                    |   move 1 meters
                    |   turn left
                    |   move 1 meters
                    |   turn left
                    |   move 1 meters
                    |   turn left
            "#]],
        );
        check_only(
            "unroll",
            "repeat$0 1 times { turn left move 1 meters }",
            &expect![[r#"
            Rewrite: unroll `repeat 1 times`
                |   turn left
                |   move 1 meters
        "#]],
        );
        check_only(
            "unroll",
            "  wait 1 seconds\n  $0repeat 2 times {\n    if { front } clear {\n      slam\n    } else {\n      repeat 2 times { turn left }\n    }\n  }$0",
            &expect![[r#"
                Rewrite: unroll `repeat 2 times`
                    |   if { front } clear {
                    |     slam
                    |   } else {
                    |     repeat 2 times {
                    |       turn left
                    |     }
                    |   }
                    |   if { front } clear {
                    |     slam
                    |   } else {
                    |     repeat 2 times {
                    |       turn left
            "#]],
        );
        check_only(
            "unroll",
            "  repeat 2 times {\n    $0repeat 2 times {\n      turn left\n    }\n  }",
            &expect![[r#"
                Rewrite: unroll `repeat 2 times`
                    |     turn left
                    |     turn left
            "#]],
        );
    }

    #[test]
    fn comments_stay() {
        check_only(
            "unroll",
            "  // A square.\n  repeat /* sides */ 2 times // north and south\n  {$0 // a side\n    move 1 meters // straight\n    turn left\n    // at the corner\n  } // done\n  slam",
            &expect![[r#"
                Rewrite: unroll `repeat 2 times`
                    |   /* sides */
                    |   // north and south
                    |   // a side
                    |   move 1 meters // straight
                    |   turn left
                    |   // at the corner
                    |   // a side
                    |   move 1 meters // straight
                    |   turn left
                    |   // at the corner
                    |   // done
            "#]],
        );
        check_only(
            "unroll",
            "  $0repeat 2 times { turn left // first\n } slam",
            &expect![[r#"
            Rewrite: unroll `repeat 2 times`
                |   turn left // first
                |   turn left // first
                |   slam
        "#]],
        );
    }

    #[test]
    fn not_everywhere() {
        check_only("unroll", "  repeat 2 times {\n    $0turn left\n  }", &expect![[""]]);
        check_only("unroll", "  $0repeat until { front } detect { turn left }", &expect![[""]]);
        check_only("unroll", "  $0repeat 2 times { }", &expect![[""]]);
        check_only("unroll", "  $0repeat 0.5 times { turn left }", &expect![[""]]);
        check_only(
            "unroll",
            "  $0repeat 101 times { turn left slam }",
            &expect![[r#"
            Rewrite: unroll `repeat 101 times`
              not here: that would be more than 200 actions
        "#]],
        );
        check_only(
            "unroll",
            "  $0repeat 10000 times { turn left }",
            &expect![[r#"
            Rewrite: unroll `repeat 10000 times`
              not here: that would be more than 200 actions
        "#]],
        );
        check_only("unroll", "  $0repeat 2 times { turn left", &expect![[""]]);
    }
}
