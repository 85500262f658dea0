//! Runs as bags of ROS 2: MCAP files with the messages that a robot's driver publishes.
//!
//! Knows poses and traces. Must never know the language, scenes or files: callers open them.
//!
//! * [`BagWriter`]: writes the records of a trace, and planned paths.
//! * [`read`]: the poses and the readings in a bag of any recorder.

mod compression;
mod error;
mod messages;
mod read;
mod write;

pub use error::BagError;
pub use read::{Reading, Recording, Topic, read};
pub use write::{BagWriter, RobotTopics, SensorTopic};

/// The first bytes of MCAP files.
pub const MAGIC: &[u8] = mcap::MAGIC;

/// The mark of this program's bags, near their beginning.
pub const LIBRARY: &str = "PyDSLRep";
