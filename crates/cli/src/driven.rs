//! The paths that robots really drove, as thin as a picture needs them.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_picture::Map;
use pydslrep_simulator::{Sightings, TraceRecord};
use serde::Deserialize;

/// Poses nearer than this to the last one kept are left out, metres and radians.
const FINENESS: f64 = 0.002;

/// The path of each robot of an environment, in its order.
#[derive(Debug)]
pub(crate) struct Driven {
    robots: Vec<DrivenPath>,
    /// Simulation time of the last record, seconds.
    pub(crate) time: f64,
    /// What the embedded simulator's sensors saw.
    pub(crate) seen: Sightings,
    /// What each robot found on exploring; empty where none does.
    pub(crate) maps: Vec<Map>,
}

/// The path of a robot.
#[derive(Debug)]
pub(crate) struct DrivenPath {
    robot: String,
    kept: Vec<TimedPose>,
    last: Option<TimedPose>,
}

/// A line of a trace file, as far as it matters here.
#[derive(Deserialize)]
struct Line {
    t: f64,
    robot: String,
    x: f64,
    y: f64,
    theta: f64,
}

impl Driven {
    /// No path yet.
    pub(crate) fn new<'a>(robots: impl Iterator<Item = &'a str>) -> Self {
        let robots = robots.map(|robot| DrivenPath { robot: robot.to_owned(), kept: Vec::new(), last: None });
        Self { robots: robots.collect(), time: 0.0, seen: Sightings::default(), maps: Vec::new() }
    }

    /// Goes on with what the simulator recorded.
    pub(crate) fn extend(&mut self, records: &[TraceRecord]) {
        for record in records {
            self.add(record.t, &record.robot, Pose::new(record.x, record.y, record.theta));
        }
    }

    /// Goes on with what a script wrote.
    ///
    /// # Errors
    /// When the file cannot be read or is no trace.
    pub(crate) fn read(&mut self, file: &Path) -> io::Result<()> {
        for line in BufReader::new(File::open(file)?).lines() {
            let line: Line = serde_json::from_str(&line?)?;
            self.add(line.t, &line.robot, Pose::new(line.x, line.y, line.theta));
        }
        Ok(())
    }

    /// The paths in the order of the robots.
    pub(crate) fn paths(&self) -> &[DrivenPath] {
        &self.robots
    }

    fn add(&mut self, time: f64, robot: &str, pose: Pose) {
        self.time = self.time.max(time);
        let Some(path) = self.robots.iter_mut().find(|path| path.robot == robot) else { return };
        path.add(TimedPose { time: Some(time), pose });
    }
}

impl DrivenPath {
    /// Its poses, the first and the last always among them.
    pub(crate) fn poses(&self) -> Vec<TimedPose> {
        let end = self.last.filter(|last| self.kept.last() != Some(last));
        self.kept.iter().copied().chain(end).collect()
    }

    /// Where it began.
    pub(crate) fn start(&self) -> Option<Pose> {
        self.kept.first().map(|first| first.pose)
    }

    /// Where it ended.
    pub(crate) fn end(&self) -> Option<Pose> {
        self.last.map(|last| last.pose)
    }

    fn add(&mut self, now: TimedPose) {
        let is_near = |kept: &TimedPose| {
            let off = kept.pose.relative(&now.pose);
            off.x.hypot(off.y) < FINENESS && off.theta.abs() < FINENESS
        };
        if !self.kept.last().is_some_and(is_near) {
            // Until when it stood there before it went on.
            let rest = self.last.filter(|last| self.kept.last().is_some_and(|kept| kept.pose == last.pose));
            self.kept.extend(rest.filter(|rest| self.kept.last() != Some(rest)));
            self.kept.push(now);
        }
        self.last = Some(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_pose_is_kept_however_near_it_is() {
        let mut driven = Driven::new(["a", "b"].into_iter());
        for (t, x) in [(0.0, 0.0), (0.05, 0.001), (0.1, 0.01), (0.15, 0.0101)] {
            driven.add(t, "a", Pose::new(x, 0.0, 0.0));
        }
        driven.add(0.2, "stranger", Pose::default());
        let xs: Vec<f64> = driven.paths()[0].poses().iter().map(|timed| timed.pose.x).collect();
        assert_eq!(xs, [0.0, 0.01, 0.0101]);
        assert!(driven.paths()[1].end().is_none());
    }

    #[test]
    fn a_rest_has_two_ends() {
        let mut driven = Driven::new(["a"].into_iter());
        for (t, x) in [(0.0, 0.0), (0.05, 0.0), (0.1, 0.0), (0.15, 0.01), (0.2, 0.02)] {
            driven.add(t, "a", Pose::new(x, 0.0, 0.0));
        }
        let times: Vec<Option<f64>> = driven.paths()[0].poses().iter().map(|timed| timed.time).collect();
        assert_eq!(times, [0.0, 0.1, 0.15, 0.2].map(Some));
    }
}
