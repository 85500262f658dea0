//! The actions of a robot, and the way it drives each.

use crate::{Model, PerWheel, Pose, SpeedProfile, Turning, Twist, motion};

/// An action of a robot in numbers, without conditions and references.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionPrimitive {
    /// Straight ahead along the heading.
    Move {
        /// Metres; negative is backwards.
        distance: f64,
        /// Rim speed in metres per second, above zero.
        speed: f64,
    },
    /// As the robot turns ([`crate::Turning`]).
    Turn {
        /// Radians; positive is left (counter-clockwise).
        angle: f64,
        /// Rim speed of the fastest wheel in metres per second, above zero.
        speed: f64,
    },
    /// On a circle, whose centre is to the side of the robot's middle.
    Arc {
        /// By how much the heading changes, radians; positive is left (counter-clockwise), forwards and in reverse.
        angle: f64,
        /// Of the circle that the robot's middle drives on, metres, above zero.
        radius: f64,
        /// Rim speed of the fastest wheel in metres per second, above zero.
        speed: f64,
        /// True if it drives backwards.
        reverse: bool,
    },
    /// Stands still.
    Wait {
        /// Not below zero.
        seconds: f64,
    },
    /// Something whose end only the world decides (`turn … until`, `slam`).
    Unknown {
        /// The longest way that it may drive, metres.
        reach: f64,
    },
}

impl MotionPrimitive {
    /// Returns the longest way that the robot's middle drives in it, metres.
    pub fn reach(self) -> f64 {
        match self {
            Self::Move { distance, .. } => distance.abs(),
            Self::Arc { angle, radius, .. } => angle.abs() * radius,
            Self::Turn { .. } | Self::Wait { .. } => 0.0,
            Self::Unknown { reach } => reach,
        }
    }

    /// Seconds that a robot takes for it; `None` if only the world decides, or if its speed is not above zero.
    pub fn duration(self, model: &Model) -> Option<f64> {
        if let Self::Wait { seconds } = self {
            return Some(seconds.max(0.0));
        }
        let (unit, amount, speed) = self.drive(model).filter(|(.., speed)| *speed > 0.0)?;
        Some(duration(&profile(amount * model.fastest_rim(unit), speed), amount))
    }

    /// The body's motion per unit of an amount, that amount in metres or radians, and the rim speed of the fastest wheel;
    /// `None` if it stands still, or only the world decides.
    fn drive(self, model: &Model) -> Option<(Twist, f64, f64)> {
        Some(match self {
            Self::Move { distance, speed } => {
                (Twist { vx: distance.signum(), ..Twist::default() }, distance, speed)
            }
            Self::Turn { angle, speed } => (model.turning().twist(angle), angle, speed),
            Self::Arc { angle, radius, speed, reverse } => {
                let radius = if reverse { -radius } else { radius };
                (Turning::OnCircle { radius }.twist(angle), angle, speed)
            }
            Self::Wait { .. } | Self::Unknown { .. } => return None,
        })
    }
}

fn profile(rim_travel: f64, speed: f64) -> SpeedProfile {
    SpeedProfile::new(rim_travel, speed, motion::RIM_ACCELERATION)
}

/// Seconds, with the rest after a drive.
fn duration(profile: &SpeedProfile, amount: f64) -> f64 {
    profile.duration() + if amount == 0.0 { 0.0 } else { motion::REST }
}

/// The kind of a leg of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegKind {
    /// The robot drives, from rest to rest.
    Drive,
    /// It stands still.
    Wait,
    /// A statement as a whole, because all ways through it end at the same pose after the same time. Which way it takes is
    /// not known; between its ends the leg leads evenly from one to the other.
    Whole,
}

/// The course of an action, independent of where it begins.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    pub(crate) kind: LegKind,
    /// The body's motion per unit of `amount`.
    unit: Twist,
    /// Metres or radians, not below zero.
    amount: f64,
    /// Where it ends, seen from where it begins, if that is not to be integrated.
    change: Option<Pose>,
    pub(crate) duration: f64,
    pub(crate) rates: PerWheel,
    pub(crate) profile: SpeedProfile,
    /// The body's motion per metre of rim travel; per second where the profile has no say.
    pub(crate) twist: Twist,
}

