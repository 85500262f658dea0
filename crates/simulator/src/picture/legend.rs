//! What the lines mean, and where each robot ended.

use pydslrep_kinematics::{Pose, angle_between, heading_degrees};
use pydslrep_scene::Obstacle;
use svg::node::element::{Circle, Group, Rectangle};

use super::view::is_finite;
use super::{
    DRIVEN_OPACITY, DRIVEN_WIDTH, END_FILL, INK, MAP_WIDTH, OBSTACLE, OBSTACLE_EDGE, QUIET, Route, SIGHTING,
    colour, line, map_node, pixels, shorten, text,
};

/// Pixels.
pub(super) const WIDTH: f64 = 252.0;

/// Dash and gap of planned paths, pixels.
pub(super) const DASHES: &str = "6 4";

const KEY_HEIGHT: f64 = 100.0;
const KEY_LINE: f64 = 22.0;
const ENTRY_HEIGHT: f64 = 66.0;
const LONGEST_NAME: usize = 24;

pub(super) fn height(routes: &[Route], obstacles: &[Obstacle]) -> f64 {
    routes.iter().map(|_| ENTRY_HEIGHT).sum::<f64>()
        + KEY_HEIGHT
        + 2.0 * KEY_LINE * f64::from(u8::from(!obstacles.is_empty()))
        + KEY_LINE * f64::from(u8::from(routes.iter().any(|route| !route.map.nodes.is_empty())))
}

pub(super) fn draw(routes: &[Route], obstacles: &[Obstacle], left: f64, top: f64) -> Group {
    let mut group = Group::new();
    let mut y = top;
    for (index, route) in routes.iter().enumerate() {
        group = group.add(entry(route, colour(index), left, y));
        y += ENTRY_HEIGHT;
    }
    group.add(key(routes, obstacles, left, y))
}

fn entry(route: &Route, colour: &str, left: f64, top: f64) -> Group {
    let swatch = Rectangle::new()
        .set("x", pixels(left))
        .set("y", pixels(top + 2.0))
        .set("width", 12)
        .set("height", 12)
        .set("rx", 3)
        .set("fill", colour);
    let name =
        text(&shorten(&route.name, LONGEST_NAME), left + 20.0, top + 13.0, 14).set("font-weight", "bold");
    let first = text(&end_text(route), left + 20.0, top + 31.0, 12).set("fill", QUIET);
    let second = text(&error_text(route), left + 20.0, top + 47.0, 12);
    Group::new().add(swatch).add(name).add(first).add(second)
}

/// What the lines and bodies mean; only what is in the picture.
fn key(routes: &[Route], obstacles: &[Obstacle], left: f64, top: f64) -> Group {
    let mut samples: Vec<(&str, Box<dyn svg::Node>)> = Vec::new();
    let stroke = |width: f64| line((0.0, 0.0), (36.0, 0.0), QUIET).set("stroke-width", width);
    let outline = |fill: f64, stroke: f64| {
        let place = Rectangle::new().set("x", 11).set("y", -7).set("width", 14).set("height", 14);
        place.set("fill", QUIET).set("fill-opacity", fill).set("stroke", QUIET).set("stroke-width", stroke)
    };
    if routes.iter().any(|route| !route.planned.is_empty()) {
        let dashed = stroke(1.4).set("stroke", INK).set("stroke-dasharray", DASHES);
        samples.push(("planned", Box::new(dashed)));
    }
    if routes.iter().any(|route| !route.driven.is_empty()) {
        samples.push(("driven", Box::new(stroke(DRIVEN_WIDTH).set("stroke-opacity", DRIVEN_OPACITY))));
    }
    if !routes.is_empty() {
        samples.push(("at the start", Box::new(outline(0.0, 1.2))));
        samples.push(("at the end", Box::new(outline(END_FILL, 2.0))));
    }
    if !obstacles.is_empty() {
        let place = Rectangle::new().set("x", 11).set("y", -7).set("width", 14).set("height", 14);
        let place = place.set("fill", OBSTACLE).set("stroke", OBSTACLE_EDGE);
        samples.push(("obstacle", Box::new(place)));
    }
    if routes.iter().any(|route| !route.seen.is_empty()) {
        let dot = Circle::new().set("cx", 18).set("r", SIGHTING).set("fill", QUIET);
        samples.push(("seen by a sensor", Box::new(dot)));
    }
    if routes.iter().any(|route| !route.map.nodes.is_empty()) {
        let way = stroke(MAP_WIDTH).set("stroke", INK);
        samples.push(("map", Box::new(Group::new().add(way).add(map_node(18.0, 0.0)))));
    }
    let mut group = Group::new();
    let mut y = top + 12.0;
    for (meaning, sample) in samples {
        let place = format!("translate({} {})", pixels(left), pixels(y));
        group = group.add(Group::new().set("transform", place).add(sample));
        group = group.add(text(meaning, left + 46.0, y + 4.0, 12));
        y += KEY_LINE;
    }
    group
}

