//! Summaries of sequences of steps, without a look at every round.

use crate::block::Block;
use crate::{Model, Pose, Step, angle_between};

/// The maximum duration of a plan, seconds: thirty days.
pub const MAX_PLAN_DURATION: f64 = 30.0 * 24.0 * 3600.0;

/// Ways that differ by less, in metres, radians and seconds, end alike.
const ALIKE: f64 = 1e-9;

/// From where a robot is to where it is some time later.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// The later pose, seen from the earlier one.
    pub change: Pose,
    /// The time between them.
    pub seconds: f64,
}

impl Motion {
    /// This motion, then another.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self { change: self.change.compose(&next.change), seconds: self.seconds + next.seconds }
    }

    /// This motion so many times: the pose by repeated squaring, the time by multiplication.
    #[must_use]
    pub fn repeated(&self, count: u32) -> Self {
        let (mut change, mut square, mut left) = (Pose::default(), self.change, count);
        while left > 0 {
            if left & 1 == 1 {
                change = change.compose(&square);
            }
            square = square.compose(&square);
            left >>= 1;
        }
        Self { change, seconds: self.seconds * f64::from(count) }
    }

    /// Returns whether both end at the same pose after the same time, within 1e-9 m, rad and s.
    pub fn ends_like(&self, other: &Self) -> bool {
        self.change.distance(&other.change) <= ALIKE
            && angle_between(self.change.theta, other.change.theta).abs() <= ALIKE
            && (self.seconds - other.seconds).abs() <= ALIKE
    }
}

/// The summary of a sequence of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// `None` if only the world decides where or when it ends.
    pub motion: Option<Motion>,
    /// The number of its entries in a plan, rounds and calls unrolled.
    pub entries: u64,
}

impl Default for Summary {
    /// Of no steps.
    fn default() -> Self {
        Self::known(Motion::default(), 0)
    }
}

impl Summary {
    /// Of steps; `called` has the summaries of the movements that they may call, and none of those that cannot be planned.
    ///
    /// It takes as long as the steps are, however often they repeat.
    pub fn of(model: &Model, steps: &[Step], called: &dyn Fn(usize) -> Option<Self>) -> Self {
        Block::new(model, steps, called).summary
    }

    pub(crate) fn known(motion: Motion, entries: u64) -> Self {
        Self { motion: Some(motion), entries }
    }

    /// Of one statement whose end only the world decides.
    pub(crate) fn unknown() -> Self {
        Self { motion: None, entries: 1 }
    }

    pub(crate) fn then(&self, next: &Self) -> Self {
        Self {
            motion: self.motion.zip(next.motion).map(|(motion, next)| motion.then(&next)),
            entries: self.entries.saturating_add(next.entries),
        }
    }

    pub(crate) fn repeated(&self, count: u32) -> Self {
        Self {
            motion: self.motion.map(|motion| motion.repeated(count)),
            entries: self.entries.saturating_mul(count.into()),
        }
    }

    /// One entry for all ways; known if they end alike.
    pub(crate) fn of_ways(ways: &[Self]) -> Self {
        let Some((first, others)) = ways.split_first() else {
            return Self::known(Motion::default(), 1);
        };
        let alike = |motion: &Motion| {
            others.iter().all(|other| other.motion.is_some_and(|other| other.ends_like(motion)))
        };
        Self { motion: first.motion.filter(alike), entries: 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{arc, either, forward, left, numbered, repeat, slam, turn, two_wheels, wait};

    fn of(steps: Vec<Step>) -> Summary {
        Summary::of(&two_wheels(), &numbered(steps), &|_| None)
    }

    #[test]
    fn a_million_million_rounds_are_as_quick_as_one() {
        let rounds = |body| repeat(10_000, vec![repeat(10_000, vec![repeat(10_000, body)])]);
        let line = of(vec![rounds(vec![forward(1.0)])]);
        let once = of(vec![forward(1.0)]).motion.unwrap().seconds;
        let motion = line.motion.unwrap();
        assert_eq!((motion.change, line.entries), (Pose::new(1e12, 0.0, 0.0), 1_000_000_000_000));
        assert!((motion.seconds / (1e12 * once) - 1.0).abs() < 1e-12);
        let squares = of(vec![rounds(vec![forward(1.0), left()])]).motion.unwrap();
        assert!(squares.change.distance(&Pose::default()) < 1e-3, "{squares:?}");
        assert_eq!(of(vec![rounds(vec![])]), Summary::default(), "nothing takes no time");
    }

    #[test]
    fn a_motion_repeated_is_one_after_the_other() {
        let motion = of(vec![forward(0.7), turn(50.0), arc(-70.0, 0.4, 0.2), wait(1.5)]).motion.unwrap();
        let mut each = Motion::default();
        for count in 0..200 {
            let at_once = motion.repeated(count);
            assert!(at_once.change.distance(&each.change) < 1e-11, "{count}: {at_once:?}, not {each:?}");
            assert!((at_once.seconds - each.seconds).abs() < 1e-9, "{count}: {at_once:?}, not {each:?}");
            each = each.then(&motion);
        }
    }

    #[test]
    fn a_branch_is_known_if_its_ways_end_alike() {
        let there = vec![forward(1.0), forward(-1.0)];
        let back = vec![forward(-1.0), forward(1.0)];
        let known = of(vec![either(vec![there.clone(), back.clone()])]);
        let alone = of(there.clone());
        assert!(known.motion.unwrap().ends_like(&alone.motion.unwrap()) && known.entries == 1);
        for other in [vec![], vec![forward(1.0)], vec![slam()], vec![forward(-1.0), forward(1.0), wait(2e-9)]]
        {
            let open = of(vec![either(vec![there.clone(), back.clone(), other])]);
            assert_eq!(open.motion, None);
        }
        assert!(of(vec![either(vec![vec![], vec![]])]).motion.is_some());
        assert!(of(vec![either(vec![vec![wait(1.0)], vec![wait(1.0 + 5e-10)]])]).motion.is_some());
        assert!(of(vec![either(vec![vec![turn(180.0)], vec![turn(-180.0)]])]).motion.is_some());
    }

    #[test]
    fn ends_are_alike_up_to_a_billionth() {
        let motion = |x, theta, seconds| Motion { change: Pose::new(x, 0.0, theta), seconds };
        for (apart, alike) in [(0.9e-9, true), (1.1e-9, false)] {
            for other in [motion(apart, 0.0, 0.0), motion(0.0, apart, 0.0), motion(0.0, 0.0, apart)] {
                assert_eq!(Motion::default().ends_like(&other), alike, "{other:?}");
            }
        }
    }

    #[test]
    fn calls_come_to_what_the_movement_does() {
        let side = of(vec![forward(1.0), left()]);
        let steps = numbered(vec![repeat(4, vec![crate::testing::call(7)])]);
        let of = |called: &dyn Fn(usize) -> Option<Summary>| Summary::of(&two_wheels(), &steps, called);
        let square = of(&|movement| (movement == 7).then_some(side));
        assert_eq!((square.motion, square.entries), (side.motion.map(|motion| motion.repeated(4)), 8));
        assert_eq!(of(&|_| None).motion, None);
    }
}
