//! The programs of `tests/programs/0.3`.

use super::{check, check_as_article, findings};

const SQUARE: &str = include_str!("../../../programs/0.3/01-square.pyr");
const NESTED: &str = include_str!("../../../programs/0.3/02-nested.pyr");
const ARCS: &str = include_str!("../../../programs/0.3/03-arcs.pyr");
const PROCEDURES: &str = include_str!("../../../programs/0.3/04-procedures.pyr");
const NAMES: &str = include_str!("../../../programs/0.3/05-names.pyr");
const WALL: &str = include_str!("../../../programs/0.3/06-wall.pyr");
const PATROL: &str = include_str!("../../../programs/0.3/07-patrol.pyr");
const MOWER: &str = include_str!("../../../programs/0.3/08-mower.pyr");
const GIVE_WAY: &str = include_str!("../../../programs/0.3/09-give-way.pyr");
const LIMITS: &str = include_str!("../../../programs/0.3/10-limits.pyr");
const RECOVERY: &str = include_str!("../../../programs/0.3/11-recovery.pyr");

/// Those that are right.
const RIGHT: [&str; 9] = [SQUARE, NESTED, ARCS, PROCEDURES, NAMES, WALL, PATROL, MOWER, GIVE_WAY];

#[test]
fn nine_have_no_diagnostics() {
    for text in RIGHT {
        assert_eq!(findings(text), "", "{text}");
    }
}

#[test]
fn the_limits_are_said_in_the_order_of_its_first_line() {
    let verdict = check(LIMITS);
    assert!(verdict.grammatical && verdict.excused.is_empty());
    let first_line = LIMITS.lines().next().unwrap_or_default();
    let expected = first_line.split_once("order: ").map_or("", |(_, codes)| codes).trim_end_matches('.');
    let codes: Vec<&str> = verdict.findings.iter().map(|finding| finding.code).collect();
    assert_eq!(codes.join(", "), expected);
    assert_eq!(codes.len(), 9);
    let lines = verdict.findings.iter().map(|finding| LIMITS[..finding.start].matches('\n').count());
    assert!(lines.is_sorted_by(|one, next| next - one == 1), "each in its own line");
}

/// The five mistakes, and each put right. Only with all of them it is a program.
const CORRECTIONS: [(&str, &str); 5] = [
    ("repaet 4 times", "repeat 4 times"),
    ("    move 1 meters\n  turn left\n}", "    move 1 meters\n  }\n  turn left\n}"),
    ("2 secs", "2 seconds"),
    ("  do\n", "  do second\n"),
    ("{ front\n", "{ front }\n"),
];

#[test]
fn each_of_the_five_mistakes_makes_it_no_program() {
    for left in 0..=CORRECTIONS.len() {
        let mut text = RECOVERY.to_owned();
        for (index, (wrong, right)) in CORRECTIONS.iter().enumerate() {
            assert_eq!(text.matches(wrong).count(), 1, "{wrong}");
            if index != left {
                text = text.replace(wrong, right);
            }
        }
        let is_right = left == CORRECTIONS.len();
        assert_eq!(check(&text).grammatical, is_right, "{text}");
        if is_right {
            assert_eq!(findings(&text), "", "{text}");
        }
    }
}

#[test]
fn the_article_has_none_of_them() {
    let is_refused =
        |text: &str| check_as_article(text).findings.iter().any(|finding| finding.code == "not-in-article");
    for text in RIGHT.iter().chain(&[LIMITS]) {
        assert!(is_refused(text), "{text}");
    }
    for text in ARTICLE {
        assert!(!is_refused(text), "{text}");
    }
}

const ARTICLE: [&str; 6] = [
    include_str!("../../../paper/table2_two_wheels.pyr"),
    include_str!("../../../paper/table3_four_wheels.pyr"),
    include_str!("../../../paper/table4_holonomic.pyr"),
    include_str!("../../../paper/table5_angles_as_printed.pyr"),
    include_str!("../../../paper/table6_sensors.pyr"),
    include_str!("../../../paper/table7_slam.pyr"),
];