fn last(poses: &[Pose]) -> Option<&Pose> {
    poses.last().filter(|pose| is_finite(pose))
}

fn end_text(route: &Route) -> String {
    let Some(end) = last(&route.driven).or(last(&route.planned)) else { return "not planned".to_owned() };
    let (x, y) = (fixed(end.x, 3), fixed(end.y, 3));
    format!("ends at ({x}, {y}) m, {}°", fixed(heading_degrees(end.theta, 1), 1))
}

fn error_text(route: &Route) -> String {
    let (Some(driven), Some(planned)) = (last(&route.driven), last(&route.planned)) else {
        return if route.unknown_after { "plan ends there".to_owned() } else { String::new() };
    };
    if route.unknown_after {
        return "end not planned".to_owned();
    }
    let (distance, angle) = (driven.distance(planned), angle_between(planned.theta, driven.theta));
    format!("{:.1} mm, {:.2}° off the plan", distance * 1000.0, angle.to_degrees().abs())
}

/// A number with fixed decimals, a true minus sign, and no minus before zero.
fn fixed(value: f64, decimals: usize) -> String {
    let digits = format!("{:.decimals$}", value.abs());
    let is_zero = digits.chars().all(|c| c == '0' || c == '.');
    if value < 0.0 && !is_zero { format!("−{digits}") } else { digits }
}

#[cfg(test)]
mod tests {
    use pydslrep_scene::Body;

    use super::super::Map;
    use super::*;

    #[test]
    fn numbers_and_names_for_people() {
        assert_eq!((fixed(-0.0001, 3), fixed(-1.5, 1)), ("0.000".to_owned(), "−1.5".to_owned()));
        let long = shorten("a_name_that_is_far_too_long_for_the_legend", LONGEST_NAME);
        assert!(long.chars().count() == LONGEST_NAME && long.ends_with('…'));
    }

    #[test]
    fn says_how_far_the_end_is_off_or_why_not() {
        let body = Body { length: 0.3, width: 0.3 };
        let turned = Pose::new(-1.0, 0.003, std::f64::consts::PI - 0.01);
        let planned = vec![Pose::new(-1.0, 0.0, -std::f64::consts::PI + 0.01)];
        let mut route = Route {
            name: "r".into(),
            body,
            planned,
            unknown_after: false,
            driven: vec![turned],
            seen: vec![],
            map: Map::default(),
        };
        assert_eq!(error_text(&route), "3.0 mm, 1.15° off the plan");
        assert_eq!(end_text(&route), "ends at (−1.000, 0.003) m, 179.4°");
        route.unknown_after = true;
        assert_eq!(error_text(&route), "end not planned");
        route.driven.clear();
        assert_eq!(
            (error_text(&route), end_text(&route)),
            ("plan ends there".into(), "ends at (−1.000, 0.000) m, −179.4°".into())
        );
        route.unknown_after = false;
        assert_eq!(error_text(&route), "");
    }
}
