//! Pictures of planned and driven paths: SVG, animated SVG and PNG.
//!
//! Knows poses, bodies and obstacles. Must never know the language, how poses are computed, or files: routes in,
//! deterministic text or bytes out.
//!
//! * [`Picture::svg`]: a still picture.
//! * [`Picture::replay`]: an animated SVG.
//! * [`png`]: renders an SVG as PNG.

mod floor;
mod legend;
mod raster;
mod replay;
mod robots;
mod route;
mod still;
mod style;
#[cfg(test)]
mod testing;
mod time_marks;
mod view;

/// The mark of every picture, in a comment of an SVG and in the text of a PNG: programs recognise their pictures by it.
pub const MARK: &str = "Drawn by PyDSLRep";

pub use raster::{RenderError, png};
pub use route::{Picture, Route};
