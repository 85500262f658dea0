//! Pictures of paths: planned against driven as SVG and PNG, and a replay that moves.
//!
//! Knows poses, bodies and obstacles. Must never know the language, how robots come to their poses, or files: it gets
//! routes handed in and returns what is to be written, the same each time.
//!
//! * [`Picture::svg`]: everything at once.
//! * [`Picture::replay`]: an SVG that drives.
//! * [`png`]: any of our SVGs as pixels.

mod floor;
mod legend;
mod paper;
mod raster;
mod replay;
mod robots;
mod route;
mod still;
#[cfg(test)]
mod testing;
mod ticks;
mod view;

pub use raster::{Unpaintable, png};
pub use route::{Picture, Route};
