//! Planned against driven path of each robot, as an SVG picture.
//!
//! Knows poses and bodies only: no files, no simulation.

mod legend;
mod view;

use pydslrep_kinematics::Pose;
use pydslrep_scene::{Body, Obstacle};
use svg::Document;
use svg::node::element::{Circle, Group, Line, Polygon, Polyline, Rectangle, Text};

use view::{View, is_finite};

/// Okabe and Ito's colours, which stay apart for colour-blind readers, without the ones too light on white.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#b0508f", "#c08a00", "#3b9bd6"];

const INK: &str = "#24292f";
const QUIET: &str = "#6e7781";
const GRID: &str = "#e4e8ec";
const AXIS: &str = "#c3cad1";
const OBSTACLE: &str = "#d4dae1";
const OBSTACLE_EDGE: &str = "#8c959f";
const FONT: &str = "'Helvetica Neue', Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// Room for title, tick labels and legend about the floor, pixels.
const LEFT: f64 = 62.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 54.0;
const RIGHT: f64 = 24.0;

/// Points of a line nearer than this to the last one drawn are left out, pixels.
const FINENESS: f64 = 0.7;

/// How dark the body at the end is.
const END_FILL: f64 = 0.22;

/// The driven line, pixels, and how dark it is: the dashes of the planned one must stand out on it.
const DRIVEN_WIDTH: f64 = 5.0;
const DRIVEN_OPACITY: f64 = 0.6;

/// The radius of a point that a sensor saw, pixels.
const SIGHTING: f64 = 2.2;

/// The line of a way and the radius of a place in a map, pixels.
const MAP_WIDTH: f64 = 1.4;
const MAP_NODE: f64 = 3.0;

/// A circle is drawn with so many corners.
const CIRCLE_SIDES: u32 = 48;

/// How wide a letter of the title is at most, pixels.
const TITLE_LETTER: f64 = 12.0;

/// What is drawn of one robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// The robot's name.
    pub name: String,
    /// Its outer size.
    pub body: Body,
    /// The planned poses in order, the start first; see [`pydslrep_kinematics::RobotPath::sample`].
    pub planned: Vec<Pose>,
    /// Whether the plan goes on beyond its last pose with something that cannot be planned.
    pub unknown_after: bool,
    /// The driven poses in order; empty when nothing was driven.
    pub driven: Vec<Pose>,
    /// Points on the floor that the robot's sensors saw.
    pub seen: Vec<(f64, f64)>,
    /// What the robot found on exploring.
    pub map: Map,
}

/// A map of places and the ways between them, metres.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// Places.
    pub nodes: Vec<(f64, f64)>,
    /// Ways that were driven, from one place to another.
    pub edges: Vec<((f64, f64), (f64, f64))>,
}

/// Draws the routes on the floor among its obstacles: planned dashed, driven solid, bodies at start and end, what sensors
/// saw, a grid in metres, and a legend with the end of each route and how far it is off the plan.
pub fn draw(title: &str, routes: &[Route], obstacles: &[Obstacle]) -> String {
    let view = View::of(routes, obstacles, LEFT, TOP);
    let legend_left = view.left + view.width + RIGHT;
    let width = legend_left + legend::WIDTH + RIGHT;
    let height = TOP + view.height.max(legend::height(routes, obstacles)) + BOTTOM;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a width in pixels
    let title = shorten(title, ((width - LEFT - RIGHT) / TITLE_LETTER) as usize);
    let paper = Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#ffffff");
    let mut document = Document::new()
        .set("viewBox", (0, 0, pixels(width), pixels(height)))
        .set("width", pixels(width))
        .set("height", pixels(height))
        .set("font-family", FONT)
        .add(paper)
        .add(text(&title, LEFT, 32.0, 18).set("font-weight", "bold"))
        .add(floor(&view))
        .add(things(&view, obstacles));
    for (index, route) in routes.iter().enumerate() {
        document = document.add(lines(&view, route, colour(index)));
    }
    for (index, route) in routes.iter().enumerate() {
        document = document.add(bodies(&view, route, colour(index)));
    }
    for (index, route) in routes.iter().enumerate() {
        document = document.add(sightings(&view, route, colour(index)));
    }
    for route in routes {
        document = document.add(map(&view, &route.map));
    }
    document.add(legend::draw(routes, obstacles, legend_left, TOP)).to_string()
}

