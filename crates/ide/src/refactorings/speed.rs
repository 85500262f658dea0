//! Speeds: make the default explicit, omit it, or use one speed for all moves of a movement.

use pydslrep_analysis::Edit;
use pydslrep_kinematics::motion::RIM_SPEED;
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Move, Number};

use super::actions::moves;
use super::{Refactoring, RefactoringKind, Selection};

/// The refactorings for the selected moves, and for all moves of the movement.
pub(super) fn refactorings(selection: &Selection<'_>) -> Vec<Refactoring> {
    let Some(movement) = selection.movement() else { return Vec::new() };
    let name = movement.name.as_ref().map_or("", |name| name.text.as_str());
    let selected = selection.selected_moves();
    let all: Vec<&Move> = moves(movement.all_actions()).collect();
    let offers = |title: &str, kind, edits: fn(&Selection<'_>, &[&Move]) -> Vec<Edit>| {
        let (here, everywhere) = (edits(selection, &selected), edits(selection, &all));
        let others = everywhere.len() > here.len();
        let in_all = format!("{title} in all moves of `{name}`");
        let here = (!here.is_empty()).then(|| Refactoring::new(title, kind, here));
        here.into_iter().chain(others.then(|| Refactoring::new(in_all, kind, everywhere)))
    };
    let omit = format!("omit the default speed of {} cm/s", default_speed());
    let omitted = offers(&omit, RefactoringKind::Inline, omit_default);
    let explicit = offers("make the default speed explicit", RefactoringKind::Rewrite, make_explicit);
    omitted.chain(explicit).chain(share(selection, name, &selected, &all)).collect()
}

/// Omits the default speed.
fn omit_default(selection: &Selection<'_>, moves: &[&Move]) -> Vec<Edit> {
    let defaults = moves.iter().filter(|step| speed(step).is_some_and(is_default));
    defaults.filter_map(|step| without_speed(selection, step)).collect()
}

/// Adds the default speed to moves without one.
fn make_explicit(selection: &Selection<'_>, moves: &[&Move]) -> Vec<Edit> {
    let silent = moves.iter().filter(|step| step.speed.is_none());
    silent.filter_map(|step| with_speed(selection, step, &default_speed())).collect()
}

/// Uses the speed of the selected move for all others. This changes the duration of the movement.
fn share(selection: &Selection<'_>, name: &str, selected: &[&Move], all: &[&Move]) -> Option<Refactoring> {
    let [step] = selected else { return None };
    let number = speed(step)?;
    let value = number.value.filter(|value| *value > 0.0 && value.is_finite())?;
    let text = selection.text(number.span);
    let edit = |other: &&Move| match &other.speed {
        Some(clause) => {
            let number = clause.value.as_ref()?;
            (!same(number.value, value)).then(|| selection.edit(number.span, apart(selection, number, &text)))
        }
        None if same(Some(RIM_SPEED * 100.0), value) => None,
        None => with_speed(selection, other, &text),
    };
    let edits: Vec<Edit> = all.iter().filter_map(edit).collect();
    let title = format!("use {text} cm/s for all moves of `{name}`");
    (!edits.is_empty()).then(|| Refactoring::new(title, RefactoringKind::Rewrite, edits))
}

/// A number in the place of another one: in `at-9`, only its sign separates it from the word before it.
fn apart(selection: &Selection<'_>, number: &Number, text: &str) -> String {
    let before = selection.text(Span::new(0, number.span.start));
    let runs_on = before.ends_with(|c: char| c.is_ascii_alphanumeric());
    if runs_on { format!(" {text}") } else { text.to_owned() }
}

fn speed(step: &Move) -> Option<&Number> {
    step.speed.as_ref()?.value.as_ref()
}

fn is_default(number: &Number) -> bool {
    same(number.value, RIM_SPEED * 100.0)
}

fn same(value: Option<f64>, other: f64) -> bool {
    value.is_some_and(|value| (value - other).abs() < 1e-9)
}

/// In centimetres per second, formatted as in the paper.
fn default_speed() -> String {
    format!("{:.1}", RIM_SPEED * 100.0)
}

/// The edit that adds a speed to a move without one: after its distance, or before its `until`.
fn with_speed(selection: &Selection<'_>, step: &Move, speed: &str) -> Option<Edit> {
    Some(match step.unit {
        Some((_, unit)) => selection.edit(Span::at(unit.end), format!(" at {speed}")),
        None => selection.edit(Span::at(step.until.as_ref()?.span.start), format!("at {speed} ")),
    })
}

/// The edit that removes `at 9.0` and the white space before it; `None` if it contains a comment.
fn without_speed(selection: &Selection<'_>, step: &Move) -> Option<Edit> {
    let clause = step.speed.as_ref()?.span;
    let is_blank = |text: String| text.trim().is_empty();
    let (from, to) = match step.unit {
        Some((_, unit)) if is_blank(selection.text(Span::new(unit.end, clause.start))) => {
            (unit.end, clause.end)
        }
        Some(_) => (clause.start, clause.end),
        None => {
            let after = Span::new(clause.end, step.until.as_ref()?.span.start);
            (clause.start, if is_blank(selection.text(after)) { after.end } else { clause.end })
        }
    };
    if selection.text(clause).contains('/') {
        return None;
    }
    // In `9.0turn` only the number separates the words.
    let after = selection.text(Span::new(to, selection.entity.span.len()));
    let runs_on = after.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    Some(selection.edit(Span::new(from, to), if runs_on { " " } else { "" }))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check;

    #[test]
    fn the_default_is_omitted_or_explicit() {
        check(
            "  $0move 4.0 meters at 9.0\n  move 1 meters\n  move 2 meters at 9",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400.0 centimeters at 9.0
                Rewrite: convert all lengths of `tour` to centimeters
                    |   move 400.0 centimeters at 9.0
                    |   move 100 centimeters
                    |   move 200 centimeters at 9
                Inline: omit the default speed of 9.0 cm/s
                    |   move 4.0 meters
                Inline: omit the default speed of 9.0 cm/s in all moves of `tour`
                    |   move 4.0 meters
                    |   move 1 meters
                    |   move 2 meters
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move 1 meters at 9.0
            "#]],
        );
    }

    #[test]
    fn one_speed_for_all() {
        check(
            "  move 4.0 meters at $020\n  move 1 meters\n  move 2 meters at 9",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400.0 centimeters at 20
                Rewrite: convert all lengths of `tour` to centimeters
                    |   move 400.0 centimeters at 20
                    |   move 100 centimeters
                    |   move 200 centimeters at 9
                Inline: omit the default speed of 9.0 cm/s in all moves of `tour`
                    |   move 2 meters
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move 1 meters at 9.0
                Rewrite: use 20 cm/s for all moves of `tour`
                    |   move 1 meters at 20
                    |   move 2 meters at 20
            "#]],
        );
    }

    #[test]
    fn a_sign_that_separates_words_is_replaced_by_a_blank() {
        check(
            "  move 4.0 meters at $020\n  move 2 meters at-9",
            &expect![[r#"
            Rewrite: convert to centimeters
                |   move 400.0 centimeters at 20
            Rewrite: convert all lengths of `tour` to centimeters
                |   move 400.0 centimeters at 20
                |   move 200 centimeters at-9
            Rewrite: use 20 cm/s for all moves of `tour`
                |   move 2 meters at 20
        "#]],
        );
    }
}
