//! The records of a run: its events, traces of its robots, and maps made while exploring.
//!
//! Knows poses. Must never know the language, how robots drive or are drawn, or files: callers read and deserialize them.
//!
//! * [`TraceRecord`]: a line of a trace, written by the simulator and by scripts.
//! * [`Track`]: the path of one robot, simplified while it is recorded.
//! * [`RunEvent`]: what happened, written by scripts and by `pydslrep run`, which reads those of its script.
//! * [`MapFile`] and [`Map`]: the maps of a run and of one robot.

mod event;
mod map;
mod record;
mod track;

pub use event::{Call, FailureClass, FileKind, Moment, RunEvent, RunFailure};
pub use map::{Map, MapFile};
pub use record::{TraceRecord, lines};
pub use track::Track;
