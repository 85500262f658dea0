//! Reads bags, those of other programs too: what says where robots were, and what their sensors read.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::Read;

use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};
use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_trace::TraceRecord;

use crate::compression::decompress;
use crate::messages::{LOCALISED_POSE, LocalisedPose, ODOMETRY, Odometry, RANGE, Range, Stamp, decode};
use crate::{BagError, RobotTopics};

/// The robots' messages in a bag.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    /// By name.
    pub topics: BTreeMap<String, Topic>,
    /// True if it ends in the middle, as it does when its recorder was killed.
    pub truncated: bool,
}

/// The messages of a topic, in the order of their times.
#[derive(Debug, Clone, PartialEq)]
pub enum Topic {
    /// Odometry.
    Odometry(Vec<TimedPose>),
    /// The poses of a robot that localises itself.
    Localised(Vec<TimedPose>),
    /// A distance sensor.
    Readings(Vec<Reading>),
}

/// A reading of a sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Seconds.
    pub time: f64,
    /// Metres; `None` if it detected nothing.
    pub distance: Option<f64>,
}

impl Recording {
    /// The topics that say where robots were.
    pub fn pose_topics(&self) -> impl Iterator<Item = &str> {
        let poses = self.topics.iter().filter(|(_, topic)| !matches!(topic, Topic::Readings(_)));
        poses.map(|(name, _)| name.as_str())
    }

    /// Adds the messages of a bag that continues this one.
    pub fn append(&mut self, next: Self) {
        for (name, topic) in next.topics {
            match self.topics.entry(name) {
                Entry::Vacant(entry) => {
                    entry.insert(topic);
                }
                Entry::Occupied(mut entry) => entry.get_mut().append(topic),
            }
        }
        self.topics.values_mut().for_each(Topic::sort);
        self.truncated |= next.truncated;
    }

    /// Returns whether it has poses of a robot.
    pub fn has(&self, robot: &RobotTopics) -> bool {
        !self.poses(robot).is_empty()
    }

    /// The records of a trace, in the order of their times; wheels, movements and actions are not in a bag.
    pub fn records(&self, robots: &[RobotTopics]) -> Vec<TraceRecord> {
        let mut records: Vec<TraceRecord> = robots.iter().flat_map(|robot| self.records_of(robot)).collect();
        records.sort_by(|one, other| one.t.total_cmp(&other.t));
        records
    }

    fn records_of(&self, robot: &RobotTopics) -> Vec<TraceRecord> {
        let mut readings: Vec<(&str, Reading)> = Vec::new();
        for sensor in &robot.sensors {
            if let Some(Topic::Readings(read)) = self.topics.get(&sensor.topic) {
                readings.extend(read.iter().map(|reading| (sensor.sensor.as_str(), *reading)));
            }
        }
        readings.sort_by(|(_, one), (_, other)| one.time.total_cmp(&other.time));
        let mut unread = readings.into_iter().peekable();
        let record = |timed: &TimedPose| {
            let t = timed.time.unwrap_or_default();
            // A record has what was read since the one before.
            let mut readings = BTreeMap::new();
            while let Some((sensor, reading)) = unread.next_if(|(_, reading)| reading.time < t) {
                readings.insert(sensor.to_owned(), reading.distance);
            }
            let Pose { x, y, theta } = timed.pose;
            let (robot, wheels) = (robot.robot.clone(), Vec::new());
            TraceRecord { t, robot, x, y, theta, wheels, readings, movement: None, action: None }
        };
        self.poses(robot).iter().map(record).collect()
    }

    /// Where a robot was: as it localised itself, or else by its odometry.
    fn poses(&self, robot: &RobotTopics) -> &[TimedPose] {
        let names = robot.localised.iter().chain([&robot.odometry]);
        let mut found = names.filter_map(|name| match self.topics.get(name)? {
            Topic::Odometry(poses) | Topic::Localised(poses) => Some(poses.as_slice()),
            Topic::Readings(_) => None,
        });
        found.find(|poses| !poses.is_empty()).unwrap_or_default()
    }
}

/// Reads a bag of at most `size` bytes.
///
/// # Errors
/// If it cannot be read, or is not a bag. Of a truncated bag, everything before the end is read.
pub fn read(mut input: impl Read, size: u64) -> Result<Recording, BagError> {
    // No record can be longer than its file, and nothing may ask for more memory than that.
    let limit = usize::try_from(size).unwrap_or(usize::MAX);
    let options = LinearReaderOptions::default().with_emit_chunks(true).with_record_length_limit(limit);
    let mut reader = LinearReader::new_with_options(options);
    let mut content = Content::default();
    let mut truncated = false;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = input.read(reader.insert(wanted.min(limit)))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => content.add(&parse_record(opcode, data)?)?,
            Err(McapError::UnexpectedEof | McapError::RecordTooLarge { .. }) if content.has_begun => {
                truncated = true;
                break;
            }
            Err(error) => return Err(error.into()),
        }
    }
    Ok(content.recording(truncated))
}

