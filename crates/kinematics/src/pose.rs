//! Poses and twists in the plane, and the exact motion that links them.

use std::f64::consts::{PI, TAU};

/// Where a body is and where it heads.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Heading in radians, counter-clockwise from +x. Every operation here returns it in (−π, π].
    pub theta: f64,
}

/// The velocity of a body, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Twist {
    /// Forward speed, metres per second.
    pub vx: f64,
    /// Speed to the left, metres per second; only holonomic robots have it.
    pub vy: f64,
    /// Turning rate, radians per second, counter-clockwise.
    pub omega: f64,
}

impl Twist {
    /// The signed distance R from the body to its centre of rotation, to the left, in metres (R of the
    /// article's equations 1 to 6); `None` while the body does not turn. Sideways motion moves the centre fore or
    /// aft, not to the side.
    pub fn turning_radius(&self) -> Option<f64> {
        (self.omega != 0.0).then(|| self.vx / self.omega)
    }

    /// The twist that leads from the origin to a pose in so many seconds, above zero, by the shorter turn.
    ///
    /// It undoes [`Pose::advance`]: the logarithm of SE(2) (Lynch and Park, "Modern Robotics", 3.3.3). The displacement
    /// there is a rotation by a/2 of the velocity, sin(a/2)/(a/2) times as long, with a the whole turn.
    pub fn towards(pose: &Pose, seconds: f64) -> Self {
        let half = pose.theta / 2.0;
        let (sin, cos) = half.sin_cos();
        let rate = 1.0 / (sinc(half) * seconds);
        Self {
            vx: (cos * pose.x + sin * pose.y) * rate,
            vy: (cos * pose.y - sin * pose.x) * rate,
            omega: pose.theta / seconds,
        }
    }
}

impl Pose {
    /// A pose from metres and radians.
    pub fn new(x: f64, y: f64, theta: f64) -> Self {
        Self { x, y, theta: wrap_angle(theta) }
    }

    /// The pose after `seconds` of a constant twist.
    ///
    /// Exact: the body turns about its centre of rotation by ωΔt (the article's equations 1 to 6; with sideways
    /// motion the exponential map of SE(2), Lynch and Park, "Modern Robotics", 3.3.3). With a = ωΔt the
    /// displacement is (sin a / a, (1 − cos a) / a) applied to the velocity; the second factor is computed as
    /// sin(a/2) · sin(a/2)/(a/2), which unlike 1 − cos a cancels nothing, so ω → 0 loses no precision.
    #[must_use]
    pub fn advance(&self, twist: Twist, seconds: f64) -> Self {
        let angle = twist.omega * seconds;
        let along = sinc(angle);
        let across = (angle / 2.0).sin() * sinc(angle / 2.0);
        let (forward, left) = (twist.vx * seconds, twist.vy * seconds);
        self.compose(&Pose {
            x: along * forward - across * left,
            y: across * forward + along * left,
            theta: angle,
        })
    }

    /// `other`, given relative to this pose, in the frame this pose is given in.
    #[must_use]
    pub fn compose(&self, other: &Pose) -> Self {
        let (sin, cos) = self.theta.sin_cos();
        Self {
            x: self.x + cos * other.x - sin * other.y,
            y: self.y + sin * other.x + cos * other.y,
            theta: wrap_angle(self.theta + other.theta),
        }
    }

    /// `other`, given in the same frame as this pose, as seen from this pose:
    /// `self.compose(&self.relative(&other))` is `other`.
    #[must_use]
    pub fn relative(&self, other: &Pose) -> Self {
        let (sin, cos) = self.theta.sin_cos();
        let (dx, dy) = (other.x - self.x, other.y - self.y);
        Self { x: cos * dx + sin * dy, y: cos * dy - sin * dx, theta: angle_between(self.theta, other.theta) }
    }

    /// The distance to another pose's position, in metres.
    pub fn distance(&self, other: &Pose) -> f64 {
        (other.x - self.x).hypot(other.y - self.y)
    }

    /// The point a body here turns about, in metres: (x − R sin θ, y + R cos θ) of the article's equations 1 to
    /// 6, moved along the heading by −vy/ω for sideways motion; `None` while it does not turn.
    pub fn centre_of_rotation(&self, twist: Twist) -> Option<(f64, f64)> {
        let radius = twist.turning_radius()?;
        let along = -twist.vy / twist.omega;
        let (sin, cos) = self.theta.sin_cos();
        Some((self.x + along * cos - radius * sin, self.y + along * sin + radius * cos))
    }
}

