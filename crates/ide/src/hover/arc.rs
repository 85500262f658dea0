//! A turn on a circle: where its centre is, the circle of each wheel, and how fast that turns.

use pydslrep_analysis::environment::{Circle, ResolvedActionKind, Robot, Wheel};
use pydslrep_kinematics::{Leg, Model, Pose, Setting, Turning, Twist};

use super::format::number;
use super::parts::equations;

/// A turn on a circle.
pub(super) struct Arc<'a> {
    robot: &'a Robot,
    model: &'a Model,
    /// Its motion per radian.
    twist: Twist,
    speed: f64,
    reverse: bool,
}

impl<'a> Arc<'a> {
    /// That of an action; `None` if it is another one.
    pub(super) fn new(robot: &'a Robot, model: &'a Model, kind: &ResolvedActionKind) -> Option<Self> {
        let ResolvedActionKind::Turn {
            left, degrees, circle: Some(Circle { radius, reverse }), speed, ..
        } = *kind
        else {
            return None;
        };
        let side = if left == degrees.is_none_or(|degrees| degrees >= 0.0) { 1.0 } else { -1.0 };
        let radius = if reverse { -radius } else { radius };
        let twist = Turning::OnCircle { radius }.twist(side);
        Some(Self { robot, model, twist, speed, reverse })
    }

    /// Its leg and its start pose are `None` where they are not known.
    pub(super) fn describe(&self, leg: Option<&Leg>, start: Option<Pose>) -> String {
        let rim = leg.map_or(self.speed, |leg| leg.profile.peak());
        let omega = rim / self.model.fastest_rim(self.twist);
        let twist = Twist { vx: self.twist.vx * omega, vy: 0.0, omega: self.twist.omega * omega };
        format!(
            "{} At the highest speed v = {} m/s and ω = {} rad/s.\n\n{}\n{}",
            self.centre(start),
            number(twist.vx, 3),
            number(twist.omega, 3),
            self.wheels(&self.model.inverse(twist)),
            equations(self.robot).trim(),
        )
    }

    /// Where the centre of rotation is, and what that means in reverse.
    fn centre(&self, start: Option<Pose>) -> String {
        let to_left = self.twist.vx * self.twist.omega > 0.0;
        let (side, heading) = if to_left { ("left", "right") } else { ("right", "left") };
        let radius = number(self.twist.vx.abs(), 3);
        let point = start.and_then(|pose| pose.centre_of_rotation(self.twist));
        let point = point.map(|(x, y)| format!("at ({} m, {} m), ", number(x, 3), number(y, 3)));
        let point = point.unwrap_or_default();
        let centre = format!("The centre of rotation is {point}{radius} m to the {side} of the robot.");
        if self.reverse {
            format!(
                "{centre} Backwards, the heading turns to the {heading}, as if wheels were steered to the {side}."
            )
        } else {
            centre
        }
    }

    /// The circle and the rate of each wheel.
    fn wheels(&self, setting: &Setting) -> String {
        let centre = self.twist.turning_radius().unwrap_or_default();
        let positions = self.model.geometry().wheel_positions(self.model.drive());
        let wheels = self.robot.wheels.iter().zip(positions).zip(&setting.rates);
        let row = |((wheel, (x, y)), rate): ((&Wheel, (f64, f64)), &f64)| {
            let radius = number(x.hypot(centre - y), 3);
            format!("| `{}` | {radius} m | {} rad/s |\n", wheel.name, number(*rate, 2))
        };
        format!(
            "| wheel | radius of its circle | rate |\n|---|---|---|\n{}",
            wheels.map(row).collect::<String>()
        )
    }
}
