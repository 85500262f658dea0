//! Text of any kind: ranges of bytes, lines and columns, words that are close to each other, the names of a project's
//! files.
//!
//! Knows strings and ropes. Must never know the language, I/O, or the protocol of editors.

pub mod file_names;
mod position;
mod span;
mod spelling;

pub use position::LineColumn;
pub use span::{Span, offset};
pub use spelling::{closest, closest_of_any_order, is_similar};
