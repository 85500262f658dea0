//! What a run leaves: the traces of its robots, and the maps of those that explored.
//!
//! Knows poses. Must never know the language, how robots drive or are drawn, or files: whoever opened one hands in what
//! `serde` made of it.
//!
//! * [`TraceRecord`]: a line of a trace, written by the simulator and by scripts.
//! * [`Track`]: the path of one robot, thinned out as it comes in.
//! * [`MapFile`] and [`Map`]: what robots found.

mod map;
mod trace;
mod track;

pub use map::{Map, MapFile};
pub use trace::TraceRecord;
pub use track::Track;
