//! Numbers, poses and durations as text.

use pydslrep_kinematics::{Pose, heading_degrees};

/// A number with at most `places` decimals, without trailing zeros.
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

/// A number with fixed decimals, and no minus before zero. The minus sign is ASCII, as in programs.
pub(crate) fn fixed(value: f64, places: usize) -> String {
    let digits = format!("{:.places$}", value.abs());
    let is_zero = digits.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero { format!("-{digits}") } else { digits }
}

/// `1.00, -0.50, 90°`: a short pose, rounded to centimetres as in the preview, in the order of `start` in a scene file.
pub(crate) fn short_pose(pose: &Pose) -> String {
    let degrees = number(heading_degrees(pose.theta, 1), 1);
    format!("{}, {}, {degrees}°", fixed(pose.x, 2), fixed(pose.y, 2))
}

/// `12.3 s`, or with minutes from one minute on, as in the preview (`webview/preview/format.ts`).
pub(crate) fn time(seconds: f64) -> String {
    const MINUTE: f64 = 600.0;
    let tenths = (seconds * 10.0).round();
    if tenths < MINUTE {
        return format!("{} s", fixed(tenths / 10.0, 1));
    }
    let rest = (tenths % MINUTE) / 10.0;
    let places = usize::from(rest.fract() != 0.0 || tenths < 10.0 * MINUTE);
    format!("{} min {} s", fixed((tenths / MINUTE).floor(), 0), fixed(rest, places))
}

/// Names as inline code, separated by commas.
pub(crate) fn names<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_match_the_preview() {
        let shown: Vec<String> =
            [0.0, 11.0, 44.62, 59.94, 59.96, 111.14, 600.0, 605.25].into_iter().map(time).collect();
        assert_eq!(
            shown,
            [
                "0.0 s",
                "11.0 s",
                "44.6 s",
                "59.9 s",
                "1 min 0.0 s",
                "1 min 51.1 s",
                "10 min 0 s",
                "10 min 5.3 s"
            ]
        );
    }

    #[test]
    fn short_poses_have_no_minus_before_zero() {
        let pose = |x, y, degrees: f64| short_pose(&Pose::new(x, y, degrees.to_radians()));
        assert_eq!(pose(-0.0001, -4.0, -180.0), "0.00, -4.00, 180°");
        assert_eq!(pose(12.345, 0.999, -41.13), "12.35, 1.00, -41.1°");
    }
}
