//! The paths that robots drove, with as many poses as a picture needs.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use pydslrep_kinematics::Pose;
use pydslrep_scene::Robot;
use pydslrep_simulator::Sightings;
use pydslrep_trace::{Map, TraceRecord, Track};

/// Poses nearer than this to the last one kept are dropped: metres and radians.
pub(crate) const FINENESS: f64 = 0.002;

/// The path of each robot, in the order of the environment.
#[derive(Debug, Default)]
pub(crate) struct Driven {
    robots: Vec<Robot>,
    tracks: Vec<Track>,
    /// The sightings of sensors, by the readings in a trace.
    read: Sightings,
    /// Simulation time of the last record, seconds.
    pub(crate) time: f64,
    /// The sightings of sensors in the embedded simulator.
    pub(crate) sightings: Sightings,
    /// The robots in the embedded simulator.
    simulated: Vec<usize>,
    /// The map of each robot; empty if none explores.
    pub(crate) maps: Vec<Map>,
}

impl Driven {
    /// Empty paths for these robots.
    ///
    /// `simulated` are the indices of those in the embedded simulator.
    pub(crate) fn new(robots: &[Robot], simulated: Vec<usize>) -> Self {
        let tracks = vec![Track::new(FINENESS); robots.len()];
        Self { robots: robots.to_vec(), tracks, simulated, ..Self::default() }
    }

    /// Adds the records of the simulator.
    pub(crate) fn extend(&mut self, records: &[TraceRecord]) {
        for record in records {
            self.add(record);
        }
    }

    /// Adds the trace that a script wrote, of all robots but those that the simulator recorded.
    ///
    /// # Errors
    /// If the file cannot be read or is not a trace.
    pub(crate) fn read(&mut self, file: &Path) -> io::Result<()> {
        for record in records(file)? {
            let record = record?;
            if !self.simulated.iter().any(|index| self.robots[*index].name == record.robot) {
                self.add(&record);
            }
        }
        Ok(())
    }

    /// The paths in the order of the robots.
    pub(crate) fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// The points that the sensors of a robot saw, metres.
    pub(crate) fn seen(&self, robot: usize) -> Vec<(f64, f64)> {
        let in_scene = self.simulated.iter().position(|index| *index == robot);
        in_scene.map_or_else(|| self.read.of(robot), |index| self.sightings.of(index))
    }

    fn add(&mut self, record: &TraceRecord) {
        self.time = self.time.max(record.t);
        let robots = self.robots.iter().zip(&mut self.tracks).enumerate();
        for (index, (robot, track)) in robots.filter(|(_, (robot, _))| robot.name == record.robot) {
            let now = record.timed_pose();
            // No time has passed since the record before when its sensors were read.
            let here = track.end().unwrap_or(now.pose);
            for point in points(robot, here, record) {
                self.read.add(index, point);
            }
            track.add(now);
        }
    }
}

/// The records of a trace that a script has written.
///
/// # Errors
/// If the file cannot be read; and each that is none.
pub(crate) fn records(file: &Path) -> io::Result<impl Iterator<Item = io::Result<TraceRecord>>> {
    let lines = BufReader::new(File::open(file)?).lines();
    Ok(lines.map(|line| Ok(serde_json::from_str(&line?)?)))
}

/// The points that the sensors of a robot read at a pose, metres.
fn points(robot: &Robot, here: Pose, record: &TraceRecord) -> impl Iterator<Item = (f64, f64)> {
    record.readings.iter().filter_map(move |(name, distance)| {
        let sensor = robot.sensors.iter().find(|sensor| sensor.name == *name)?;
        let seen = here.compose(&sensor.mount.pose).compose(&Pose::new((*distance)?, 0.0, 0.0));
        Some((seen.x, seen.y))
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use pydslrep_kinematics::Drive;
    use pydslrep_scene::SensorKind;

    use super::*;

    fn robot(name: &str) -> Robot {
        Robot::new(name, Drive::TwoWheel, Vec::new(), vec![("front".to_owned(), SensorKind::Distance)])
    }

    fn record(t: f64, robot: &str) -> TraceRecord {
        TraceRecord {
            t,
            robot: robot.to_owned(),
            x: t,
            y: 0.0,
            theta: 0.0,
            wheels: vec![],
            readings: BTreeMap::new(),
            movement: None,
            action: None,
        }
    }

    #[test]
    fn unknown_robots_are_ignored() {
        let mut driven = Driven::new(&["a", "b"].map(robot), vec![0, 1]);
        driven.extend(&[record(0.1, "a"), record(0.2, "stranger")]);
        let ends: Vec<bool> = driven.tracks().iter().map(|track| track.end().is_some()).collect();
        assert_eq!((ends, driven.time), (vec![true, false], 0.2));
    }

    #[test]
    fn readings_are_points_where_the_robot_was_before() {
        let readings =
            |distance| BTreeMap::from([("front".to_owned(), distance), ("none".to_owned(), Some(1.0))]);
        let first = TraceRecord { readings: readings(None), ..record(1.0, "a") };
        let second = TraceRecord { readings: readings(Some(0.5)), ..record(3.0, "a") };
        let mut driven = Driven::new(&["b", "a"].map(robot), Vec::new());
        driven.extend(&[first, second]);
        // The sensor is on the front of the body.
        let ahead = robot("a").body.length / 2.0 + 0.5;
        assert_eq!(driven.seen(1).len(), 1);
        let (x, y) = driven.seen(1)[0];
        assert!((x - 1.0 - ahead).abs() < 0.005 && y.abs() < 0.005, "({x}, {y})");
        assert!(driven.seen(0).is_empty());
    }
}