/// The content of a bag as it is read.
#[derive(Default)]
struct Content {
    /// The types of messages, by number.
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    has_begun: bool,
}

struct Channel {
    name: String,
    topic: Topic,
}

impl Content {
    fn add(&mut self, record: &Record<'_>) -> Result<(), BagError> {
        self.has_begun = true;
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name.clone());
            }
            Record::Channel(channel) if channel.message_encoding == "cdr" => {
                let kind = self.schemas.get(&channel.schema_id).map(String::as_str);
                if let Some(topic) = kind.and_then(empty_topic) {
                    let name = channel.topic.clone();
                    self.channels.entry(channel.id).or_insert(Channel { name, topic });
                }
            }
            Record::Message { header, data } => {
                if let Some(channel) = self.channels.get_mut(&header.channel_id) {
                    channel.add(header.log_time, data)?;
                }
            }
            Record::Chunk { header, data } => self.add_all(&decompress(header, data)?)?,
            _ => {}
        }
        Ok(())
    }

    /// Adds the records of a chunk.
    fn add_all(&mut self, records: &[u8]) -> Result<(), BagError> {
        for record in mcap::read::LinearReader::sans_magic(records) {
            let record = record?;
            if !matches!(record, Record::Chunk { .. }) {
                self.add(&record)?;
            }
        }
        Ok(())
    }

    fn recording(self, truncated: bool) -> Recording {
        let mut recording = Recording { truncated, ..Recording::default() };
        // A topic has a channel for each of its publishers.
        for channel in self.channels.into_values() {
            let topics = BTreeMap::from([(channel.name, channel.topic)]);
            recording.append(Recording { topics, truncated });
        }
        recording
    }
}

fn empty_topic(kind: &str) -> Option<Topic> {
    match kind {
        _ if kind == ODOMETRY.name => Some(Topic::Odometry(Vec::new())),
        _ if kind == RANGE.name => Some(Topic::Readings(Vec::new())),
        LOCALISED_POSE => Some(Topic::Localised(Vec::new())),
        _ => None,
    }
}

impl Channel {
    fn add(&mut self, log_time: u64, data: &[u8]) -> Result<(), BagError> {
        match &mut self.topic {
            Topic::Odometry(poses) => {
                let message: Odometry = decode(data)?;
                poses.extend(timed(message.header.stamp, log_time, message.pose.pose.pose()));
            }
            Topic::Localised(poses) => {
                let message: LocalisedPose = decode(data)?;
                poses.extend(timed(message.header.stamp, log_time, message.pose.pose.pose()));
            }
            Topic::Readings(readings) => {
                let message: Range = decode(data)?;
                let time = seconds(message.header.stamp, log_time);
                readings.push(Reading { time, distance: message.distance() });
            }
        }
        Ok(())
    }
}

impl Topic {
    fn append(&mut self, other: Self) {
        match (self, other) {
            (Self::Odometry(poses), Self::Odometry(others))
            | (Self::Localised(poses), Self::Localised(others)) => poses.extend(others),
            (Self::Readings(readings), Self::Readings(others)) => readings.extend(others),
            // Two types cannot have one topic; the first is kept.
            _ => {}
        }
    }

    fn sort(&mut self) {
        let time = |timed: &TimedPose| timed.time.unwrap_or_default();
        match self {
            Self::Odometry(poses) | Self::Localised(poses) => {
                poses.sort_by(|one, other| time(one).total_cmp(&time(other)));
            }
            Self::Readings(readings) => readings.sort_by(|one, other| one.time.total_cmp(&other.time)),
        }
    }
}

/// The time of a message: when it was recorded, if its publisher did not say when it was made.
fn seconds(stamp: Stamp, log_time: u64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a fraction of a microsecond")]
    stamp.seconds().unwrap_or(log_time as f64 * 1e-9)
}

/// A pose with its time, if it is one.
fn timed(stamp: Stamp, log_time: u64, pose: Pose) -> Option<TimedPose> {
    let is_one = pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite();
    is_one.then(|| TimedPose { time: Some(seconds(stamp, log_time)), pose })
}
