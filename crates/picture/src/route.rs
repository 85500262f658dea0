//! The content of a picture.

use pydslrep_kinematics::{Pose, TimedPose, angle_between};
use pydslrep_scene::{Body, Obstacle};
use pydslrep_trace::Map;

/// The content of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picture<'a> {
    /// The title.
    pub title: &'a str,
    /// One route per robot.
    pub routes: &'a [Route],
    /// The obstacles.
    pub obstacles: &'a [Obstacle],
    /// The locations of planned collisions, metres.
    pub collisions: &'a [(f64, f64)],
}

/// The paths of one robot and what it detected.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// The robot's name.
    pub name: String,
    /// Its outer size.
    pub body: Body,
    /// The planned poses in order, the start first; see [`pydslrep_kinematics::RobotPath::sample`].
    pub planned: Vec<TimedPose>,
    /// True if the plan continues after its last pose with an action that cannot be planned.
    pub unknown_after: bool,
    /// The ways that the robot may take there, as far as they have a bound; each begins where the plan ends.
    pub possible: Vec<Vec<TimedPose>>,
    /// The driven poses in order; empty if nothing was driven.
    pub driven: Vec<TimedPose>,
    /// The points on the floor that the robot's sensors detected.
    pub seen: Vec<(f64, f64)>,
    /// The map that the robot made while exploring.
    pub map: Map,
}

impl Route {
    /// The driven poses, or the planned ones if nothing was driven; only finite ones.
    pub(crate) fn path(&self) -> Vec<TimedPose> {
        let path = if self.driven.is_empty() { &self.planned } else { &self.driven };
        path.iter().filter(|timed| is_drawable(timed)).copied().collect()
    }

    /// The ways of [`Self::possible`] that lead anywhere; none if the robot drove, which decided what it does.
    pub(crate) fn open_ways(&self) -> impl Iterator<Item = &Vec<TimedPose>> {
        let ways = if self.driven.is_empty() { self.possible.as_slice() } else { &[] };
        ways.iter().filter(|way| way.windows(2).any(|pair| pair[0].pose.distance(&pair[1].pose) > 0.0))
    }
}

/// Returns whether a pose is finite.
pub(crate) fn is_drawable(TimedPose { time, pose }: &TimedPose) -> bool {
    time.is_none_or(f64::is_finite) && pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite()
}

/// The latest known time of all routes, seconds.
pub(crate) fn duration(routes: &[Route]) -> Option<f64> {
    let times = routes.iter().flat_map(|route| route.path().into_iter().filter_map(|timed| timed.time));
    times.reduce(f64::max).filter(|&seconds| seconds > 0.0)
}

/// The pose at a time on a path, linearly interpolated; `None` outside the path.
pub(crate) fn pose_at(path: &[TimedPose], seconds: f64) -> Option<Pose> {
    let next = path.partition_point(|timed| timed.time.is_some_and(|time| time < seconds));
    let (after, before) = (path.get(next)?, path.get(next.saturating_sub(1))?);
    let (from, to) = (before.time?, after.time?);
    let part = if to > from { (seconds - from) / (to - from) } else { 1.0 };
    (from..=to).contains(&seconds).then(|| between(&before.pose, &after.pose, part))
}

fn between(from: &Pose, to: &Pose, part: f64) -> Pose {
    let along = |from: f64, to: f64| from + part * (to - from);
    let theta = from.theta + part * angle_between(from.theta, to.theta);
    Pose { x: along(from.x, to.x), y: along(from.y, to.y), theta }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_interpolated() {
        let at = |time, x, theta| TimedPose { time, pose: Pose { x, y: 0.0, theta } };
        let path = [at(Some(1.0), 0.0, 3.0), at(Some(3.0), 1.0, -3.0), at(None, 2.0, 0.0)];
        let found = pose_at(&path, 2.0).unwrap();
        assert!((found.x - 0.5).abs() < 1e-12);
        assert!((found.theta - std::f64::consts::PI).abs() < 1e-12, "the shorter turn: {found:?}");
        assert_eq!((pose_at(&path, 1.0).unwrap().x, pose_at(&path, 3.0).unwrap().x), (0.0, 1.0));
        assert_eq!((pose_at(&path, 0.5), pose_at(&path, 3.5), pose_at(&[], 0.0)), (None, None, None));
    }
}
