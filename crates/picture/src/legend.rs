//! The legend: each robot with its end pose and deviation, and the meaning of lines and marks.

use pydslrep_kinematics::{Pose, TimedPose, angle_between, heading_degrees};
use svg::node::element::{Circle, Group, Line, Rectangle};

use crate::floor::cross;
use crate::robots::{DRIVEN_OPACITY, DRIVEN_WIDTH, END_FILL, MAP_WIDTH, PLANNED_WIDTH, SIGHTING, map_node};
use crate::route::{Picture, Route, is_drawable};
use crate::style::{
    DASHES, FINE_DASHES, INK, OBSTACLE, OBSTACLE_EDGE, QUIET, SHORT_DASHES, colour, line, pixels, shorten,
    text,
};
use crate::time_marks::arrowhead;

/// Pixels.
pub(crate) const WIDTH: f64 = 252.0;

const KEY_LINE: f64 = 22.0;
const ENTRY_HEIGHT: f64 = 66.0;
const MAX_NAME: usize = 24;

/// The kind of picture that the legend explains.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Key {
    /// A still picture: bodies at start and end, and time marks at this interval in seconds, if any.
    Still(Option<f64>),
    /// An animation.
    Moving,
}

/// The maximum height of the legend, pixels.
pub(crate) fn height(picture: &Picture<'_>) -> f64 {
    #[allow(clippy::cast_precision_loss)] // a few robots
    let entries = picture.routes.len() as f64 * ENTRY_HEIGHT;
    #[allow(clippy::cast_precision_loss)] // a few lines
    let key = samples(picture, Key::Still(Some(1.0))).len() as f64 * KEY_LINE;
    entries + key
}

/// Draws the legend.
pub(crate) fn draw(picture: &Picture<'_>, key: Key, (left, top): (f64, f64)) -> Group {
    let mut group = Group::new();
    let mut y = top;
    for (index, route) in picture.routes.iter().enumerate() {
        group = group.add(entry(route, colour(index), left, y));
        y += ENTRY_HEIGHT;
    }
    y += 12.0;
    for (meaning, sample) in samples(picture, key) {
        let place = format!("translate({} {})", pixels(left), pixels(y));
        group = group.add(Group::new().set("transform", place).add(sample));
        group = group.add(text(&meaning, left + 46.0, y + 4.0, 12));
        y += KEY_LINE;
    }
    group
}

fn entry(route: &Route, colour: &str, left: f64, top: f64) -> Group {
    let swatch = Rectangle::new()
        .set("x", pixels(left))
        .set("y", pixels(top + 2.0))
        .set("width", 12)
        .set("height", 12)
        .set("rx", 3)
        .set("fill", colour);
    let name = text(&shorten(&route.name, MAX_NAME), left + 20.0, top + 13.0, 14).set("font-weight", "bold");
    let first = text(&end_text(route), left + 20.0, top + 31.0, 12).set("fill", QUIET);
    let second = text(&error_text(route), left + 20.0, top + 47.0, 12);
    Group::new().add(swatch).add(name).add(first).add(second)
}

/// Samples with their meaning, for everything that is in the picture.
fn samples(picture: &Picture<'_>, key: Key) -> Vec<(String, Group)> {
    let routes = picture.routes;
    let any = |what: fn(&Route) -> bool| routes.iter().any(what);
    let mut samples: Vec<(String, Group)> = Vec::new();
    let mut add = |meaning: &str, sample: Group| samples.push((meaning.to_owned(), sample));
    if any(|route| !route.planned.is_empty()) {
        add("planned", Group::new().add(dashed(DASHES)));
    }
    if any(|route| route.open_ways().next().is_some()) {
        add("possible, sensors decide", Group::new().add(dashed(SHORT_DASHES)));
    }
    if any(|route| !route.driven.is_empty()) {
        add("driven", Group::new().add(stroke(DRIVEN_WIDTH).set("stroke-opacity", DRIVEN_OPACITY)));
    }
    if let Key::Still(Some(step)) = key {
        add(&format!("heading, every {step} s"), Group::new().add(arrowhead((18.0, 0.0), 0.0, QUIET)));
    }
    if matches!(key, Key::Still(_)) && !routes.is_empty() {
        add("at the start", Group::new().add(outline(0.0, 1.2)));
        add("at the end", Group::new().add(outline(END_FILL, 2.0)));
    }
    if !picture.obstacles.is_empty() {
        let obstacle = outline(1.0, 1.0).set("fill", OBSTACLE).set("stroke", OBSTACLE_EDGE);
        add("obstacle", Group::new().add(obstacle));
    }
    if picture.movers().next().is_some() {
        let path = stroke(1.0).set("stroke", OBSTACLE_EDGE).set("stroke-dasharray", FINE_DASHES);
        add("path of an obstacle", Group::new().add(path));
    }
    if !picture.collisions.is_empty() {
        add("planned collision", cross((18.0, 0.0)));
    }
    if any(|route| !route.seen.is_empty()) {
        let dot = Circle::new().set("cx", 18).set("r", SIGHTING).set("fill", QUIET);
        add("detected by a sensor", Group::new().add(dot));
    }
    if any(|route| !route.map.nodes.is_empty()) {
        add("map", Group::new().add(stroke(MAP_WIDTH).set("stroke", INK)).add(map_node(18.0, 0.0)));
    }
    samples
}

