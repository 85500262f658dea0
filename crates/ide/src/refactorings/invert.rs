//! Invert an `if`: the opposite condition, with its two blocks swapped.

use pydslrep_syntax::ast::{ActionKind, Block, Branch, If, SensorState};
use pydslrep_syntax::{Span, TokenKind};

use super::{Refactoring, Selection};

const TITLE: &str = "invert `if`";

/// The refactoring for the chosen `if`; of several conditions, for the last one.
pub(super) fn invert(selection: &Selection<'_>) -> Option<Refactoring> {
    let (_, action) = selection.action()?;
    let ActionKind::If(choice) = &action.kind else { return None };
    let Some(otherwise) = &choice.otherwise else {
        return Some(unavailable("it has no `else`: nothing would be done where its condition holds"));
    };
    let branch = choice.branches.last()?;
    let then = branch.block.as_ref()?;
    if !is_chosen(selection, choice, branch, then) {
        return Some(unavailable("only the last condition, that before `else`, can be inverted"));
    }
    let (condition, state) = (branch.condition.as_ref()?, branch.condition.as_ref()?.state?);
    let before_then = Span::new(condition.span.end, then.span.start);
    let before_otherwise = Span::new(then.span.end, otherwise.span.start);
    let block = |block: &Block, above: Span| {
        let (above, inner) = (selection.comment_lines(above), selection.inner_text(block.span));
        if above.is_empty() && inner.trim().is_empty() {
            "{ }".to_owned()
        } else {
            format!("{{\n{above}{}\n}}", inner.trim())
        }
    };
    let blocks = format!(" {} else {}", block(otherwise, before_otherwise), block(then, before_then));
    let edit = selection.rewrite(&[
        // From here on it is laid out.
        (Span::at(branch.span.start), String::new()),
        (state.1, opposite(state.0)?.to_owned()),
        (Span::new(condition.span.end, otherwise.span.end), blocks),
    ])?;
    Some(Refactoring::rewrite(TITLE, edit))
}

fn unavailable(reason: &str) -> Refactoring {
    Refactoring::no_rewrite(TITLE, reason)
}

/// Returns whether the selection is at the last branch, or that is the only one.
fn is_chosen(selection: &Selection<'_>, choice: &If, branch: &Branch, then: &Block) -> bool {
    let from_here = selection.range.start >= branch.span.start;
    choice.branches.len() == 1
        || from_here
        || selection.touches(Span::new(branch.span.start, then.span.start))
}

fn opposite(state: SensorState) -> Option<&'static str> {
    match state {
        SensorState::Clear => TokenKind::Detect.spelling(),
        SensorState::Detect => TokenKind::Clear.spelling(),
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_only;

    #[test]
    fn the_condition_and_the_blocks() {
        check_only(
            "invert",
            "  $0if { front } detect within 40 centimeters {\n    turn left\n  } else {\n    move 1 meters\n    slam\n  }",
            &expect![[r#"
                Rewrite: invert `if`
                    |   if { front } clear within 40 centimeters {
                    |     move 1 meters
                    |     slam
                    |   } else {
                    |     turn left
            "#]],
        );
        check_only(
            "invert",
            "  if { front } clear { turn left } else$0 { move 1 meters }",
            &expect![[r#"
            Rewrite: invert `if`
                |   if { front } detect {
                |     move 1 meters
                |   } else {
                |     turn left
                |   }
        "#]],
        );
        check_only(
            "invert",
            "  if { front } clear { turn left } else {$0 }",
            &expect![[r#"
            Rewrite: invert `if`
                |   if { front } detect { } else {
                |     turn left
                |   }
        "#]],
        );
    }

    #[test]
    fn the_last_of_several() {
        check_only(
            "invert",
            "  if { front } clear {\n    slam\n  } else if$0 { front } detect within 1 meters {\n    turn left\n  } else {\n    turn right\n  }",
            &expect![[r#"
                Rewrite: invert `if`
                    |   } else if { front } clear within 1 meters {
                    |     turn right
                    |   } else {
                    |     turn left
            "#]],
        );
        check_only(
            "invert",
            "  $0if { front } clear { slam } else if { front } detect within 1 meters { turn left } else { turn right }",
            &expect![[r#"
                Rewrite: invert `if`
                  not here: only the last condition, that before `else`, can be inverted
            "#]],
        );
    }

    #[test]
    fn comments_go_with_their_blocks() {
        check_only(
            "invert",
            "  if$0 { front } clear // free\n  {\n    // go\n    move 1 meters // far\n  } // near\n  else /* wall */ {\n    turn left\n    // turned\n  } // end",
            &expect![[r#"
                Rewrite: invert `if`
                    |   if { front } detect {
                    |     // near
                    |     /* wall */
                    |     turn left
                    |     // turned
                    |   } else {
                    |     // free
                    |     // go
                    |     move 1 meters // far
            "#]],
        );
    }

    #[test]
    fn not_everywhere() {
        check_only(
            "invert",
            "  $0if { front } clear { turn left }",
            &expect![[r#"
            Rewrite: invert `if`
              not here: it has no `else`: nothing would be done where its condition holds
        "#]],
        );
        check_only("invert", "  if { front } clear { $0turn left } else { turn right }", &expect![[""]]);
        check_only("invert", "  $0if { front } { turn left } else { turn right }", &expect![[""]]);
        check_only("invert", "  $0if { front } clear { turn left } else { turn right", &expect![[""]]);
    }
}