fn colour(index: usize) -> &'static str {
    COLOURS[index % COLOURS.len()]
}

/// Two digits after the point are finer than any screen.
fn pixels(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// Text of at most so many letters.
fn shorten(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let short: String = text.chars().take(most.saturating_sub(1)).collect();
    format!("{short}…")
}

/// Text on one line; characters that XML cannot hold are left out.
fn text(content: &str, x: f64, y: f64, size: u32) -> Text {
    let content: String = content.chars().filter(|c| !c.is_control()).collect();
    Text::new(content).set("x", pixels(x)).set("y", pixels(y)).set("font-size", size).set("fill", INK)
}

fn line((x1, y1): (f64, f64), (x2, y2): (f64, f64), colour: &str) -> Line {
    Line::new()
        .set("x1", pixels(x1))
        .set("y1", pixels(y1))
        .set("x2", pixels(x2))
        .set("y2", pixels(y2))
        .set("stroke", colour)
}

/// The grid with its ticks in metres.
fn floor(view: &View) -> Group {
    let (left, top, right, bottom) = (view.left, view.top, view.left + view.width, view.top + view.height);
    let stroke = |tick: f64| if tick == 0.0 { AXIS } else { GRID };
    let mut group = Group::new();
    for tick in view.x_ticks() {
        let (x, _) = view.place(tick, 0.0);
        let label = text(&tick_label(tick, view.tick()), x, bottom + 18.0, 12);
        group = group
            .add(line((x, top), (x, bottom), stroke(tick)))
            .add(label.set("text-anchor", "middle").set("fill", QUIET));
    }
    for tick in view.y_ticks() {
        let (_, y) = view.place(0.0, tick);
        let label = text(&tick_label(tick, view.tick()), left - 8.0, y + 4.0, 12);
        group = group
            .add(line((left, y), (right, y), stroke(tick)))
            .add(label.set("text-anchor", "end").set("fill", QUIET));
    }
    let frame = Rectangle::new()
        .set("x", pixels(left))
        .set("y", pixels(top))
        .set("width", pixels(view.width))
        .set("height", pixels(view.height))
        .set("fill", "none")
        .set("stroke", AXIS);
    let (middle_x, middle_y) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
    let x_title = text("x in m", middle_x, bottom + 38.0, 12).set("text-anchor", "middle");
    let y_title = text("y in m", 18.0, middle_y, 12)
        .set("text-anchor", "middle")
        .set("transform", format!("rotate(-90 18 {})", pixels(middle_y)));
    group.add(frame).add(x_title.set("fill", QUIET)).add(y_title.set("fill", QUIET))
}

/// The tick's value with as many decimals as its distance to the next one needs, and a true minus sign.
fn tick_label(tick: f64, step: f64) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped to what fits
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let label = format!("{:.decimals$}", tick.abs());
    if tick < 0.0 { format!("−{label}") } else { label }
}

/// The outlines of obstacles.
fn things(view: &View, obstacles: &[Obstacle]) -> Group {
    if obstacles.is_empty() {
        return Group::new();
    }
    let shape = |obstacle: &Obstacle| {
        let outline = obstacle.outline(CIRCLE_SIDES);
        let points: Vec<_> = outline.iter().map(|&(x, y)| view.place(x, y)).collect();
        Polygon::new().set("points", list(&points))
    };
    let look = Group::new()
        .set("fill", OBSTACLE)
        .set("stroke", OBSTACLE_EDGE)
        .set("stroke-width", 1)
        .set("stroke-linejoin", "round");
    obstacles.iter().fold(look, |group, obstacle| group.add(shape(obstacle)))
}