/// The same direction in (−π, π]. Angles already there come back bit for bit.
pub fn wrap_angle(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    let wrapped = angle.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// A heading in degrees as people read it, rounded to so many decimals: in (−180, 180] also after rounding, and never
/// −0.
pub fn heading_degrees(theta: f64, decimals: u8) -> f64 {
    let scale = 10_f64.powi(i32::from(decimals));
    let rounded = (wrap_angle(theta).to_degrees() * scale).round() / scale;
    if rounded <= -180.0 { 180.0 } else { rounded + 0.0 }
}

/// The shortest turn from one heading to another, in (−π, π], positive to the left.
pub fn angle_between(from: f64, to: f64) -> f64 {
    wrap_angle(to - from)
}

/// sin(x)/x, 1 at 0. The quotient itself is accurate for every other x, however small.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;

    use super::*;

    fn assert_close(got: Pose, want: Pose, tolerance: f64) {
        assert!(
            got.distance(&want) <= tolerance && angle_between(got.theta, want.theta).abs() <= tolerance,
            "got {got:?}, want {want:?}"
        );
    }

    #[test]
    fn half_a_turn_is_read_one_way() {
        let just_beyond = -std::f64::consts::PI + 1e-6;
        assert_eq!(heading_degrees(just_beyond, 1).to_string(), "180");
        assert_eq!(heading_degrees(-1e-9, 1).to_string(), "0");
        assert_eq!(heading_degrees(-std::f64::consts::FRAC_PI_2, 0).to_string(), "-90");
    }

    #[test]
    fn quarter_circle_to_the_left() {
        let twist = Twist { vx: FRAC_PI_2, vy: 0.0, omega: FRAC_PI_2 };
        assert_close(Pose::default().advance(twist, 1.0), Pose::new(1.0, 1.0, FRAC_PI_2), 1e-15);
        assert_eq!(twist.turning_radius(), Some(1.0));
        let centre = Pose::new(2.0, 3.0, FRAC_PI_2).centre_of_rotation(twist).unwrap();
        assert!((centre.0 - 1.0).abs() < 1e-15 && (centre.1 - 3.0).abs() < 1e-15, "{centre:?}");
    }

    #[test]
    fn slow_turns_keep_every_digit_of_the_sideways_offset() {
        // y = v t · a/2 for small a; 1 − cos a would already be 0 here.
        for omega in [1e-9, 1e-12, 1e-100, 1e-300] {
            let pose = Pose::default().advance(Twist { vx: 1.0, vy: 0.0, omega }, 1.0);
            assert!((pose.y / (omega / 2.0) - 1.0).abs() < 1e-15, "ω = {omega}: y = {}", pose.y);
            assert!((pose.x - 1.0).abs() < 1e-15);
        }
        assert_eq!(
            Pose::default().advance(Twist { vx: 2.0, vy: -1.0, omega: 0.0 }, 3.0),
            Pose::new(6.0, -3.0, 0.0)
        );
    }

    #[test]
    fn wrapping_prefers_plus_pi() {
        assert!((wrap_angle(-PI) - PI).abs() < 1e-15);
        assert!((wrap_angle(3.0 * PI) - PI).abs() < 1e-15);
        assert!((wrap_angle(-TAU - 0.5) + 0.5).abs() < 1e-15);
        assert!(wrap_angle(f64::NAN).is_nan());
    }

    prop_compose! {
        fn poses()(x in -10.0..10.0, y in -10.0..10.0, theta in -PI..PI) -> Pose { Pose::new(x, y, theta) }
    }
    prop_compose! {
        fn twists()(vx in -1.0..1.0, vy in -1.0..1.0, omega in -3.0..3.0) -> Twist { Twist { vx, vy, omega } }
    }

    proptest! {
        #[test]
        fn relative_undoes_compose(a in poses(), b in poses()) {
            assert_close(a.relative(&a.compose(&b)), b, 1e-12);
            assert_close(a.compose(&a.relative(&b)), b, 1e-12);
        }

        #[test]
        fn advancing_agrees_with_fine_euler_steps(start in poses(), twist in twists(), t in 0.1..2.0) {
            let n = 20_000;
            let dt = t / f64::from(n);
            let mut euler = start;
            for _ in 0..n {
                let (sin, cos) = euler.theta.sin_cos();
                euler.x += (twist.vx * cos - twist.vy * sin) * dt;
                euler.y += (twist.vx * sin + twist.vy * cos) * dt;
                euler.theta += twist.omega * dt;
            }
            assert_close(start.advance(twist, t), euler, 2e-3);
        }

        #[test]
        fn a_twist_towards_a_pose_gets_there(start in poses(), pose in poses(), seconds in 0.1..100.0) {
            let twist = Twist::towards(&pose, seconds);
            assert_close(start.advance(twist, seconds), start.compose(&pose), 1e-12);
        }

        #[test]
        fn two_halves_make_a_whole(start in poses(), twist in twists(), t in 0.0..5.0) {
            assert_close(start.advance(twist, t / 2.0).advance(twist, t / 2.0), start.advance(twist, t), 1e-12);
        }

        #[test]
        fn slowing_turns_become_the_straight_line_smoothly(
            start in poses(), vx in -1.0..1.0, vy in -1.0..1.0, exponent in 3..300i32,
        ) {
            let omega = 10f64.powi(-exponent);
            let straight = start.advance(Twist { vx, vy, omega: 0.0 }, 1.0);
            let curved = start.advance(Twist { vx, vy, omega }, 1.0);
            // The offset of an arc from its tangent is at most |v| ω/2; the rest is rounding.
            prop_assert!(straight.distance(&curved) <= omega + 1e-14);
        }

        #[test]
        fn the_centre_of_rotation_stays(start in poses(), twist in twists(), t in 0.0..2.0) {
            prop_assume!(twist.omega.abs() > 0.1);
            let before = start.centre_of_rotation(twist).unwrap();
            let after = start.advance(twist, t).centre_of_rotation(twist).unwrap();
            prop_assert!((before.0 - after.0).hypot(before.1 - after.1) < 1e-11);
        }

        #[test]
        fn wrapping_keeps_the_direction(angle in -1000.0..1000.0) {
            let wrapped = wrap_angle(angle);
            prop_assert!(wrapped > -PI && wrapped <= PI);
            prop_assert!((wrapped.sin() - angle.sin()).abs() < 1e-12 && (wrapped.cos() - angle.cos()).abs() < 1e-12);
        }
    }
}
