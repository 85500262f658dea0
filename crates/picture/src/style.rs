//! Colours, text and number formats shared by all pictures.

use svg::node::element::{Line, Text};

/// The colour-blind safe palette of Okabe and Ito, without the colours that are too light on white.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#b0508f", "#c08a00", "#3b9bd6"];

pub(crate) const INK: &str = "#24292f";
pub(crate) const QUIET: &str = "#6e7781";
pub(crate) const GRID: &str = "#e4e8ec";
pub(crate) const AXIS: &str = "#c3cad1";
pub(crate) const PAPER: &str = "#ffffff";
pub(crate) const OBSTACLE: &str = "#d4dae1";
pub(crate) const OBSTACLE_EDGE: &str = "#8c959f";
pub(crate) const ALARM: &str = "#cf222e";
pub(crate) const FONT: &str = "'Helvetica Neue', Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// Dash and gap of planned paths, pixels.
pub(crate) const DASHES: &str = "6 4";

/// Dash and gap of what may be driven where plans end, pixels: shorter, to differ from planned paths.
pub(crate) const SHORT_DASHES: &str = "2 4";

/// Dash and gap of the paths of obstacles, pixels.
pub(crate) const FINE_DASHES: &str = "3 3";

pub(crate) fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// Rounds to two decimals, which is finer than any screen.
pub(crate) fn pixels(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A text shortened to `max_length` characters.
pub(crate) fn shorten(text: &str, max_length: usize) -> String {
    if text.chars().count() <= max_length {
        return text.to_owned();
    }
    let short: String = text.chars().take(max_length.saturating_sub(1)).collect();
    format!("{short}…")
}

/// A line of text; control characters, which XML cannot hold, are removed.
pub(crate) fn text(content: &str, x: f64, y: f64, size: u32) -> Text {
    let content: String = content.chars().filter(|c| !c.is_control()).collect();
    Text::new(content).set("x", pixels(x)).set("y", pixels(y)).set("font-size", size).set("fill", INK)
}

pub(crate) fn line((x1, y1): (f64, f64), (x2, y2): (f64, f64), colour: &str) -> Line {
    Line::new()
        .set("x1", pixels(x1))
        .set("y1", pixels(y1))
        .set("x2", pixels(x2))
        .set("y2", pixels(y2))
        .set("stroke", colour)
}

/// Points in the format of SVG.
pub(crate) fn list(points: &[(f64, f64)]) -> String {
    let points: Vec<String> = points.iter().map(|&(x, y)| format!("{},{}", pixels(x), pixels(y))).collect();
    points.join(" ")
}
