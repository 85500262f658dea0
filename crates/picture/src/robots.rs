//! The robots: bodies, paths, sensor detections and maps.

use pydslrep_kinematics::{Pose, TimedPose};
use pydslrep_scene::Body;
use pydslrep_trace::Map;
use svg::node::element::{Circle, Group, Polygon, Polyline};

use crate::route::{Route, is_drawable};
use crate::style::{DASHES, INK, PAPER, SHORT_DASHES, line, list, pixels};
use crate::view::View;

/// The minimum distance between points of a line, pixels.
const MIN_POINT_DISTANCE: f64 = 0.7;

/// The fill opacity of the body at the end.
pub(crate) const END_FILL: f64 = 0.22;

/// The width of the planned line, pixels.
pub(crate) const PLANNED_WIDTH: f64 = 1.4;

/// The width of the driven line, pixels, and its opacity: the dashes of the planned one must stay visible on it.
pub(crate) const DRIVEN_WIDTH: f64 = 5.0;
pub(crate) const DRIVEN_OPACITY: f64 = 0.6;

/// The radius of a detected point, pixels.
pub(crate) const SIGHTING: f64 = 2.2;

/// The width of edges and the radius of nodes in a map, pixels.
pub(crate) const MAP_WIDTH: f64 = 1.4;
const MAP_NODE: f64 = 3.0;

/// The points that a robot's sensors detected.
pub(crate) fn sightings(view: &View, route: &Route, colour: &str) -> Group {
    let mut drawn = std::collections::BTreeSet::new();
    let mut group = Group::new().set("fill", colour).set("stroke", PAPER).set("stroke-width", 0.5);
    for &(x, y) in &route.seen {
        let (x, y) = view.place(x, y);
        #[allow(clippy::cast_possible_truncation)] // pixels
        if drawn.insert(((x / SIGHTING).round() as i64, (y / SIGHTING).round() as i64)) {
            let dot = Circle::new().set("cx", pixels(x)).set("cy", pixels(y)).set("r", SIGHTING);
            group = group.add(dot);
        }
    }
    group
}

/// A map: edges as lines and nodes as dots.
pub(crate) fn map(view: &View, map: &Map) -> Group {
    let place = |&(x, y): &(f64, f64)| view.place(x, y);
    let mut group = Group::new().set("stroke", INK).set("stroke-width", MAP_WIDTH);
    for (from, to) in &map.edges {
        group = group.add(line(place(from), place(to), INK));
    }
    for (x, y) in map.nodes.iter().map(place) {
        group = group.add(map_node(x, y));
    }
    group
}

pub(crate) fn map_node(x: f64, y: f64) -> Circle {
    let dot = Circle::new().set("cx", pixels(x)).set("cy", pixels(y)).set("r", MAP_NODE);
    dot.set("fill", PAPER).set("stroke", INK).set("stroke-width", MAP_WIDTH)
}

/// The driven line in the robot's colour, with the dashed planned line on top.
pub(crate) fn lines(view: &View, route: &Route, colour: &str) -> Group {
    let driven = polyline(view, &route.driven)
        .set("stroke", colour)
        .set("stroke-width", DRIVEN_WIDTH)
        .set("stroke-opacity", DRIVEN_OPACITY);
    Group::new().add(driven).add(planned(view, route, colour))
}

/// The dashed planned line; in ink if the driven line has the robot's colour.
pub(crate) fn planned(view: &View, route: &Route, colour: &str) -> Group {
    let colour = if route.driven.is_empty() { colour } else { INK };
    Group::new().add(dashed(view, &route.planned, colour, DASHES))
}

/// Draws the ways that may be driven from the end of the planned line, and the outline of the body at the end of each:
/// some ways are shorter than the body.
pub(crate) fn ways(view: &View, route: &Route, colour: &str) -> Group {
    route.open_ways().fold(Group::new(), |group, way| {
        let group = group.add(dashed(view, way, colour, SHORT_DASHES));
        match way.last().filter(|timed| is_drawable(timed)) {
            Some(end) => group.add(outline(view, route.body, &end.pose, colour)),
            None => group,
        }
    })
}

fn dashed(view: &View, path: &[TimedPose], colour: &str, dashes: &str) -> Polyline {
    polyline(view, path)
        .set("stroke", colour)
        .set("stroke-width", PLANNED_WIDTH)
        .set("stroke-linecap", "butt")
        .set("stroke-dasharray", dashes)
}

/// The dashed outline of a body.
fn outline(view: &View, body: Body, pose: &Pose, colour: &str) -> Polygon {
    let corners = body.corners().map(|(x, y)| {
        let corner = pose.compose(&Pose::new(x, y, 0.0));
        view.place(corner.x, corner.y)
    });
    Polygon::new()
        .set("points", list(&corners))
        .set("fill", "none")
        .set("stroke", colour)
        .set("stroke-width", 1)
        .set("stroke-dasharray", SHORT_DASHES)
}

fn polyline(view: &View, path: &[TimedPose]) -> Polyline {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let drawable = path.iter().filter(|timed| is_drawable(timed));
    for point in drawable.map(|timed| view.place(timed.pose.x, timed.pose.y)) {
        if points.last().is_none_or(|last| (point.0 - last.0).hypot(point.1 - last.1) >= MIN_POINT_DISTANCE) {
            points.push(point);
        }
    }
    if let Some(end) = path.last().filter(|timed| is_drawable(timed)) {
        points.push(view.place(end.pose.x, end.pose.y));
    }
    Polyline::new()
        .set("points", list(&points))
        .set("fill", "none")
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round")
}

/// The robot at the start (outline) and at the end (filled).
pub(crate) fn bodies(view: &View, route: &Route, colour: &str) -> Group {
    let path = route.path();
    let Some(start) = path.first() else { return Group::new() };
    let group = Group::new().add(body(view, route.body, &start.pose, colour, 0.0, 1.2));
    match path.last() {
        Some(end) if path.len() > 1 => group.add(body(view, route.body, &end.pose, colour, END_FILL, 2.0)),
        _ => group,
    }
}

fn body(view: &View, body: Body, pose: &Pose, colour: &str, fill: f64, stroke: f64) -> Group {
    let (x, y) = view.place(pose.x, pose.y);
    // The picture's y points down.
    let degrees = pixels(-pose.theta.to_degrees());
    let place = format!("translate({} {}) rotate({degrees})", pixels(x), pixels(y));
    body_about_origin(view.scale, body, colour, fill, stroke).set("transform", place)
}

/// The outline of a body that heads along x, with an arrowhead in front; `scale` in pixels per metre.
pub(crate) fn body_about_origin(scale: f64, body: Body, colour: &str, fill: f64, stroke: f64) -> Group {
    let on_screen = |(x, y): (f64, f64)| (x * scale, -y * scale);
    let (length, width) = (body.length, body.width);
    let mark = [(0.42 * length, 0.0), (0.16 * length, 0.2 * width), (0.16 * length, -0.2 * width)];
    let outline = Polygon::new()
        .set("points", list(&body.corners().map(on_screen)))
        .set("fill", colour)
        .set("fill-opacity", fill)
        .set("stroke", colour)
        .set("stroke-width", stroke)
        .set("stroke-linejoin", "round");
    let mark = Polygon::new().set("points", list(&mark.map(on_screen))).set("fill", colour);
    let centre = Circle::new().set("r", 2.5).set("fill", colour);
    Group::new().add(outline).add(mark).add(centre)
}
