//! A recorded run: a trace of ours, or a bag of ROS 2 from any recorder.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use pydslrep_bag::{MAGIC, Recording, RobotTopics};
use pydslrep_files::{open, read_start};
use pydslrep_trace::TraceRecord;

use crate::failure::Failure;
use crate::inputs::read::read_failure;

/// The first bytes of files that may be mistaken for a record, with the error and advice.
const OTHERS: [(&[u8], &str, &str); 2] = [
    (
        b"SQLite format 3\0",
        "is a bag in SQLite, which is not read",
        "`ros2 bag convert` makes an MCAP file of it",
    ),
    (b"\x28\xb5\x2f\xfd", "is compressed as a whole", "`zstd -d` decompresses it"),
];

/// A recorded run.
#[derive(Debug)]
pub(crate) struct Record {
    content: Content,
    /// True if it ends in the middle.
    pub(crate) is_truncated: bool,
}

#[derive(Debug)]
enum Content {
    Trace(Vec<TraceRecord>),
    Bag(Recording),
}

impl Record {
    /// Reads a record: a file, or the folder of a bag.
    ///
    /// # Errors
    /// If it cannot be read, or is none.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let files = if path.is_dir() { files_of_bag(path)? } else { vec![path.to_owned()] };
        let mut records = files.iter().map(|file| Self::read_file(file));
        let first = records.next().unwrap_or_else(|| Err(unknown(path)))?;
        records.try_fold(first, |all, next| Ok(all.followed_by(next?)))
    }

    fn read_file(path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let start = read_start(path, 64).map_err(|error| read_failure(&shown, &error))?;
        if let Some((_, what, help)) = OTHERS.iter().find(|(magic, ..)| start.starts_with(magic)) {
            return Err(Failure::new(format!("{shown} {what}")).help(*help));
        }
        let file = open(path).map_err(|error| read_failure(&shown, &error))?;
        if start.starts_with(MAGIC) { read_bag(&shown, file) } else { read_lines(path, file) }
    }

    /// A bag that consists of several files.
    fn followed_by(mut self, next: Self) -> Self {
        if let (Content::Bag(all), Content::Bag(next)) = (&mut self.content, next.content) {
            all.append(next);
        }
        Self { is_truncated: self.is_truncated || next.is_truncated, ..self }
    }

    /// The robots that it distinguishes: names, or topics.
    pub(crate) fn robots(&self) -> Vec<String> {
        let mut names: Vec<String> = match &self.content {
            Content::Trace(records) => records.iter().map(|record| record.robot.clone()).collect(),
            Content::Bag(recording) => recording.pose_topics().map(str::to_owned).collect(),
        };
        names.sort();
        names.dedup();
        names
    }

    /// The steps of the robots of a program, whose topics these are. Times begin with 0.
    ///
    /// A bag with the odometry of one robot is that of the only robot of a program, whatever its topic is called.
    pub(crate) fn steps(self, robots: &mut [RobotTopics]) -> Vec<TraceRecord> {
        let records = match self.content {
            Content::Trace(records) => {
                let is_known = |record: &TraceRecord| robots.iter().any(|robot| robot.robot == record.robot);
                records.into_iter().filter(is_known).collect()
            }
            Content::Bag(recording) => {
                let mut topics = recording.pose_topics();
                if let ([robot], Some(topic), None) = (&mut *robots, topics.next(), topics.next())
                    && !recording.has(robot)
                {
                    topic.clone_into(&mut robot.odometry);
                }
                recording.records(robots)
            }
        };
        from_zero(records)
    }

    /// The steps of all robots that it distinguishes, and their names.
    pub(crate) fn all_steps(self) -> (Vec<String>, Vec<TraceRecord>) {
        let names = self.robots();
        let mut topics: Vec<RobotTopics> = names.iter().map(|name| nameless(name)).collect();
        let steps = self.steps(&mut topics);
        (names, steps)
    }
}

/// A robot of which no more is known than its name or topic.
fn nameless(name: &str) -> RobotTopics {
    RobotTopics { robot: name.to_owned(), odometry: name.to_owned(), ..RobotTopics::default() }
}

/// A physical robot's clock shows the date.
fn from_zero(mut records: Vec<TraceRecord>) -> Vec<TraceRecord> {
    let start = records.iter().map(|record| record.t).fold(f64::INFINITY, f64::min);
    for record in &mut records {
        record.t -= start;
    }
    records
}

/// The files of a bag. Their order does not matter: messages have times.
fn files_of_bag(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(folder)
        .map_err(|error| Failure::new(format!("cannot read {}: {error}", folder.display())))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    // The first one that cannot be read is the same each time.
    files.sort();
    let mut bags: Vec<PathBuf> =
        files.iter().filter(|file| super::trace_file::is_bag(file)).cloned().collect();
    if bags.is_empty() {
        // A bag in SQLite: its first bytes say so.
        bags.extend(files.into_iter().find(|file| file.extension().is_some_and(|ending| ending == "db3")));
    }
    Ok(bags)
}

fn read_bag(shown: &str, file: File) -> Result<Record, Failure> {
    let size = file.metadata().map_or(u64::MAX, |data| data.len());
    let recording = pydslrep_bag::read(file, size)
        .map_err(|error| Failure::new(format!("cannot read {shown}: {error}")))?;
    if recording.pose_topics().next().is_none() {
        return Err(Failure::new(format!("{shown} does not say where a robot was")).help(
            "record a topic of type nav_msgs/msg/Odometry or geometry_msgs/msg/PoseWithCovarianceStamped, too",
        ));
    }
    Ok(Record { is_truncated: recording.truncated, content: Content::Bag(recording) })
}

fn read_lines(path: &Path, file: File) -> Result<Record, Failure> {
    let mut records = Vec::new();
    let mut is_truncated = false;
    let mut lines = BufReader::new(file).split(b'\n').enumerate().peekable();
    while let Some((number, line)) = lines.next() {
        let line = line.map_err(|error| Failure::new(format!("cannot read {}: {error}", path.display())))?;
        match serde_json::from_slice(&line) {
            Ok(record) => records.push(record),
            Err(_) if lines.peek().is_none() && !records.is_empty() => is_truncated = true,
            Err(_) if records.is_empty() => return Err(unknown(path)),
            Err(error) => {
                let place = format!("line {} of {}", number + 1, path.display());
                return Err(Failure::new(format!("{place} is not a step of a trace: {error}")));
            }
        }
    }
    if records.is_empty() {
        return Err(Failure::new(format!("{} is empty: nothing was recorded", path.display())));
    }
    Ok(Record { content: Content::Trace(records), is_truncated })
}

fn unknown(path: &Path) -> Failure {
    Failure::new(format!("{} is not a record of a run", path.display())).help(
        "a record is what `pydslrep run --trace FILE` writes, or an MCAP file or folder by `ros2 bag record -s mcap`",
    )
}
