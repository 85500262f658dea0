//! What robots did in a run, out of the files that the run left: its trace and its map.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use serde::{Deserialize, Serialize};

/// Between poses that are kept a robot moves less than this, metres and radians: far less than a picture shows.
const FINENESS: f64 = 0.005;

/// What a robot did, as the protocol has it.
#[derive(Debug, Serialize)]
pub(crate) struct DrivenRobot {
    name: String,
    poses: Vec<Pose>,
    map: Map,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct Pose {
    t: f64,
    x: f64,
    y: f64,
    theta: f64,
}

/// What a robot found on exploring, metres.
#[derive(Debug, Default, PartialEq, Serialize)]
struct Map {
    nodes: Vec<(f64, f64)>,
    edges: Vec<((f64, f64), (f64, f64))>,
}

/// A line of a trace, as far as it matters here.
#[derive(Deserialize)]
struct Line {
    robot: String,
    t: f64,
    x: f64,
    y: f64,
    theta: f64,
}

/// A map, as far as it matters here.
#[derive(Default, Deserialize)]
struct MapFile {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
}

#[derive(Deserialize)]
struct Node {
    robot: String,
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
struct Edge {
    from: usize,
    to: usize,
}

/// What the robots of a run did, in the order in which the trace names them first. A map that is not there is empty.
///
/// # Errors
/// When there is no trace.
pub(crate) fn read(trace: &Path, map: &Path) -> io::Result<Vec<DrivenRobot>> {
    let mut robots: Vec<Track> = Vec::new();
    for line in BufReader::new(File::open(trace)?).lines() {
        // A run that was cut off may have left half a line.
        let Ok(line) = serde_json::from_str::<Line>(&line?) else { continue };
        let Line { robot, t, x, y, theta } = line;
        let index = robots.iter().position(|track| track.name == robot).unwrap_or_else(|| {
            robots.push(Track { name: robot, kept: Vec::new(), last: None });
            robots.len() - 1
        });
        robots[index].add(Pose { t, x, y, theta });
    }
    let found = File::open(map).ok().and_then(|map| serde_json::from_reader(BufReader::new(map)).ok());
    let found: MapFile = found.unwrap_or_default();
    let whole = |track: Track| {
        let map = found.of(&track.name);
        DrivenRobot { name: track.name.clone(), poses: track.poses(), map }
    };
    Ok(robots.into_iter().map(whole).collect())
}

/// The path of a robot, thinned out on its way in.
struct Track {
    name: String,
    kept: Vec<Pose>,
    last: Option<Pose>,
}

impl Track {
    fn add(&mut self, pose: Pose) {
        let is_near = |kept: &Pose| {
            (pose.x - kept.x).hypot(pose.y - kept.y) < FINENESS && (pose.theta - kept.theta).abs() < FINENESS
        };
        if !self.kept.last().is_some_and(is_near) {
            // After a rest the end of it is kept too, or the robot would seem to creep all that time.
            let rested = self
                .last
                .filter(|last| self.kept.last().is_some_and(|kept| kept != last && is_rest(kept, last)));
            self.kept.extend(rested);
            self.kept.push(pose);
        }
        self.last = Some(pose);
    }

    fn poses(mut self) -> Vec<Pose> {
        let end = self.last.filter(|last| self.kept.last() != Some(last));
        self.kept.extend(end);
        self.kept
    }
}

/// Whether more time went by than a robot in motion needs to leave a pose: half a second.
fn is_rest(from: &Pose, to: &Pose) -> bool {
    to.t - from.t > 0.5
}

impl MapFile {
    fn of(&self, robot: &str) -> Map {
        let place = |index: usize| {
            self.nodes.get(index).filter(|node| node.robot == robot).map(|node| (node.x, node.y))
        };
        Map {
            nodes: (0..self.nodes.len()).filter_map(place).collect(),
            edges: self.edges.iter().filter_map(|edge| Some((place(edge.from)?, place(edge.to)?))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn line(robot: &str, t: f64, x: f64) -> String {
        format!("{{\"robot\":\"{robot}\",\"t\":{t},\"x\":{x},\"y\":0,\"theta\":0,\"wheels\":[]}}\n")
    }

    #[test]
    fn a_trace_is_thinned_and_keeps_rests_and_ends() {
        let folder = tempfile::tempdir().unwrap();
        let (trace, map) = (folder.path().join("t.jsonl"), folder.path().join("m.json"));
        let mut text = String::new();
        for step in 0..40_u32 {
            // Moves, stands for a second, moves on.
            let x = 0.01 * f64::from(step.min(10) + step.saturating_sub(30));
            text += &line("b", 0.05 * f64::from(step), x);
        }
        text += &line("a", 0.0, 1.0);
        fs::write(&trace, format!("{text}{{\"robot\": \"a\", \"t\"")).unwrap();
        fs::write(
            &map,
            r#"{"nodes": [{"robot": "b", "x": 0, "y": 1}, {"robot": "b", "x": 2, "y": 3}, {"robot": "a", "x": 4, "y": 5}],
                "edges": [{"from": 0, "to": 1}, {"from": 1, "to": 2}, {"from": 1, "to": 9}]}"#,
        )
        .unwrap();
        let robots = read(&trace, &map).unwrap();
        assert_eq!(robots.iter().map(|robot| robot.name.as_str()).collect::<Vec<_>>(), ["b", "a"]);
        let b = &robots[0];
        assert_eq!(b.poses.len(), 11 + 1 + 9, "{:?}", b.poses);
        assert!(
            (b.poses[11].t - 1.5).abs() < 1e-9 && (b.poses[11].x - 0.1).abs() < 1e-9,
            "{:?}",
            b.poses[11]
        );
        assert_eq!(b.map, Map { nodes: vec![(0.0, 1.0), (2.0, 3.0)], edges: vec![((0.0, 1.0), (2.0, 3.0))] });
        assert_eq!(robots[1].map.nodes, [(4.0, 5.0)]);
        assert_eq!(robots[1].poses.len(), 1);
    }
}
