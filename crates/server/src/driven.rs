//! The paths that robots drove in a run, read from its trace and its map.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use pydslrep_kinematics::TimedPose;
use pydslrep_trace::{Map, MapFile, TraceRecord, Track};
use serde::Serialize;

/// Poses closer than this, in metres and radians, are dropped: a picture shows far less.
const FINENESS: f64 = 0.005;

/// The driven path of a robot, as the protocol has it.
#[derive(Debug, Serialize)]
pub(crate) struct DrivenRobot {
    name: String,
    poses: Vec<Pose>,
    map: Map,
}

#[derive(Debug, PartialEq, Serialize)]
struct Pose {
    t: f64,
    x: f64,
    y: f64,
    theta: f64,
}

/// Returns the driven paths of a run, in the order in which the robots first appear in the trace. A missing map is
/// empty.
///
/// # Errors
/// When there is no trace.
pub(crate) fn read(trace: &Path, map: &Path) -> io::Result<Vec<DrivenRobot>> {
    let mut tracks: Vec<(String, Track)> = Vec::new();
    for line in BufReader::new(File::open(trace)?).lines() {
        // A run that was interrupted may have written half a line.
        let Ok(record) = serde_json::from_str::<TraceRecord>(&line?) else { continue };
        let index = tracks.iter().position(|(robot, _)| *robot == record.robot).unwrap_or_else(|| {
            tracks.push((record.robot.clone(), Track::new(FINENESS)));
            tracks.len() - 1
        });
        tracks[index].1.add(record.timed_pose());
    }
    let found = File::open(map).ok().and_then(|map| serde_json::from_reader(BufReader::new(map)).ok());
    let found: MapFile = found.unwrap_or_default();
    let whole = |(name, track): (String, Track)| {
        let poses = track.poses().iter().filter_map(Pose::of).collect();
        DrivenRobot { map: found.of(&name), poses, name }
    };
    Ok(tracks.into_iter().map(whole).collect())
}

impl Pose {
    fn of(TimedPose { time, pose }: &TimedPose) -> Option<Self> {
        Some(Self { t: (*time)?, x: pose.x, y: pose.y, theta: pose.theta })
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use expect_test::expect_file;

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

    /// `tsc` holds the types of the preview against this value.
    #[test]
    fn clients_know_the_shape() {
        let folder = tempfile::tempdir().unwrap();
        let (trace, map) = (folder.path().join("t.jsonl"), folder.path().join("m.json"));
        fs::write(&trace, line("a", 0.0, 1.0)).unwrap();
        fs::write(
            &map,
            r#"{"nodes": [{"robot": "a", "x": 0, "y": 1}, {"robot": "a", "x": 2, "y": 3}], "edges": [{"from": 0, "to": 1}]}"#,
        )
        .unwrap();
        let robots = serde_json::to_string_pretty(&read(&trace, &map).unwrap()).unwrap();
        expect_file!["../../../editors/preview/tests/driven_path.sample.ts"].assert_eq(&format!(
            "// Written by a test of crates/server/src/driven.rs.\n\
             import type {{ DrivenRobot }} from \"../host/protocol\";\n\n\
             export const robots: DrivenRobot[] = {robots};\n"
        ));
    }
}
