//! Convert between metres and centimetres. Numbers are converted as text, so nothing is rounded.

use pydslrep_analysis::Edit;
use pydslrep_syntax::ast::{Move, Unit};

use super::actions::moves;
use super::{Refactoring, RefactoringKind, Selection};

/// The refactorings for the selected moves, and for all moves of the movement.
pub(super) fn convert(selection: &Selection<'_>) -> Vec<Refactoring> {
    let Some(movement) = selection.movement() else { return Vec::new() };
    let selected = selection.selected_moves();
    let all: Vec<&Move> = moves(movement.all_actions()).collect();
    let name = movement.name.as_ref().map_or("", |name| name.text.as_str());
    let mut offers = Vec::new();
    for unit in [Unit::Centimeters, Unit::Meters] {
        let word = word(unit);
        let (here, everywhere) = (edits(selection, &selected, unit), edits(selection, &all, unit));
        let more = everywhere.len() > here.len();
        let rewrite = |title: String, edits| Refactoring::new(title, RefactoringKind::Rewrite, edits);
        if !here.is_empty() {
            offers.push(rewrite(format!("convert to {word}"), here));
        }
        // A single other move is not worth an extra title.
        if more && (selected.is_empty() || everywhere.len() > 2) {
            offers.push(rewrite(format!("convert all moves of `{name}` to {word}"), everywhere));
        }
    }
    offers
}

/// The edits that convert the moves in the other unit.
fn edits(selection: &Selection<'_>, moves: &[&Move], to: Unit) -> Vec<Edit> {
    let edit = |step: &&Move| {
        let (distance, (unit, unit_span)) = (step.distance.as_ref()?, step.unit?);
        distance.value.filter(|_| unit != to)?;
        let converted = shifted(&selection.text(distance.span), if to == Unit::Meters { -2 } else { 2 });
        Some([selection.edit(distance.span, converted), selection.edit(unit_span, word(to))])
    };
    moves.iter().filter_map(edit).flatten().collect()
}

fn word(unit: Unit) -> &'static str {
    match unit {
        Unit::Meters => "meters",
        Unit::Centimeters => "centimeters",
    }
}

/// A number as text, times a power of ten: exact, without superfluous zeros; `4.0` keeps its point.
fn shifted(number: &str, places: i32) -> String {
    let (sign, digits) = number.strip_prefix('-').map_or(("", number), |digits| ("-", digits));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let has_point_alone = !fraction.is_empty() && fraction.bytes().all(|digit| digit == b'0');
    let (mut whole, mut fraction) = (whole.to_owned(), fraction.to_owned());
    for _ in 0..places {
        whole.push(if fraction.is_empty() { '0' } else { fraction.remove(0) });
    }
    for _ in places..0 {
        fraction.insert(0, whole.pop().unwrap_or('0'));
    }
    let whole = whole.trim_start_matches('0');
    let fraction = fraction.trim_end_matches('0');
    let fraction = if fraction.is_empty() && has_point_alone { "0" } else { fraction };
    let point = if fraction.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{fraction}", if whole.is_empty() { "0" } else { whole })
}

#[cfg(test)]
mod tests {
    use expect_test::expect;
    use proptest::prelude::*;

    use super::*;
    use crate::refactorings::testing::check;

    #[test]
    fn this_move_or_all() {
        check(
            "  $0move 4.0 meters at 9.0\n  turn left\n  move -0.125 meters\n  move 30 centimeters",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400.0 centimeters at 9.0
                Rewrite: convert all moves of `tour` to centimeters
                    |   move 400.0 centimeters at 9.0
                    |   turn left
                    |   move -12.5 centimeters
                Inline: omit the default speed of 9.0 cm/s
                    |   move 4.0 meters
                Rewrite: make the default speed explicit in all moves of `tour`
                    |   move -0.125 meters at 9.0
                    |   move 30 centimeters at 9.0
            "#]],
        );
    }

    #[test]
    fn numbers_are_converted_exactly() {
        for (meters, centimeters) in [
            ("4.0", "400.0"),
            ("4", "400"),
            ("4.25", "425"),
            ("0.3", "30"),
            ("-0.125", "-12.5"),
            ("0.001", "0.1"),
            ("0", "0"),
            ("1000000", "100000000"),
            ("0.1234567890123456789", "12.34567890123456789"),
        ] {
            assert_eq!(shifted(meters, 2), centimeters);
            assert_eq!(shifted(centimeters, -2), meters);
        }
        assert_eq!(shifted("007.50", 2), "750");
    }

    proptest! {
        #[test]
        fn there_and_back(whole in 0_u32..10_000, fraction in "([0-9]{0,5}[1-9])?", sign in prop::bool::ANY) {
            let point = if fraction.is_empty() { "" } else { "." };
            let number = format!("{}{whole}{point}{fraction}", if sign { "-" } else { "" });
            prop_assert_eq!(shifted(&shifted(&number, 2), -2), number.clone());
            prop_assert_eq!(shifted(&shifted(&number, -2), 2), number);
        }
    }
}