/// Points that a robot's sensors saw.
fn sightings(view: &View, route: &Route, colour: &str) -> Group {
    let mut drawn = std::collections::BTreeSet::new();
    let mut group = Group::new().set("fill", colour).set("stroke", "#ffffff").set("stroke-width", 0.5);
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

/// Ways as lines, and places as dots on them.
fn map(view: &View, map: &Map) -> Group {
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

fn map_node(x: f64, y: f64) -> Circle {
    let dot = Circle::new().set("cx", pixels(x)).set("cy", pixels(y)).set("r", MAP_NODE);
    dot.set("fill", "#ffffff").set("stroke", INK).set("stroke-width", MAP_WIDTH)
}

/// The driven line in the robot's colour, and on it the planned one, dashed.
fn lines(view: &View, route: &Route, colour: &str) -> Group {
    let driven = polyline(view, &route.driven)
        .set("stroke", colour)
        .set("stroke-width", DRIVEN_WIDTH)
        .set("stroke-opacity", DRIVEN_OPACITY);
    let stroke = if route.driven.is_empty() { colour } else { INK };
    let planned = polyline(view, &route.planned)
        .set("stroke", stroke)
        .set("stroke-width", 1.4)
        .set("stroke-linecap", "butt")
        .set("stroke-dasharray", legend::DASHES);
    Group::new().add(driven).add(planned)
}

fn polyline(view: &View, poses: &[Pose]) -> Polyline {
    let mut points: Vec<(f64, f64)> = Vec::new();
    let drawable = poses.iter().filter(|pose| is_finite(pose));
    for point in drawable.map(|pose| view.place(pose.x, pose.y)) {
        if points.last().is_none_or(|last| (point.0 - last.0).hypot(point.1 - last.1) >= FINENESS) {
            points.push(point);
        }
    }
    if let Some(end) = poses.last().filter(|pose| is_finite(pose)) {
        points.push(view.place(end.x, end.y));
    }
    Polyline::new()
        .set("points", list(&points))
        .set("fill", "none")
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round")
}

fn list(points: &[(f64, f64)]) -> String {
    let points: Vec<String> = points.iter().map(|&(x, y)| format!("{},{}", pixels(x), pixels(y))).collect();
    points.join(" ")
}

/// The robot at the start (outline) and at the end (filled, with its name).
fn bodies(view: &View, route: &Route, colour: &str) -> Group {
    let path = if route.driven.is_empty() { &route.planned } else { &route.driven };
    let mut drawable = path.iter().filter(|pose| is_finite(pose));
    let (Some(start), end) = (drawable.next(), drawable.next_back()) else { return Group::new() };
    let mut group = Group::new().add(body(view, route.body, start, colour, 0.0, 1.2));
    if let Some(end) = end {
        group = group.add(body(view, route.body, end, colour, END_FILL, 2.0));
    }
    group
}

fn body(view: &View, body: Body, pose: &Pose, colour: &str, fill: f64, stroke: f64) -> Group {
    let outline = body.corners().map(|corner| view.place_on(pose, corner));
    let (length, width) = (body.length, body.width);
    let mark = [(0.42 * length, 0.0), (0.16 * length, 0.2 * width), (0.16 * length, -0.2 * width)];
    let mark = mark.map(|point| view.place_on(pose, point));
    let (x, y) = view.place(pose.x, pose.y);
    let outline = Polygon::new()
        .set("points", list(&outline))
        .set("fill", colour)
        .set("fill-opacity", fill)
        .set("stroke", colour)
        .set("stroke-width", stroke)
        .set("stroke-linejoin", "round");
    let mark = Polygon::new().set("points", list(&mark)).set("fill", colour);
    let centre = Circle::new().set("cx", pixels(x)).set("cy", pixels(y)).set("r", 2.5).set("fill", colour);
    Group::new().add(outline).add(mark).add(centre)
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::{Action, Drive, Geometry, Model, plan_movement};

    use super::*;

    const BODY: Body = Body { length: 0.3, width: 0.3 };

    fn square() -> Route {
        let geometry = Geometry { track: 0.3, wheelbase: 0.25 };
        let model = Model::new(Drive::TwoWheel, &[0.035, 0.035], geometry).unwrap();
        let turn = Action::Turn { angle: std::f64::consts::FRAC_PI_2 };
        let side = [Action::Move { distance: 1.0, speed: 0.09 }, turn];
        let planned = plan_movement(&model, Pose::default(), &side.repeat(3)).sample(50);
        let driven = planned.iter().map(|pose| Pose { x: pose.x + 0.002, ..*pose }).collect();
        Route {
            name: "robot_1".to_owned(),
            body: BODY,
            planned,
            unknown_after: false,
            driven,
            seen: vec![],
            map: Map::default(),
        }
    }

    #[test]
    fn a_route_with_its_error() {
        let picture = draw("area_1", &[square()], &[]);
        for part in
            ["<svg", "area_1", "robot_1", "2.0 mm", "stroke-dasharray", "x in m", "\n0.0\n", "\n−0.2\n"]
        {
            assert!(picture.contains(part), "no {part} in {picture}");
        }
        assert_eq!(picture, draw("area_1", &[square()], &[]), "the same picture each time");
    }

    #[test]
    fn lines_have_no_more_points_than_can_be_seen() {
        let mut route = square();
        route.driven = (0..100_000).map(|i| Pose::new(f64::from(i) * 1e-5, 0.0, 0.0)).collect();
        assert!(draw("fine", &[route], &[]).len() < 40_000);
    }

    #[test]
    fn names_cannot_break_out_of_the_picture() {
        let mut route = square();
        route.name = "</text><script>\u{1}".to_owned();
        let picture = draw("a & b", &[route], &[]);
        assert!(!picture.contains("<script") && !picture.contains('\u{1}') && picture.contains("a &amp; b"));
    }

    #[test]
    fn strange_routes_are_still_pictures() {
        let mut route = square();
        route.driven =
            vec![Pose { x: f64::NAN, y: 0.0, theta: 0.0 }, Pose { x: f64::INFINITY, ..Pose::default() }];
        let still = Route { planned: vec![Pose::default()], driven: vec![], ..square() };
        let far = Route { planned: vec![Pose::new(-1e12, 1e12, 0.0), Pose::default()], ..square() };
        let empty = Route { planned: vec![], driven: vec![], ..square() };
        for routes in [vec![], vec![route], vec![still], vec![far], vec![empty]] {
            let picture = draw("strange", &routes, &[]);
            assert!(
                picture.contains("</svg>") && !picture.contains("NaN") && !picture.contains("inf"),
                "{picture}"
            );
        }
    }

    #[test]
    fn obstacles_and_what_is_seen_of_them() {
        let wall = Obstacle::wall("w", (3.0, -1.0), (3.0, 1.0), 0.1);
        let route = Route { seen: vec![(2.95, 0.0), (2.95, 0.0001), (2.95, 0.5)], ..square() };
        let with = draw("w", std::slice::from_ref(&route), std::slice::from_ref(&wall));
        let without = draw("w", &[Route { seen: vec![], ..route }], &[]);
        let dots = |picture: &str| picture.matches("<circle").count();
        // Two points that can be told apart, and one in the legend.
        assert_eq!(dots(&with), dots(&without) + 3);
        assert!(with.contains(OBSTACLE) && with.contains("obstacle") && with.contains("seen by a sensor"));
        assert!(!without.contains(OBSTACLE) && !without.contains("obstacle"));
        let view = View::of(&[square()], &[wall], 0.0, 0.0);
        assert!(view.place(3.05, 0.0).0 < view.width, "all of it is in the picture");
    }

    #[test]
    fn a_map_over_the_world() {
        let found = Map { nodes: vec![(0.0, 0.0), (0.5, 0.0)], edges: vec![((0.0, 0.0), (0.5, 0.0))] };
        let with = draw("m", &[Route { map: found, ..square() }], &[]);
        let without = draw("m", &[square()], &[]);
        let count = |picture: &str, part: &str| picture.matches(part).count();
        // Two places and one way, and one of each in the legend.
        assert_eq!(count(&with, "<circle"), count(&without, "<circle") + 3);
        assert_eq!(count(&with, "<line"), count(&without, "<line") + 2);
        assert!(with.contains("\nmap\n") && !without.contains("\nmap\n"));
    }

    #[test]
    fn ticks_are_round_numbers() {
        let labels: Vec<String> =
            [(0.1, 0.1), (-0.5, 0.5), (2.0, 1.0), (-20.0, 20.0)].map(|(t, s)| tick_label(t, s)).into();
        assert_eq!(labels, ["0.1", "−0.5", "2", "−20"]);
        let ticks = View::of(&[square()], &[], 0.0, 0.0).x_ticks();
        assert!(ticks.len() >= 5 && ticks.len() < 20 && ticks.contains(&0.0), "{ticks:?}");
    }
}