impl Course {
    /// `None` if only the world decides when the action ends.
    pub(crate) fn new(model: &Model, action: MotionPrimitive) -> Option<Self> {
        if let MotionPrimitive::Wait { seconds } = action {
            return Some(Self::wait(model, seconds));
        }
        let (unit, amount, speed) = action.drive(model)?;
        let rim_per_unit = model.fastest_rim(unit);
        let profile = profile(amount * rim_per_unit, speed);
        let twist = Twist { vx: unit.vx / rim_per_unit, vy: 0.0, omega: unit.omega / rim_per_unit };
        let peak = Twist { vx: twist.vx * profile.peak(), vy: 0.0, omega: twist.omega * profile.peak() };
        Some(Self {
            kind: LegKind::Drive,
            unit,
            amount: amount.abs(),
            change: None,
            duration: duration(&profile, amount),
            rates: model.inverse(peak).rates,
            profile,
            twist,
        })
    }

    fn wait(model: &Model, seconds: f64) -> Self {
        let still = Twist::default();
        let rates = model.inverse(still).rates;
        Self { kind: LegKind::Wait, rates, ..Self::even(still, seconds.max(0.0)) }
    }

    /// From one pose to another, given relative to it, in so many seconds.
    pub(crate) fn whole(to: &Pose, seconds: f64) -> Self {
        let twist = if seconds > 0.0 { Twist::towards(to, seconds) } else { Twist::default() };
        Self { change: Some(*to), ..Self::even(twist, seconds) }
    }

    fn even(twist: Twist, seconds: f64) -> Self {
        Self {
            kind: LegKind::Whole,
            unit: twist,
            amount: seconds,
            change: None,
            duration: seconds,
            rates: PerWheel::default(),
            profile: SpeedProfile::new(0.0, 0.0, motion::RIM_ACCELERATION),
            twist,
        }
    }

