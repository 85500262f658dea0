//! Turn on a circle instead of in place, and back. Both change the path, and their titles say so.

use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{ActionKind, Circle, Turn};

use super::{Refactoring, Selection};

/// A circle to begin with: the number is there to be changed.
const RADIUS: &str = "1.0 meters";

/// Degrees of a full turn; more of it in place is a mistake.
const FULL_TURN: f64 = 360.0;

/// The refactoring for the chosen turn in place.
pub(super) fn on_circle(selection: &Selection<'_>) -> Option<Refactoring> {
    let (span, turn) = chosen(selection).filter(|(_, turn)| turn.circle.is_none())?;
    let mut edits = vec![unchanged(span.start)];
    edits.push((Span::at(side_end(turn)?), format!(" with radius {RADIUS} ")));
    if let Some(until) = turn.until.as_ref().filter(|_| turn.is_of_article()) {
        // Only in the article's form it may be left out.
        edits.push((Span::at(until.condition.span.end), " clear ".to_owned()));
    }
    edits.push(unchanged(span.end));
    let edit = selection.rewrite(&edits)?;
    let title = format!("turn on a circle of {RADIUS} (changes the path)");
    Some(Refactoring::rewrite(title, edit))
}

/// The refactoring for the chosen turn on a circle.
pub(super) fn in_place(selection: &Selection<'_>) -> Option<Refactoring> {
    let (span, turn) = chosen(selection)?;
    let circle = turn.circle.as_ref()?;
    let title = "turn in place (changes the path)";
    if turn.angle.as_ref().is_some_and(|angle| angle.value.is_none_or(|value| value.abs() > FULL_TURN)) {
        let reason = "it is more than a full turn";
        return Some(Refactoring::no_rewrite(title, reason));
    }
    let without = |span: Span| {
        let comments = selection.comment_lines(span);
        (span, if comments.is_empty() { " ".to_owned() } else { format!(" {comments}") })
    };
    let mut edits = vec![unchanged(span.start), without(Span::new(side_end(turn)?, circle.span.end))];
    edits.extend(turn.reverse.map(|reverse| without(Span::new(before_reverse(turn, circle), reverse.end))));
    edits.push(unchanged(span.end));
    let edit = selection.rewrite(&edits)?;
    Some(Refactoring::rewrite(title, edit))
}

/// The chosen turn, unless it is one of 0 degrees, which is a mistake whichever way.
fn chosen<'a>(selection: &Selection<'a>) -> Option<(Span, &'a Turn)> {
    let (_, action) = selection.action()?;
    let ActionKind::Turn(turn) = &action.kind else { return None };
    let is_none = turn.angle.as_ref().is_some_and(|angle| angle.value.is_none_or(|value| value == 0.0));
    (!is_none).then_some((action.span, turn))
}

/// An end of what is laid out.
fn unchanged(offset: u32) -> (Span, String) {
    (Span::at(offset), String::new())
}

/// The end of the direction and the angle.
fn side_end(turn: &Turn) -> Option<u32> {
    let direction = turn.direction.map(|(_, span)| span.end);
    turn.angle.as_ref().map(|angle| angle.span.end).or(direction)
}

fn before_reverse(turn: &Turn, circle: &Circle) -> u32 {
    turn.speed.as_ref().map_or(circle.span.end, |speed| speed.span.end)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_only;

    #[test]
    fn from_in_place_to_a_circle() {
        check_only(
            "turn",
            "  $0turn left",
            &expect![[r#"
            Rewrite: turn on a circle of 1.0 meters (changes the path)
                |   turn left with radius 1.0 meters
        "#]],
        );
        check_only(
            "turn",
            "  turn right 45 $0at 5 until { front } detect",
            &expect![[r#"
            Rewrite: turn on a circle of 1.0 meters (changes the path)
                |   turn right 45 with radius 1.0 meters at 5 until { front } detect
        "#]],
        );
        check_only(
            "turn",
            "  turn left$0 until { front } slam",
            &expect![[r#"
            Rewrite: turn on a circle of 1.0 meters (changes the path)
                |   turn left with radius 1.0 meters until { front } clear
                |   slam
        "#]],
        );
        check_only(
            "turn",
            "  turn left 90$0// why\n  slam",
            &expect![[r#"
            Rewrite: turn on a circle of 1.0 meters (changes the path)
                |   turn left 90 with radius 1.0 meters // why
        "#]],
        );
    }

    #[test]
    fn from_a_circle_to_in_place() {
        check_only(
            "turn",
            "  $0turn left 90 with radius 1.5 meters",
            &expect![[r#"
            Rewrite: turn in place (changes the path)
                |   turn left 90
        "#]],
        );
        check_only(
            "turn",
            "  $0turn right with radius 1.5 meters at 5 in reverse until { front } detect",
            &expect![[r#"
                Rewrite: turn in place (changes the path)
                    |   turn right at 5 until { front } detect
            "#]],
        );
        check_only(
            "turn",
            "  $0turn right /* a */ with /* b */ radius // c\n  1.5 meters in /* d */ reverse",
            &expect![[r#"
                Rewrite: turn in place (changes the path)
                    |   turn right /* a */
                    |   /* b */
                    |   // c
                    |   /* d */
            "#]],
        );
    }

    #[test]
    fn not_everywhere() {
        check_only("turn", "  $0turn left 0", &expect![[""]]);
        check_only("turn", "  $0turn left 0 with radius 1 meters", &expect![[""]]);
        check_only(
            "turn",
            "  $0turn left 720 with radius 1 meters",
            &expect![[r#"
            Rewrite: turn in place (changes the path)
              not here: it is more than a full turn
        "#]],
        );
        check_only("turn", "  $0move 1 meters", &expect![[""]]);
        check_only("turn", "  $0turn left\n  turn right$0", &expect![[""]]);
        check_only("turn", "  $0turn left with", &expect![[""]]);
    }
}
