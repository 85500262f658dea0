//! The default positions of sensors, by the first letter of their names.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use pydslrep_kinematics::Pose;

use crate::{Body, SensorKind, defaults};

/// The position of a sensor on its robot, and what it sees from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    /// In the body's frame; the heading is the direction it faces.
    pub pose: Pose,
    /// Its range, metres.
    pub range: f64,
    /// Opening angle of its cone, radians.
    pub cone: f64,
}

/// The side of the robot that a sensor's name stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Front,
    Left,
    Right,
    Back,
    Any,
}

/// Mounts for sensors in listed order: names in f… form a fan of ±45° ahead, l… face left, r… right and b… back,
/// each group spread along its side; all others are spread over the front half, ±90°. Within a group the
/// first listed is leftmost (on the sides: foremost).
pub fn mounts_by_name(sensors: &[(String, SensorKind)], body: Body) -> Vec<Mount> {
    let sides: Vec<Side> = sensors.iter().map(|(name, _)| side(name)).collect();
    let count = |wanted| sides.iter().filter(|&&side| side == wanted).count();
    sides
        .iter()
        .zip(sensors)
        .enumerate()
        .map(|(index, (&side, &(_, kind)))| {
            let before = sides[..index].iter().filter(|&&other| other == side).count();
            let pose = position(side, spread(before, count(side)), body);
            Mount { pose, range: defaults::range(kind), cone: defaults::CONE }
        })
        .collect()
}

fn side(name: &str) -> Side {
    match name.chars().next().map(|first| first.to_ascii_lowercase()) {
        Some('f') => Side::Front,
        Some('l') => Side::Left,
        Some('r') => Side::Right,
        Some('b') => Side::Back,
        _ => Side::Any,
    }
}

/// The position of one of `count` in a row from +1 (the first) to −1 (the last); a single one is in the middle.
fn spread(index: usize, count: usize) -> f64 {
    let (Ok(index), Ok(last)) = (u32::try_from(index), u32::try_from(count.saturating_sub(1))) else {
        return 0.0;
    };
    if last == 0 { 0.0 } else { 1.0 - 2.0 * f64::from(index) / f64::from(last) }
}

fn position(side: Side, along: f64, body: Body) -> Pose {
    // Rows on a side stay clear of the corners.
    let (x, y) = (body.length / 2.0, body.width / 2.0);
    let row = 0.8 * along;
    match side {
        Side::Front => on_edge(FRAC_PI_4 * along, body),
        Side::Any => on_edge(FRAC_PI_2 * along, body),
        Side::Left => Pose::new(row * x, y, FRAC_PI_2),
        Side::Right => Pose::new(row * x, -y, -FRAC_PI_2),
        Side::Back => Pose::new(-x, row * y, PI),
    }
}

/// On the body's edge, facing away from its centre.
fn on_edge(direction: f64, body: Body) -> Pose {
    let (sin, cos) = direction.sin_cos();
    let to_edge = (body.length / 2.0 / cos.abs()).min(body.width / 2.0 / sin.abs());
    Pose::new(to_edge * cos, to_edge * sin, direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions(names: &[&str]) -> Vec<i32> {
        let sensors: Vec<_> = names.iter().map(|&name| (name.to_owned(), SensorKind::Distance)).collect();
        let body = Body { length: 0.36, width: 0.30 };
        let mounts = mounts_by_name(&sensors, body);
        for mount in &mounts {
            let (x, y) = (mount.pose.x.abs(), mount.pose.y.abs());
            let on_edge = (x - 0.18).abs() < 1e-12 || (y - 0.15).abs() < 1e-12;
            assert!(on_edge && x < 0.18 + 1e-12 && y < 0.15 + 1e-12, "{mount:?} is not on the body's edge");
        }
        #[allow(clippy::cast_possible_truncation)]
        mounts.iter().map(|mount| mount.pose.theta.to_degrees().round() as i32).collect()
    }

    #[test]
    fn one_on_each_side() {
        assert_eq!(directions(&["fSensor", "lSensor", "rSensor", "bSensor"]), [0, 90, -90, 180]);
    }

    #[test]
    fn a_fan_ahead_from_left_to_right() {
        assert_eq!(directions(&["f1", "l", "f2", "f3"]), [45, 90, 0, -45]);
    }

    #[test]
    fn other_names_cover_the_front_half() {
        assert_eq!(directions(&["s1", "s2", "s3", "s4", "s5"]), [90, 45, 0, -45, -90]);
        assert_eq!(directions(&["only"]), [0]);
    }

    #[test]
    fn the_first_on_a_side_is_foremost_and_the_first_behind_is_on_the_left() {
        let body = Body { length: 0.4, width: 0.3 };
        for (side, first, last) in [
            ("l", (0.16, 0.15), (-0.16, 0.15)),
            ("r", (0.16, -0.15), (-0.16, -0.15)),
            ("b", (-0.2, 0.12), (-0.2, -0.12)),
        ] {
            let names = [1, 2].map(|number| (format!("{side}{number}"), SensorKind::Distance));
            let mounts = mounts_by_name(&names, body);
            for (mount, (x, y)) in mounts.iter().zip([first, last]) {
                assert!((mount.pose.x - x).abs() < 1e-12 && (mount.pose.y - y).abs() < 1e-12, "{mounts:?}");
            }
        }
    }

    #[test]
    fn two_on_a_side_are_apart() {
        let sensors = [("l1".to_owned(), SensorKind::Bumper), ("l2".to_owned(), SensorKind::Distance)];
        let mounts = mounts_by_name(&sensors, Body { length: 0.3, width: 0.3 });
        assert!(mounts[0].pose.x > 0.1 && mounts[1].pose.x < -0.1, "{mounts:?}");
        assert!((mounts[0].range, mounts[1].range) == (0.05, 1.0));
    }
}
