//! The paths that robots drove, with as many poses as a picture needs.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use pydslrep_simulator::Sightings;
use pydslrep_trace::{Map, TraceRecord, Track};

/// Poses nearer than this to the last one kept are dropped: metres and radians.
const FINENESS: f64 = 0.002;

/// The path of each robot, in the order of the environment.
#[derive(Debug)]
pub(crate) struct Driven {
    robots: Vec<String>,
    tracks: Vec<Track>,
    /// Simulation time of the last record, seconds.
    pub(crate) time: f64,
    /// What sensors saw in the embedded simulator.
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
    pub(crate) fn new<'a>(robots: impl Iterator<Item = &'a str>, simulated: Vec<usize>) -> Self {
        let robots: Vec<String> = robots.map(str::to_owned).collect();
        let tracks = vec![Track::new(FINENESS); robots.len()];
        Self { robots, tracks, time: 0.0, sightings: Sightings::default(), simulated, maps: Vec::new() }
    }

    /// Adds what the simulator recorded.
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
        for line in BufReader::new(File::open(file)?).lines() {
            let record: TraceRecord = serde_json::from_str(&line?)?;
            if !self.simulated.iter().any(|index| self.robots[*index] == record.robot) {
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
        in_scene.map(|index| self.sightings.of(index)).unwrap_or_default()
    }

    fn add(&mut self, record: &TraceRecord) {
        self.time = self.time.max(record.t);
        let of_robot = self.robots.iter().zip(&mut self.tracks).find(|(robot, _)| **robot == record.robot);
        if let Some((_, track)) = of_robot {
            track.add(record.timed_pose());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_robots_are_ignored() {
        let mut driven = Driven::new(["a", "b"].into_iter(), vec![0, 1]);
        let record = |t, robot: &str| TraceRecord {
            t,
            robot: robot.to_owned(),
            x: 1.0,
            y: 0.0,
            theta: 0.0,
            wheels: vec![],
            movement: None,
            action: None,
        };
        driven.extend(&[record(0.1, "a"), record(0.2, "stranger")]);
        let ends: Vec<bool> = driven.tracks().iter().map(|track| track.end().is_some()).collect();
        assert_eq!((ends, driven.time), (vec![true, false], 0.2));
    }
}