    /// Where it ends if it begins at `from`.
    pub(crate) fn end(&self, from: Pose) -> Pose {
        self.change.map_or_else(|| from.advance(self.unit, self.amount), |change| from.compose(&change))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;
    use crate::{Drive, Geometry, Leg, Step, plan_steps};

    fn model(drive: Drive) -> Model {
        let geometry = Geometry { track: 0.30, wheelbase: 0.25 };
        let model = Model::new(drive, &vec![0.05; drive.wheel_count()], geometry).unwrap();
        model.with_scrub_factor(1.5).unwrap()
    }

    fn leg(model: &Model, start: Pose, action: MotionPrimitive) -> Leg {
        plan_steps(model, start, &Step::flat(&[action]), &[]).legs.remove(0)
    }

    #[test]
    fn arcs_forward_and_in_reverse_to_both_sides() {
        let ends = [
            (FRAC_PI_2, false, Pose::new(1.0, 1.0, FRAC_PI_2)),
            (-FRAC_PI_2, false, Pose::new(1.0, -1.0, -FRAC_PI_2)),
            (PI, false, Pose::new(0.0, 2.0, PI)),
            (FRAC_PI_2, true, Pose::new(-1.0, -1.0, FRAC_PI_2)),
            (-FRAC_PI_2, true, Pose::new(-1.0, 1.0, -FRAC_PI_2)),
        ];
        for drive in Drive::ALL {
            for (angle, reverse, end) in ends {
                let arc = MotionPrimitive::Arc { angle, radius: 1.0, speed: 0.09, reverse };
                let to = leg(&model(drive), Pose::default(), arc).to;
                assert!(to.distance(&end) < 1e-12 && (to.theta - end.theta).abs() < 1e-12, "{to:?}");
            }
        }
    }

    #[test]
    fn the_speed_of_an_arc_is_that_of_its_fastest_wheel() {
        // Two wheels: R + d/2; skid-steer with its wider track; mecanum wheels: R + K with K = (wheelbase + track)/2.
        let widest =
            [(Drive::TwoWheel, 0.15), (Drive::FourWheel, 0.15 * 1.5), (Drive::Mecanum, 0.125 + 0.15)];
        for (drive, beyond) in widest {
            let arc = MotionPrimitive::Arc { angle: -PI, radius: 1.0, speed: 0.2, reverse: false };
            let leg = leg(&model(drive), Pose::default(), arc);
            let expected = PI * (1.0 + beyond) / 0.2 + 0.2 / motion::RIM_ACCELERATION + motion::REST;
            assert!((leg.duration - expected).abs() < 1e-9, "{drive:?}: {leg:?}");
            let fastest = leg.rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
            assert!((fastest * 0.05 - 0.2).abs() < 1e-12, "{drive:?}: {leg:?}");
        }
    }

    #[test]
    fn the_inner_wheels_of_an_arc_are_slower_and_may_turn_back() {
        let model = model(Drive::TwoWheel);
        let rates = |radius, reverse| {
            let arc = MotionPrimitive::Arc { angle: PI, radius, speed: 0.1, reverse };
            leg(&model, Pose::default(), arc).rates.to_vec()
        };
        let close = |got: Vec<f64>, left: f64, right: f64| {
            assert!((got[0] - left).abs() < 1e-12 && (got[1] - right).abs() < 1e-12, "{got:?}");
        };
        close(rates(0.45, false), 1.0, 2.0);
        close(rates(0.05, false), -1.0, 2.0);
        close(rates(0.45, true), -2.0, -1.0);
    }

    #[test]
    fn a_wait_takes_its_time_and_nothing_else() {
        let start = Pose::new(1.0, 2.0, 3.0);
        let leg = leg(&model(Drive::FourWheel), start, MotionPrimitive::Wait { seconds: 2.5 });
        assert_eq!((leg.kind, leg.to, leg.end()), (LegKind::Wait, start, Some(2.5)));
        assert!(leg.rates.len() == 4 && leg.rates.iter().all(|&rate| rate == 0.0));
        assert_eq!((leg.pose_at(1.0), leg.top_speed(0.5)), (start, 0.0));
    }

    #[test]
    fn turns_have_a_speed_of_their_own() {
        let turn = MotionPrimitive::Turn { angle: PI, speed: 0.3 };
        let leg = leg(&model(Drive::TwoWheel), Pose::default(), turn);
        assert!((leg.duration - (PI * 0.15 / 0.3 + 0.6 + motion::REST)).abs() < 1e-12, "{leg:?}");
    }

    proptest! {
        /// Short straight steps along the heading in their middle, at the speeds that the wheels have then.
        #[test]
        fn an_arc_is_what_its_wheels_drive(
            drive in prop::sample::select(Drive::ALL.to_vec()),
            x in -5.0..5.0, y in -5.0..5.0, theta in -PI..PI,
            angle in -7.0..7.0, radius in 0.01..3.0, speed in 0.02..0.5, reverse: bool,
        ) {
            let (model, start) = (model(drive), Pose::new(x, y, theta));
            let leg = leg(&model, start, MotionPrimitive::Arc { angle, radius, speed, reverse });
            let peak = model.forward(&crate::Setting { rates: leg.rates, ..crate::Setting::default() });
            let count = 4_000;
            let dt = leg.duration / f64::from(count);
            let mut pose = start;
            for step in 0..count {
                let share = |seconds: f64| leg.profile.distance_at(seconds) / leg.profile.peak();
                let seconds = share(f64::from(step + 1) * dt) - share(f64::from(step) * dt);
                let heading = pose.theta + peak.omega * seconds / 2.0;
                pose = Pose::new(
                    pose.x + peak.vx * seconds * heading.cos(),
                    pose.y + peak.vx * seconds * heading.sin(),
                    pose.theta + peak.omega * seconds,
                );
                let there = leg.pose_at(f64::from(step + 1) * dt);
                prop_assert!(there.distance(&pose) < 1e-5, "{there:?}, not {pose:?}");
            }
            prop_assert!(leg.to.distance(&pose) < 1e-5);
            prop_assert!(crate::angle_between(leg.to.theta, pose.theta).abs() < 1e-9);
        }
    }
}
