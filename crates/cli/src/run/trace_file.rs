//! The file of `--trace`: JSON lines, or a bag of ROS 2 if the name of the file ends in `.mcap`.

use std::path::{Path, PathBuf};

use pydslrep_bag::{BagError, BagWriter, RobotTopics, SensorTopic};
use pydslrep_output::{GrowingFile, Kind};
use pydslrep_scene::{Robot, Sensor, SensorKind};
use pydslrep_trace::{TraceRecord, lines};

use crate::failure::Failure;
use crate::run::planned::PlannedEnvironment;

/// The name of planned paths among the topics of a robot, as Nav2 has it.
const PLAN: &str = "plan";

/// Returns whether a trace of this name is a bag.
pub(crate) fn is_bag(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap"))
}

/// Returns the kind of a trace of this name.
pub(crate) fn kind(path: &Path) -> Kind {
    if is_bag(path) { Kind::Bag } else { Kind::Trace }
}

/// A trace that is being written.
pub(crate) struct TraceFile {
    path: PathBuf,
    content: Content,
}

enum Content {
    Lines(GrowingFile),
    Bag(Box<BagWriter<GrowingFile>>),
}

impl TraceFile {
    /// Begins a trace of robots.
    ///
    /// # Errors
    /// If it may not be written, or another process is writing it.
    pub(crate) fn begin(path: &Path, robots: &[Robot]) -> Result<Self, Failure> {
        let file = GrowingFile::begin(path, kind(path))?;
        let content = if is_bag(path) {
            let bag = BagWriter::begin(file, robots.iter().map(topics).collect());
            Content::Bag(Box::new(bag.map_err(|error| Failure::unwritten(path, &error))?))
        } else {
            Content::Lines(file)
        };
        Ok(Self { path: path.to_owned(), content })
    }

    /// Has planned paths written in front of the records of their robots, where the trace can have them.
    pub(crate) fn plan(&mut self, planned: &PlannedEnvironment) {
        if let Content::Bag(bag) = &mut self.content {
            for route in planned.routes() {
                bag.plan(&route.name, route.planned);
            }
        }
    }

    /// Adds records.
    ///
    /// # Errors
    /// If they cannot be written.
    pub(crate) fn add(&mut self, records: &[TraceRecord]) -> Result<(), Failure> {
        match &mut self.content {
            Content::Lines(file) => Ok(file.add(&lines(records))?),
            Content::Bag(bag) => {
                let added = records.iter().try_for_each(|record| bag.add(record));
                added.map_err(|error| Failure::unwritten(&self.path, &error))
            }
        }
    }

    /// Gives the trace its name.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let unwritten = |error: BagError| Failure::unwritten(&self.path, &error);
        match self.content {
            Content::Lines(file) => Ok(file.finish()?),
            Content::Bag(bag) => Ok(bag.finish().map_err(unwritten)?.finish()?),
        }
    }
}

/// Returns the names of a robot's topics in a bag: those that its driver uses.
pub(crate) fn topics(robot: &Robot) -> RobotTopics {
    let names = robot.topics();
    let sensor = |sensor: &Sensor| SensorTopic {
        sensor: sensor.name.clone(),
        topic: names.range(&sensor.name),
        range: (sensor.kind == SensorKind::Distance).then_some(sensor.mount.range),
        cone: sensor.mount.cone,
    };
    RobotTopics {
        robot: robot.name.clone(),
        sensors: robot.sensors.iter().map(sensor).collect(),
        plan: names.absolute(PLAN),
        odometry: names.odometry,
        localised: names.pose,
        odometry_frame: names.odometry_frame,
        base_frame: names.base_frame,
    }
}
