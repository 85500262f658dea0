//! Numbers in tables.

use pydslrep_kinematics::heading_degrees;

/// A heading in degrees, in (−180, 180] even when rounded.
pub(crate) fn heading(radians: f64) -> String {
    fixed(heading_degrees(radians, 1), 1)
}

/// A number with a fixed number of decimals, never −0.
pub(crate) fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(positive) if positive.chars().all(|c| c == '0' || c == '.') => positive.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{fixed, heading};

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(fixed(-0.0001, 3), "0.000");
        assert_eq!(fixed(-0.0006, 3), "-0.001");
        assert_eq!(fixed(4.0, 2), "4.00");
        assert_eq!([0.00001 - PI, PI, -3.1].map(heading), ["180.0", "180.0", "-177.6"]);
    }
}
