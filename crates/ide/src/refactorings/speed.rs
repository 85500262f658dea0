//! Speeds: written out, left out where they are the default, or one for all moves of a movement.

use pydslrep_analysis::Edit;
use pydslrep_kinematics::motion::RIM_SPEED;
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::{Move, Number};

use super::actions::moves;
use super::{Place, Refactoring, RefactoringKind};

/// Offers for the moves that are selected, and for all moves of the movement.
pub(super) fn spell(place: &Place<'_>) -> Vec<Refactoring> {
    let Some(movement) = place.movement() else { return Vec::new() };
    let name = movement.name.as_ref().map_or("", |name| name.text.as_str());
    let selected = place.selected_moves();
    let all: Vec<&Move> = moves(&movement.actions).collect();
    let mut offers = Vec::new();
    offers.extend(leave_out(place, name, &selected, &all));
    offers.extend(write_out(place, name, &selected, &all));
    offers.extend(share(place, name, &selected, &all));
    offers
}

/// All moves have the default speed: it need not be said.
fn leave_out(place: &Place<'_>, name: &str, selected: &[&Move], all: &[&Move]) -> Vec<Refactoring> {
    let edits = |moves: &[&Move]| -> Vec<Edit> {
        let defaults = moves.iter().filter(|step| speed(step).is_some_and(is_default));
        defaults.filter_map(|step| without_speed(place, step)).collect()
    };
    let (here, everywhere) = (edits(selected), edits(all));
    let inline = |title, edits| Refactoring::new(title, RefactoringKind::Inline, edits);
    let default = default_speed();
    let mut offers = Vec::new();
    if !here.is_empty() {
        offers.push(inline(format!("leave out the default speed of {default} cm/s"), here.clone()));
    }
    if everywhere.len() > here.len() {
        let title = format!("leave out the default speed of {default} cm/s in all moves of `{name}`");
        offers.push(inline(title, everywhere));
    }
    offers
}

/// Moves without a speed: what they do is said.
fn write_out(place: &Place<'_>, name: &str, selected: &[&Move], all: &[&Move]) -> Vec<Refactoring> {
    let default = default_speed();
    let edits = |moves: &[&Move]| -> Vec<Edit> {
        let silent = moves.iter().filter(|step| step.speed.is_none());
        let edit = |step: &&Move| Some(place.edit(Span::at(step.unit?.1.end), format!(" at {default}")));
        silent.filter_map(edit).collect()
    };
    let (here, everywhere) = (edits(selected), edits(all));
    let rewrite = |title, edits| Refactoring::new(title, RefactoringKind::Rewrite, edits);
    let mut offers = Vec::new();
    if !here.is_empty() {
        offers.push(rewrite("write the default speed out".to_owned(), here.clone()));
    }
    if everywhere.len() > here.len() {
        offers.push(rewrite(format!("write the default speed out in all moves of `{name}`"), everywhere));
    }
    offers
}

/// One move has a speed: the others may get it, too. This changes how long the movement takes.
fn share(place: &Place<'_>, name: &str, selected: &[&Move], all: &[&Move]) -> Option<Refactoring> {
    let [step] = selected else { return None };
    let number = speed(step)?;
    let value = number.value.filter(|value| *value > 0.0 && value.is_finite())?;
    let text = place.text(number.span);
    let edit = |other: &&Move| match &other.speed {
        Some(clause) => {
            let number = clause.value.as_ref()?;
            (!same(number.value, value)).then(|| place.edit(number.span, text.clone()))
        }
        None if same(Some(RIM_SPEED * 100.0), value) => None,
        None => Some(place.edit(Span::at(other.unit?.1.end), format!(" at {text}"))),
    };
    let edits: Vec<Edit> = all.iter().filter_map(edit).collect();
    let title = format!("use {text} cm/s for all moves of `{name}`");
    (!edits.is_empty()).then(|| Refactoring::new(title, RefactoringKind::Rewrite, edits))
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

/// In centimetres per second, as the article writes it.
fn default_speed() -> String {
    format!("{:.1}", RIM_SPEED * 100.0)
}

/// The edit that takes `at 9.0` away, with the white space before it; not where a comment stands in it.
fn without_speed(place: &Place<'_>, step: &Move) -> Option<Edit> {
    let (unit, clause) = (step.unit?.1, step.speed.as_ref()?.span);
    let is_blank = |text: String| text.trim().is_empty();
    let (from, to) = (
        if is_blank(place.text(Span::new(unit.end, clause.start))) { unit.end } else { clause.start },
        clause.end,
    );
    if place.text(clause).contains('/') {
        return None;
    }
    // In `9.0turn` nothing but the number keeps the words apart.
    let behind = place.text(Span::new(to, place.entity.span.len()));
    let runs_on = behind.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    Some(place.edit(Span::new(from, to), if runs_on { " " } else { "" }))
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check;

    #[test]
    fn the_default_is_left_out_or_written_out() {
        check(
            "  $0move 4.0 meters at 9.0\n  move 1 meters\n  move 2 meters at 9",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400.0 centimeters at 9.0
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400.0 centimeters at 9.0
                    |   move 100 centimeters
                    |   move 200 centimeters at 9
                Inline: leave out the default speed of 9.0 cm/s
                    |   move 4.0 meters
                Inline: leave out the default speed of 9.0 cm/s in all moves of `tour`
                    |   move 4.0 meters
                    |   move 1 meters
                    |   move 2 meters
                Rewrite: write the default speed out in all moves of `tour`
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
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400.0 centimeters at 20
                    |   move 100 centimeters
                    |   move 200 centimeters at 9
                Inline: leave out the default speed of 9.0 cm/s in all moves of `tour`
                    |   move 2 meters
                Rewrite: write the default speed out in all moves of `tour`
                    |   move 1 meters at 9.0
                Rewrite: use 20 cm/s for all moves of `tour`
                    |   move 1 meters at 20
                    |   move 2 meters at 20
            "#]],
        );
    }
}
