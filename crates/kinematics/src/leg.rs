//! The legs of a planned path: where each begins and ends, when, and which statement it belongs to.

use std::sync::Arc;

use crate::{LegKind, PerWheel, Pose, SpeedProfile, Twist};

/// The place of an action in a schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ActionIndex {
    /// Which group of the schedule.
    pub group: usize,
    /// Which run of the group.
    pub run: usize,
    /// Which action of the run: the number of its statement in its movement, from 0. That movement is the last one
    /// called ([`Place::calls`]), if any is.
    pub action: usize,
}

/// A statement that calls a movement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Call {
    /// The number of the calling statement in its own movement, from 0.
    pub action: usize,
    /// The movement that it calls.
    pub movement: usize,
}

/// In which rounds and calls an action is. One outside of them costs nothing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Place(Option<Arc<Nested>>);

#[derive(Debug, PartialEq, Eq)]
struct Nested {
    rounds: Vec<u32>,
    counts: Vec<u32>,
    calls: Vec<Call>,
}

impl Place {
    pub(crate) fn new(rounds: &[u32], counts: &[u32], calls: &[Call]) -> Self {
        let is_outside = rounds.is_empty() && calls.is_empty();
        let nested = || {
            let (rounds, counts, calls) = (rounds.to_vec(), counts.to_vec(), calls.to_vec());
            Arc::new(Nested { rounds, counts, calls })
        };
        Self((!is_outside).then(nested))
    }

    /// The rounds of the repetitions around it, from 1, the outermost first, also of those around calls.
    pub fn rounds(&self) -> &[u32] {
        self.0.as_ref().map_or(&[], |nested| &nested.rounds)
    }

    /// Returns the number of rounds of each of those repetitions.
    pub fn counts(&self) -> &[u32] {
        self.0.as_ref().map_or(&[], |nested| &nested.counts)
    }

    /// The calls that lead to it, the outermost first.
    pub fn calls(&self) -> &[Call] {
        self.0.as_ref().map_or(&[], |nested| &nested.calls)
    }
}

/// A part of a planned path: mostly the drive of one action, from rest to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Leg {
    /// Which action.
    pub index: ActionIndex,
    /// In which round of what, called by whom.
    pub place: Place,
    /// Its kind.
    pub kind: LegKind,
    /// The pose it starts from.
    pub from: Pose,
    /// The pose it ends at.
    pub to: Pose,
    /// When it starts, seconds; `None` when some earlier action takes an unknown time.
    pub start: Option<f64>,
    /// Its duration, seconds, with ramps and [`crate::motion::REST`].
    pub duration: f64,
    /// Wheel rates at the highest speed it reaches, rad/s, in the order of the robot's wheels; none for [`LegKind::Whole`].
    pub rates: PerWheel,
    /// Rim speed over time; over no way for what is no drive.
    pub profile: SpeedProfile,
    /// Body motion per metre of rim travel, for what is no drive per second; times the whole it leads from `from` to `to`.
    pub(crate) twist: Twist,
}

impl Leg {
    /// When it ends, seconds; `None` when some earlier action takes an unknown time.
    pub fn end(&self) -> Option<f64> {
        Some(self.start? + self.duration)
    }

    /// The highest speed that any point within `reach` metres of the robot's middle may have, metres per second. What
    /// it is in a [`LegKind::Whole`] nobody knows: then it is that of its even motion.
    pub fn top_speed(&self, reach: f64) -> f64 {
        let Twist { vx, vy, omega } = self.twist;
        let pace = if self.kind == LegKind::Drive { self.profile.peak() } else { 1.0 };
        (vx.hypot(vy) + omega.abs() * reach) * pace
    }

    /// The angle of the arc that the robot's middle drives, radians, not negative; 0 on a line and for a turn in place.
    pub fn arc(&self) -> f64 {
        let Twist { vx, vy, omega } = self.twist;
        let on_circle = self.kind == LegKind::Drive && vx.hypot(vy) > 0.0;
        if on_circle { omega.abs() * self.profile.distance_at(self.profile.duration()) } else { 0.0 }
    }

    /// The pose `seconds` after the leg's start.
    pub fn pose_at(&self, seconds: f64) -> Pose {
        if seconds >= self.duration {
            return self.to;
        }
        let way =
            if self.kind == LegKind::Drive { self.profile.distance_at(seconds) } else { seconds.max(0.0) };
        self.from.advance(self.twist, way)
    }
}