fn dashed(dashes: &str) -> Line {
    stroke(PLANNED_WIDTH).set("stroke", INK).set("stroke-dasharray", dashes)
}

fn stroke(width: f64) -> Line {
    line((0.0, 0.0), (36.0, 0.0), QUIET).set("stroke-width", width)
}

/// A small body.
fn outline(fill: f64, stroke: f64) -> Rectangle {
    let place = Rectangle::new().set("x", 11).set("y", -7).set("width", 14).set("height", 14);
    place.set("fill", QUIET).set("fill-opacity", fill).set("stroke", QUIET).set("stroke-width", stroke)
}

fn last(path: &[TimedPose]) -> Option<&Pose> {
    path.last().filter(|timed| is_drawable(timed)).map(|timed| &timed.pose)
}

fn end_text(route: &Route) -> String {
    let Some(end) = last(&route.driven).or(last(&route.planned)) else { return "not planned".to_owned() };
    let (x, y) = (fixed(end.x, 3), fixed(end.y, 3));
    format!("ends at ({x}, {y}) m, {}°", fixed(heading_degrees(end.theta, 1), 1))
}

fn error_text(route: &Route) -> String {
    let (Some(driven), Some(planned)) = (last(&route.driven), last(&route.planned)) else {
        return if route.unknown_after { "end of plan".to_owned() } else { String::new() };
    };
    if route.unknown_after {
        return "end not planned".to_owned();
    }
    let (distance, angle) = (driven.distance(planned), angle_between(planned.theta, driven.theta));
    format!("{:.1} mm, {:.2}° off the plan", distance * 1000.0, angle.to_degrees().abs())
}

/// A number with fixed decimals, a typographic minus sign, and no minus before zero.
fn fixed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero { format!("−{digits}") } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::route;

    #[test]
    fn numbers_and_names_are_readable() {
        assert_eq!((fixed(-0.0001, 3), fixed(-1.5, 1)), ("0.000".to_owned(), "−1.5".to_owned()));
        let long = shorten("a_name_that_is_far_too_long_for_the_legend", MAX_NAME);
        assert!(long.chars().count() == MAX_NAME && long.ends_with('…'));
    }

    #[test]
    fn shows_the_deviation_at_the_end_if_known() {
        let turned = Pose::new(-1.0, 0.003, std::f64::consts::PI - 0.01);
        let at = |pose| vec![TimedPose { time: None, pose }];
        let mut route = route(at(Pose::new(-1.0, 0.0, -std::f64::consts::PI + 0.01)));
        route.driven = at(turned);
        assert_eq!(error_text(&route), "3.0 mm, 1.15° off the plan");
        assert_eq!(end_text(&route), "ends at (−1.000, 0.003) m, 179.4°");
        route.unknown_after = true;
        assert_eq!(error_text(&route), "end not planned");
        route.driven.clear();
        assert_eq!(
            (error_text(&route), end_text(&route)),
            ("end of plan".into(), "ends at (−1.000, 0.000) m, −179.4°".into())
        );
        route.unknown_after = false;
        assert_eq!(error_text(&route), "");
    }
}
