//! Convert between metres and centimetres. Numbers are converted as text, so nothing is rounded.

use pydslrep_analysis::Edit;
use pydslrep_syntax::ast::Unit;

use super::actions::{Length, lengths};
use super::{Refactoring, RefactoringKind, Selection};

/// The refactorings for the selected lengths, and for all of the movement.
pub(super) fn convert(selection: &Selection<'_>) -> Vec<Refactoring> {
    let Some(movement) = selection.movement() else { return Vec::new() };
    let all = lengths(movement);
    let is_selected = |length: &&Length<'_>| selection.touches(length.words);
    let selected: Vec<&Length<'_>> = all.iter().filter(is_selected).collect();
    let all: Vec<&Length<'_>> = all.iter().collect();
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
        // A single other length is not worth an extra title.
        if more && (selected.is_empty() || everywhere.len() > 2) {
            offers.push(rewrite(format!("convert all lengths of `{name}` to {word}"), everywhere));
        }
    }
    offers
}

/// The edits that convert the lengths in the other unit.
fn edits(selection: &Selection<'_>, lengths: &[&Length<'_>], to: Unit) -> Vec<Edit> {
    let edit = |length: &&Length<'_>| {
        let Length { number, unit, unit_span, .. } = length;
        number.value.filter(|_| *unit != to)?;
        let converted = shifted(&selection.text(number.span), if to == Unit::Meters { -2 } else { 2 });
        Some([selection.edit(number.span, converted), selection.edit(*unit_span, word(to))])
    };
    lengths.iter().filter_map(edit).flatten().collect()
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
    use crate::refactorings::testing::{check, check_only};

    #[test]
    fn this_move_or_all() {
        check(
            "  $0move 4.0 meters at 9.0\n  turn left\n  move -0.125 meters\n  move 30 centimeters",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   move 400.0 centimeters at 9.0
                Rewrite: convert all lengths of `tour` to centimeters
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
    fn radii_and_what_is_near() {
        check_only(
            "convert",
            "  $0turn left with radius 1.5 meters\n  repeat until { front } detect within 40 centimeters {\n    slam\n  }",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   turn left with radius 150 centimeters
            "#]],
        );
        check_only(
            "convert",
            "  if { front } clear { move 1 meters } else if$0 { front } detect within 0.4 meters { slam }\n  move 2 meters",
            &expect![[r#"
                Rewrite: convert to centimeters
                    |   if { front } clear { move 1 meters } else if { front } detect within 40 centimeters { slam }
                Rewrite: convert all lengths of `tour` to centimeters
                    |   if { front } clear { move 100 centimeters } else if { front } detect within 40 centimeters { slam }
                    |   move 200 centimeters
            "#]],
        );
        check_only(
            "convert",
            "  turn left until { front }  clear within$0 40 centimeters\n  wait 1 seconds until { front } clear within 1 meters",
            &expect![[r#"
                Rewrite: convert to meters
                    |   turn left until { front }  clear within 0.4 meters
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
