//! Figures as people write them.

use pydslrep_kinematics::{Pose, heading_degrees};

/// A number with at most `places` digits behind the point, and no more than it needs.
pub(crate) fn number(value: f64, places: usize) -> String {
    let fixed = format!("{value:.places$}");
    let trimmed =
        if fixed.contains('.') { fixed.trim_end_matches('0').trim_end_matches('.') } else { &fixed };
    if trimmed == "-0" { "0".to_owned() } else { trimmed.to_owned() }
}

/// `(1.000 m, 0.500 m, 90°)`
pub(crate) fn pose(pose: &Pose) -> String {
    let degrees = number(heading_degrees(pose.theta, 1), 1);
    format!("({} m, {} m, {degrees}°)", number(pose.x, 3), number(pose.y, 3))
}

/// `12.3 s`, or minutes where those are easier to grasp.
pub(crate) fn time(seconds: f64) -> String {
    if seconds < 120.0 {
        return format!("{} s", number(seconds, 1));
    }
    let minutes = (seconds / 60.0).floor();
    format!("{} min {} s", number(minutes, 0), number(seconds - minutes * 60.0, 0))
}

/// Names as code, with commas.
pub(crate) fn names<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
