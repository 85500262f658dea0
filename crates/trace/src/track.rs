//! The path of a robot, simplified while it is recorded.

use pydslrep_kinematics::{Pose, TimedPose};

/// The poses of a robot in chronological order.
#[derive(Debug, Clone)]
pub struct Track {
    tolerance: f64,
    kept: Vec<TimedPose>,
    last: Option<TimedPose>,
}

impl Track {
    /// An empty track. Poses closer than `tolerance`, metres and radians, to the last kept one are dropped.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, kept: Vec::new(), last: None }
    }

    /// Appends a pose.
    pub fn add(&mut self, now: TimedPose) {
        if !self.kept.last().is_some_and(|kept| self.is_near(kept, &now)) {
            // Keep the end of a rest, or the robot would seem to creep all that time.
            let rest = self.last.filter(|last| self.kept.last().is_some_and(|kept| is_rest(kept, last)));
            self.kept.extend(rest);
            self.kept.push(now);
        }
        self.last = Some(now);
    }

    /// The kept poses, always including the first and the last.
    pub fn poses(&self) -> Vec<TimedPose> {
        let end = self.last.filter(|last| self.kept.last() != Some(last));
        self.kept.iter().copied().chain(end).collect()
    }

    /// The start pose.
    pub fn start(&self) -> Option<Pose> {
        self.kept.first().map(|first| first.pose)
    }

    /// The last pose.
    pub fn end(&self) -> Option<Pose> {
        self.last.map(|last| last.pose)
    }

    fn is_near(&self, kept: &TimedPose, now: &TimedPose) -> bool {
        let off = kept.pose.relative(&now.pose);
        off.x.hypot(off.y) < self.tolerance && off.theta.abs() < self.tolerance
    }
}

/// Returns whether the robot stayed longer than it could in motion: half a second.
fn is_rest(from: &TimedPose, to: &TimedPose) -> bool {
    from.time.zip(to.time).is_some_and(|(from, to)| to - from > 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(points: impl IntoIterator<Item = (f64, f64)>) -> Track {
        let mut track = Track::new(0.002);
        for (time, x) in points {
            track.add(TimedPose { time: Some(time), pose: Pose::new(x, 0.0, 0.0) });
        }
        track
    }

    #[test]
    fn the_last_pose_is_always_kept() {
        let track = track([(0.0, 0.0), (0.05, 0.001), (0.1, 0.01), (0.15, 0.0101)]);
        let xs: Vec<f64> = track.poses().iter().map(|timed| timed.pose.x).collect();
        assert_eq!(xs, [0.0, 0.01, 0.0101]);
        assert_eq!((track.start().unwrap().x, track.end().unwrap().x), (0.0, 0.0101));
    }

    #[test]
    fn both_ends_of_a_rest_are_kept() {
        // It moves, rests for a second, and moves on.
        let steps = (0..40).map(f64::from);
        let track = track(steps.map(|step| (0.05 * step, 0.01 * (step.min(10.0) + (step - 30.0).max(0.0)))));
        let poses = track.poses();
        assert_eq!(poses.len(), 11 + 1 + 9, "{poses:?}");
        assert!((poses[11].time.unwrap() - 1.5).abs() < 1e-9, "{:?}", poses[11]);
    }

    #[test]
    fn an_empty_track_has_no_poses() {
        assert!(track([]).poses().is_empty() && track([]).end().is_none());
    }
}
