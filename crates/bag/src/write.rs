//! Writes bags.

use std::collections::BTreeMap;
use std::io::Write;

use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};
use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_trace::TraceRecord;
use serde::Serialize;

use crate::messages::{
    Header, MessageType, ODOMETRY, Odometry, PATH, PathMessage, PoseStamped, RANGE, Range, Stamp, Twist,
    Vector, encode,
};
use crate::{BagError, LIBRARY};

/// The names of a robot's topics and frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RobotTopics {
    /// The robot's name in traces.
    pub robot: String,
    /// Of its odometry.
    pub odometry: String,
    /// Of its poses, if it localises itself. Only read: what is written are poses of a trace.
    pub localised: Option<String>,
    /// Of its planned path.
    pub plan: String,
    /// The frame of its odometry and its plan.
    pub odometry_frame: String,
    /// The frame of the robot.
    pub base_frame: String,
    /// Of its sensors.
    pub sensors: Vec<SensorTopic>,
}

/// A sensor with the name of its topic.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorTopic {
    /// The sensor's name in traces.
    pub sensor: String,
    /// Of its readings.
    pub topic: String,
    /// The range of the sensor, metres; `None` for a bumper, which measures no distance.
    pub range: Option<f64>,
    /// The angle of its cone, radians.
    pub cone: f64,
}

/// A bag that is being written.
pub struct BagWriter<W: Write> {
    writer: Writer<NoSeek<W>>,
    robots: Vec<RobotChannels>,
}

/// The channels of a robot; they exist once they have a message.
struct RobotChannels {
    topics: RobotTopics,
    /// Planned poses that are not written yet.
    plan: Vec<TimedPose>,
    last: Option<TimedPose>,
}

impl<W: Write> BagWriter<W> {
    /// Begins a bag about robots.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn begin(output: W, robots: Vec<RobotTopics>) -> Result<Self, BagError> {
        let library = format!("{LIBRARY} {}", env!("CARGO_PKG_VERSION"));
        let options = WriteOptions::new().profile("ros2").library(library).disable_seeking(true);
        let robots =
            robots.into_iter().map(|topics| RobotChannels { topics, plan: Vec::new(), last: None }).collect();
        Ok(Self { writer: options.create(NoSeek::new(output))?, robots })
    }

    /// Has the planned path of a robot written in front of its first record.
    pub fn plan(&mut self, robot: &str, poses: Vec<TimedPose>) {
        if let Some(channels) = self.robots.iter_mut().find(|channels| channels.topics.robot == robot) {
            channels.plan = poses;
        }
    }

    /// Adds a record; that of a robot without topics is left out.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, record: &TraceRecord) -> Result<(), BagError> {
        let Some(channels) = self.robots.iter_mut().find(|channels| channels.topics.robot == record.robot)
        else {
            return Ok(());
        };
        let time = nanoseconds(record.t);
        let plan = std::mem::take(&mut channels.plan);
        let now = record.timed_pose();
        let before = channels.last.replace(now);
        // No time has passed since its record before when its sensors were read.
        let read = before.and_then(|before| before.time).map_or(time, nanoseconds);
        let topics = &channels.topics;
        if !plan.is_empty() {
            publish(&mut self.writer, &PATH, &topics.plan, time, &path(topics, &plan))?;
        }
        publish(&mut self.writer, &ODOMETRY, &topics.odometry, time, &odometry(topics, before, now))?;
        for sensor in &topics.sensors {
            if let Some(reading) = record.readings.get(&sensor.sensor) {
                publish(&mut self.writer, &RANGE, &sensor.topic, read, &range(sensor, *reading, read))?;
            }
        }
        Ok(())
    }

    /// Ends the bag, and returns what it was written to.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self) -> Result<W, BagError> {
        self.writer.finish()?;
        Ok(self.writer.into_inner().into_inner())
    }
}

/// Nothing happens before the beginning of time.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "such casts saturate")]
fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}

fn publish<W: Write>(
    writer: &mut Writer<NoSeek<W>>,
    kind: &MessageType,
    topic: &str,
    time: u64,
    message: &impl Serialize,
) -> Result<(), BagError> {
    // Both return what they have added before, if it is the same.
    let schema = writer.add_schema(kind.name, "ros2msg", kind.definition().as_bytes())?;
    let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
    let channel_id = writer.add_channel(schema, topic, "cdr", &metadata)?;
    let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
    Ok(writer.write_to_known_channel(&header, &encode(message)?)?)
}

fn odometry(topics: &RobotTopics, before: Option<TimedPose>, now: TimedPose) -> Odometry {
    let (time, pose) = (now.time.unwrap_or_default(), now.pose);
    Odometry {
        header: header(&topics.odometry_frame, nanoseconds(time)),
        child_frame_id: topics.base_frame.clone(),
        pose: pose.into(),
        twist: before.map(|before| twist(before, now)).unwrap_or_default().into(),
    }
}

/// The mean twist between two poses, in the frame of the robot, as `nav_msgs/Odometry` wants it.
fn twist(before: TimedPose, now: TimedPose) -> Twist {
    let elapsed = now.time.unwrap_or_default() - before.time.unwrap_or_default();
    if elapsed <= 0.0 {
        return Twist::default();
    }
    let Pose { x, y, theta } = before.pose.relative(&now.pose);
    Twist {
        linear: Vector { x: x / elapsed, y: y / elapsed, z: 0.0 },
        angular: Vector { x: 0.0, y: 0.0, z: theta / elapsed },
    }
}

fn path(topics: &RobotTopics, plan: &[TimedPose]) -> PathMessage {
    let pose = |timed: &TimedPose| PoseStamped {
        header: header(&topics.odometry_frame, nanoseconds(timed.time.unwrap_or_default())),
        pose: timed.pose.into(),
    };
    PathMessage { header: header(&topics.odometry_frame, 0), poses: plan.iter().map(pose).collect() }
}

#[expect(clippy::cast_possible_truncation, reason = "the message has single precision")]
fn range(sensor: &SensorTopic, reading: Option<f64>, time: u64) -> Range {
    let is_bumper = sensor.range.is_none();
    // A sensor that only reports whether something is there has a range of one distance: REP 117.
    let max_range = sensor.range.unwrap_or_default();
    let range = match reading {
        None => f64::INFINITY,
        Some(_) if is_bumper => f64::NEG_INFINITY,
        Some(distance) => distance,
    };
    Range {
        header: header(&sensor.sensor, time),
        radiation_type: 0,
        field_of_view: sensor.cone as f32,
        min_range: 0.0,
        max_range: max_range as f32,
        range: range as f32,
        variance: 0.0,
    }
}

fn header(frame: &str, time: u64) -> Header {
    Header { stamp: Stamp::of(time), frame_id: frame.to_owned() }
}
