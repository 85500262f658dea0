//! Bags are read as they were written, and nothing that is no bag is more than an error.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use pydslrep_bag::{BagWriter, RobotTopics, SensorTopic, Topic, read};
use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_trace::TraceRecord;

fn topics(robot: &str) -> RobotTopics {
    let sensor = |name: &str, range| SensorTopic {
        sensor: name.to_owned(),
        topic: format!("/{robot}/range/{name}"),
        range,
        cone: 0.2,
    };
    RobotTopics {
        robot: robot.to_owned(),
        odometry: format!("/{robot}/odom"),
        localised: Some(format!("/{robot}/amcl_pose")),
        plan: format!("/{robot}/plan"),
        odometry_frame: "odom".to_owned(),
        base_frame: "base_link".to_owned(),
        sensors: vec![sensor("front", Some(1.0)), sensor("skirt", None)],
    }
}

fn record(t: f64, robot: &str, x: f64) -> TraceRecord {
    TraceRecord {
        t,
        robot: robot.to_owned(),
        x,
        y: -0.5,
        theta: 3.0,
        wheels: Vec::new(),
        readings: BTreeMap::new(),
        movement: None,
        action: None,
    }
}

/// Two robots in turn; one of them has read its sensors.
fn records() -> Vec<TraceRecord> {
    let mut all: Vec<TraceRecord> = (0..100)
        .flat_map(|step| {
            let t = f64::from(step) * 0.05;
            [record(t, "rover", t / 10.0), record(t, "other", -t)]
        })
        .collect();
    all[20].readings.insert("front".to_owned(), Some(0.25));
    all[20].readings.insert("skirt".to_owned(), Some(0.0));
    all[40].readings.insert("front".to_owned(), None);
    all
}

fn bag(records: &[TraceRecord]) -> Vec<u8> {
    let mut bag = BagWriter::begin(Vec::new(), ["rover", "other"].map(topics).into()).unwrap();
    bag.plan("rover", vec![TimedPose { time: Some(0.0), pose: Pose::new(0.0, -0.5, 3.0) }]);
    for record in records {
        bag.add(record).unwrap();
    }
    bag.finish().unwrap()
}

#[test]
fn what_is_written_is_read() {
    let written = records();
    let bytes = bag(&written);
    let recording = read(bytes.as_slice(), bytes.len() as u64).unwrap();
    assert!(!recording.truncated);
    let found = recording.records(&["rover", "other"].map(topics));
    assert_eq!(found.len(), written.len());
    for (found, written) in found.iter().zip(&written) {
        let off =
            [found.t - written.t, found.x - written.x, found.y - written.y, found.theta - written.theta];
        assert!(off.iter().all(|off| off.abs() < 1e-9), "{found:?} is not {written:?}");
        assert_eq!((&found.robot, &found.readings), (&written.robot, &written.readings));
    }
}

#[test]
fn what_a_robot_has_localised_counts_more_than_its_odometry() {
    let bytes = bag(&records());
    let mut recording = read(bytes.as_slice(), bytes.len() as u64).unwrap();
    let there = TimedPose { time: Some(1.0), pose: Pose::new(9.0, 9.0, 0.0) };
    recording.topics.insert("/rover/amcl_pose".to_owned(), Topic::Localised(vec![there]));
    let found = recording.records(&[topics("rover")]);
    assert_eq!(found.iter().map(|record| record.x).collect::<Vec<_>>(), [9.0]);
}

#[test]
fn a_bag_whose_recorder_was_killed_is_read_up_to_there() {
    // More than one part is written at once.
    let many: Vec<TraceRecord> = (0..4000).map(|step| record(f64::from(step), "rover", 0.0)).collect();
    let bytes = bag(&many);
    let cut = &bytes[..bytes.len() * 2 / 3];
    let recording = read(cut, cut.len() as u64).unwrap();
    assert!(recording.truncated);
    let found = recording.records(&[topics("rover")]).len();
    assert!((1000..4000).contains(&found), "{found}");
}

#[test]
fn no_change_of_its_bytes_is_more_than_an_error() {
    let bytes = bag(&records()[20..21]);
    for place in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[place] ^= [0x01, 0x80, 0xff][place % 3];
        // Neither a panic nor memory without end.
        let _ = read(changed.as_slice(), changed.len() as u64);
    }
    for end in (0..bytes.len()).step_by(7) {
        let _ = read(&bytes[..end], end as u64);
    }
}

#[test]
fn what_is_no_bag_says_so() {
    for content in [&b""[..], b"{\"t\": 0}", b"\x89MCAP0\r\n"] {
        assert!(read(content, content.len() as u64).is_err(), "{content:?}");
    }
    let error = read(&b"neither this nor that"[..], 21).unwrap_err();
    assert_eq!(error.to_string(), "it is not an MCAP file");
}
