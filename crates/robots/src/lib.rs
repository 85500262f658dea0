//! The types of robots: one table of their differences, for all that reads, plans, simulates or drives them.
//!
//! Knows constants only, and depends on nothing. Must never know how robots move, how programs are read, files or clocks.
//! Units: metres; x forward, y left.
//!
//! A row says where the wheels are and which way their rollers push; models, traction and scripts follow from that. Who asks
//! for a property of a type asks its row, and does not compare types.

mod drive;
mod robot_type;

pub use robot_type::{Drive, MAX_WHEELS, RobotType, WheelPlace};
