//! Replays: an animated SVG that shows the robots driving, in a loop.
//!
//! The animation is declarative (SMIL), so every browser plays it without scripts.

use pydslrep_kinematics::{TimedPose, angle_between};
use pydslrep_scene::Obstacle;
use svg::node::element::{Animate, AnimateTransform, Circle, Group, Polyline, Text};

use crate::legend::Key;
use crate::route::{Picture, Route, duration};
use crate::style::{AXIS, INK, QUIET, line, list, pixels, text};
use crate::view::View;
use crate::{floor, legend, robots};

/// The maximum duration of a replay, seconds; longer drives are sped up.
const MAX_DURATION: f64 = 16.0;

/// The possible speed factors.
const FACTORS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];

/// The pause at the end, seconds.
const PAUSE: f64 = 1.5;

/// The tolerance for simplifying motion, pixels and degrees.
const TOLERANCE: f64 = 0.4;

/// The opacity of the complete path.
const TRAIL_OPACITY: f64 = 0.25;

/// The maximum number of key frames of an obstacle; nobody could follow more.
const MAX_FRAMES: usize = 2000;

/// The height of the timeline below the floor, pixels.
const TIME_HEIGHT: f64 = 44.0;

impl Picture<'_> {
    /// Draws an animated SVG: robots move along their driven paths, or along the planned ones if nothing was driven, and
    /// obstacles along theirs. Without known times it is a still picture.
    pub fn replay(&self) -> String {
        let Some(seconds) = duration(self.routes) else { return self.svg() };
        let clock = Clock::of(seconds);
        let (view, sheet) = self.sheet(TIME_HEIGHT);
        let sheet = self.movers().fold(sheet, |sheet, mover| sheet.add(obstacle(&view, mover, &clock)));
        self.with_ways(&view, sheet)
            .add(self.each(|route, colour| robots::planned(&view, route, colour)))
            .add(self.each(|route, colour| trail(&view, route, colour, &clock)))
            .add(self.each(|route, colour| body(&view, route, colour, &clock)))
            .add(time_line(&view, &clock))
            .add(legend::draw(self, Key::Moving, Picture::beside(&view)))
            .to_string()
    }
}

/// The mapping from simulated time to replay time.
struct Clock {
    /// The simulated duration, seconds.
    seconds: f64,
    /// The speed factor.
    factor: f64,
}

impl Clock {
    fn of(seconds: f64) -> Self {
        let fast_enough = |factor: &f64| seconds / factor <= MAX_DURATION;
        let factor = FACTORS.into_iter().find(fast_enough).unwrap_or(seconds / MAX_DURATION);
        Self { seconds, factor }
    }

    /// The duration including the pause at the end, seconds.
    fn length(&self) -> f64 {
        self.seconds / self.factor + PAUSE
    }

    /// The progress of the replay at a simulated time, from 0 to 1.
    fn part(&self, seconds: f64) -> f64 {
        (seconds.clamp(0.0, self.seconds) / self.factor / self.length()).clamp(0.0, 1.0)
    }

    /// The `keyTimes` of an animation, including the start and end of the replay.
    fn key_times(&self, times: impl Iterator<Item = f64>) -> String {
        let inner = times.map(|time| format!("{:.5}", self.part(time)));
        let all: Vec<String> = std::iter::once("0".to_owned()).chain(inner).chain(["1".to_owned()]).collect();
        all.join(";")
    }
}

/// The position and heading of a robot at a time, pixels and degrees; degrees are not wrapped.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    seconds: f64,
    x: f64,
    y: f64,
    degrees: f64,
}

/// The key frames of a robot's motion.
fn frames(view: &View, route: &Route) -> Vec<Frame> {
    let path = route.path();
    let mut frames: Vec<Frame> = Vec::with_capacity(path.len());
    let mut heading = path.first().map_or(0.0, |timed| timed.pose.theta);
    for TimedPose { time, pose } in &path {
        let Some(seconds) = *time else { break };
        heading += angle_between(heading, pose.theta);
        let (x, y) = view.place(pose.x, pose.y);
        if frames.last().is_none_or(|last| last.seconds < seconds) {
            // The picture's y points down.
            frames.push(Frame { seconds, x, y, degrees: -heading.to_degrees() });
        }
    }
    thin(&frames)
}

/// Removes redundant frames (the Douglas-Peucker algorithm over time).
fn thin(frames: &[Frame]) -> Vec<Frame> {
    let Some(last) = frames.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![false; frames.len()];
    kept[0] = true;
    kept[last] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |index: &usize| frames[*index].off(&frames[from], &frames[to]);
        let worst = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(worst) = worst.filter(|worst| off(worst) > TOLERANCE) {
            kept[worst] = true;
            open.extend([(from, worst), (worst, to)]);
        }
    }
    frames.iter().zip(kept).filter_map(|(frame, kept)| kept.then_some(*frame)).collect()
}

impl Frame {
    /// The deviation of this frame from the linear motion between two others.
    fn off(&self, from: &Self, to: &Self) -> f64 {
        let part = (self.seconds - from.seconds) / (to.seconds - from.seconds);
        let between = |from: f64, to: f64| from + part * (to - from);
        let (x, y) = (between(from.x, to.x), between(from.y, to.y));
        let turned = (self.degrees - between(from.degrees, to.degrees)).abs();
        (self.x - x).hypot(self.y - y).max(turned)
    }
}

/// The values at the start, each frame and the end.
fn values(frames: &[Frame], value: impl Fn(&Frame) -> String) -> String {
    let all = frames.first().into_iter().chain(frames).chain(frames.last());
    all.map(value).collect::<Vec<_>>().join(";")
}

fn animation(clock: &Clock, name: &str, values: String, times: &str) -> Animate {
    Animate::new()
        .set("attributeName", name)
        .set("values", values)
        .set("keyTimes", times)
        .set("dur", format!("{}s", pixels(clock.length())))
        .set("repeatCount", "indefinite")
}

fn transformation(clock: &Clock, kind: &str, values: String, times: &str) -> AnimateTransform {
    AnimateTransform::new()
        .set("attributeName", "transform")
        .set("type", kind)
        .set("values", values)
        .set("keyTimes", times)
        .set("dur", format!("{}s", pixels(clock.length())))
        .set("repeatCount", "indefinite")
}

/// An obstacle that moves.
fn obstacle(view: &View, obstacle: &Obstacle, clock: &Clock) -> Group {
    let drawn = floor::obstacles(view, std::iter::once(obstacle));
    let frames = obstacle_frames(view, obstacle, clock);
    let Some(last) = frames.last() else { return drawn };
    moved(&frames, last, clock, drawn)
}

/// What is drawn about the origin, moved along key frames; viewers without animation show it at the last one.
fn moved(frames: &[Frame], last: &Frame, clock: &Clock, drawn: Group) -> Group {
    let times = clock.key_times(frames.iter().map(|frame| frame.seconds));
    let places = values(frames, |frame| format!("{},{}", pixels(frame.x), pixels(frame.y)));
    Group::new()
        .set("transform", format!("translate({} {})", pixels(last.x), pixels(last.y)))
        .add(transformation(clock, "translate", places, &times))
        .add(drawn)
}

/// Returns the offset of an obstacle from its start at each change of its velocity, in pixels.
fn obstacle_frames(view: &View, obstacle: &Obstacle, clock: &Clock) -> Vec<Frame> {
    let Some(trajectory) = &obstacle.trajectory else { return Vec::new() };
    let start = view.place(obstacle.pose.x, obstacle.pose.y);
    let times = trajectory.changes().take_while(|time| *time < clock.seconds).take(MAX_FRAMES);
    let frame = |seconds: f64| {
        let (x, y) = trajectory.at(seconds);
        let place = view.place(x, y);
        Frame { seconds, x: place.0 - start.0, y: place.1 - start.1, degrees: 0.0 }
    };
    thin(&times.chain([clock.seconds]).map(frame).collect::<Vec<_>>())
}

/// The complete path, and the driven part of it.
fn trail(view: &View, route: &Route, colour: &str, clock: &Clock) -> Group {
    let frames = frames(view, route);
    let points: Vec<(f64, f64)> = frames.iter().map(|frame| (frame.x, frame.y)).collect();
    let mut length = 0.0;
    let mut driven = vec![0.0];
    for pair in points.windows(2) {
        length += (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        driven.push(length);
    }
    let way = || {
        let way = Polyline::new().set("points", list(&points)).set("fill", "none").set("stroke", colour);
        way.set("stroke-width", robots::DRIVEN_WIDTH).set("stroke-linejoin", "round")
    };
    let faint = way().set("stroke-opacity", TRAIL_OPACITY).set("stroke-linecap", "round");
    if length <= 0.0 {
        return Group::new().add(faint);
    }
    // A dash as long as the path is shifted along it.
    let left: Vec<String> = driven.iter().map(|driven| pixels(length - driven).to_string()).collect();
    let values = format!("{};{};{}", left[0], left.join(";"), left[left.len() - 1]);
    let times = clock.key_times(frames.iter().map(|frame| frame.seconds));
    let bold = way()
        .set("stroke-opacity", robots::DRIVEN_OPACITY)
        .set("stroke-dasharray", format!("{0} {0}", pixels(length)))
        .add(animation(clock, "stroke-dashoffset", values, &times));
    Group::new().add(faint).add(bold)
}

/// The robot; viewers without animation show it at the end.
fn body(view: &View, route: &Route, colour: &str, clock: &Clock) -> Group {
    let frames = frames(view, route);
    let Some(last) = frames.last() else { return Group::new() };
    let times = clock.key_times(frames.iter().map(|frame| frame.seconds));
    let turns = values(&frames, |frame| pixels(frame.degrees).to_string());
    let turned = Group::new()
        .set("transform", format!("rotate({})", pixels(last.degrees)))
        .add(transformation(clock, "rotate", turns, &times))
        .add(robots::body_about_origin(view.scale, route.body, colour, robots::END_FILL, 2.0));
    moved(&frames, last, clock, turned)
}

/// The timeline with the progress of the replay.
fn time_line(view: &View, clock: &Clock) -> Group {
    let (left, right) = (view.left, view.left + view.width);
    let y = view.top + view.height + TIME_HEIGHT + 14.0;
    let times = clock.key_times([0.0, clock.seconds].into_iter());
    let places = [left, left, right, right].map(|x| pixels(x).to_string()).join(";");
    let words = |words: &str, x: f64, anchor: &str| -> Text {
        text(words, x, y + 20.0, 12).set("text-anchor", anchor).set("fill", QUIET)
    };
    let whole = |from, to, colour| line((from, y), (to, y), colour).set("stroke-width", 3);
    let passed = whole(left, right, INK).add(animation(clock, "x2", places.clone(), &times));
    let now = Circle::new().set("cx", pixels(right)).set("cy", pixels(y)).set("r", 5).set("fill", INK);
    Group::new()
        .add(whole(left, right, AXIS))
        .add(passed)
        .add(now.add(animation(clock, "cx", places, &times)))
        .add(words("0 s", left, "start"))
        .add(words(&speed(clock), f64::midpoint(left, right), "middle"))
        .add(words(&format!("{:.1} s", clock.seconds), right, "end"))
}

fn speed(clock: &Clock) -> String {
    match clock.factor {
        1.0 => "real time".to_owned(),
        factor => format!("{factor:.0}× real time"),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use pydslrep_kinematics::Pose;

    use super::*;
    use crate::testing::{along, route};

    fn picture(routes: &[Route]) -> Picture<'_> {
        Picture { title: "t", routes, obstacles: &[], collisions: &[] }
    }

    #[test]
    fn linear_motion_has_two_frames() {
        let steady: Vec<(f64, f64)> = (0..=100).map(|i| (f64::from(i), 0.02 * f64::from(i))).collect();
        let routes = [route(along(&steady))];
        let view = View::of(&routes, &[], 0.0, 0.0);
        assert_eq!(frames(&view, &routes[0]).len(), 2);
        let rests = [route(along(&[(0.0, 0.0), (10.0, 1.0), (20.0, 1.0), (30.0, 2.0)]))];
        assert_eq!(frames(&view, &rests[0]).len(), 4, "a pause is visible");
    }

    #[test]
    fn obstacles_are_where_they_are_at_the_time() {
        use pydslrep_scene::{Shape, Trajectory, Waypoint};
        let points = [(2.0, 1.0), (4.0, 2.0), (5.0, 2.0)].map(|(time, x)| Waypoint { time, x, y: 1.0 });
        let person = |repeats| {
            let trajectory = Trajectory::new(points.to_vec(), repeats).unwrap();
            Obstacle::moving("person", 0.0, Shape::Cylinder { radius: 0.2 }, trajectory)
        };
        let routes = [route(along(&[(0.0, 0.0), (8.0, 1.0)]))];
        let obstacles = [person(true)];
        let (view, clock) = (View::of(&routes, &obstacles, 0.0, 0.0), Clock::of(8.0));
        let moved = |obstacle: &Obstacle| -> Vec<(f64, f64)> {
            let frames = obstacle_frames(&view, obstacle, &clock);
            frames.iter().map(|frame| (frame.seconds, (frame.x / view.scale * 1e6).round() / 1e6)).collect()
        };
        assert_eq!(moved(&person(false)), [(0.0, 0.0), (2.0, 0.0), (4.0, 1.0), (8.0, 1.0)]);
        assert_eq!(moved(&obstacles[0]), [(0.0, 0.0), (2.0, 0.0), (4.0, 1.0), (6.0, 1.0), (8.0, 0.0)]);
        let drawn = Picture { title: "t", routes: &routes, obstacles: &obstacles, collisions: &[] }.replay();
        let still = Picture { title: "t", routes: &routes, obstacles: &[], collisions: &[] }.replay();
        let count = |text: &str| text.matches("<animateTransform").count();
        assert_eq!(count(&drawn), count(&still) + 1);
        assert!(drawn.contains("path of an obstacle"), "{drawn}");
    }

    #[test]
    fn headings_are_not_wrapped() {
        let at = |time, theta| TimedPose { time: Some(time), pose: Pose { x: 0.0, y: 0.0, theta } };
        let routes = [route(vec![at(0.0, 0.0), at(1.0, 3.0), at(2.0, -3.0), at(3.0, -1.5 * PI + 0.5)])];
        let view = View::of(&routes, &[], 0.0, 0.0);
        let turned: Vec<f64> = frames(&view, &routes[0]).iter().map(|frame| frame.degrees.round()).collect();
        assert_eq!(turned, [0.0, -172.0, -188.0, -119.0]);
    }

    #[test]
    fn every_animation_has_as_many_times_as_values_and_runs_from_0_to_1() {
        let second = along(&[(0.0, 0.0), (5.0, 0.5)]);
        let routes = [route(along(&[(0.0, 0.0), (10.0, 1.0), (400.0, 1.0), (410.0, 2.0)])), route(second)];
        let drawn = picture(&routes).replay();
        let attribute = |name: &str| -> Vec<Vec<String>> {
            let start = format!(" {name}=\"");
            let parts = drawn.split(&start).skip(1);
            let inside = parts.filter_map(|part| part.split('"').next());
            inside.map(|list| list.split(';').map(str::to_owned).collect()).collect()
        };
        let (times, values) = (attribute("keyTimes"), attribute("values"));
        assert_eq!(times.len(), 8);
        for (times, values) in times.iter().zip(&values) {
            let times: Vec<f64> = times.iter().map(|time| time.parse().unwrap()).collect();
            assert_eq!(times.len(), values.len());
            assert_eq!((times[0], times[times.len() - 1]), (0.0, 1.0));
            assert!(times.windows(2).all(|pair| pair[0] <= pair[1]), "{times:?}");
        }
        assert!(drawn.contains("50× real time") && drawn.contains("\n410.0 s\n"), "{drawn}");
    }

    #[test]
    fn unusual_routes_are_valid_pictures() {
        let mut timeless = along(&[(0.0, 0.0), (60.0, 4.0)]);
        for timed in &mut timeless {
            timed.time = None;
        }
        let still = along(&[(0.0, 0.0), (3.0, 0.0)]);
        let broken = along(&[(0.0, 0.0), (f64::NAN, 1.0), (2.0, f64::INFINITY), (3.0, 1.0)]);
        for path in [timeless, still, broken, vec![]] {
            let drawn = picture(&[route(path)]).replay();
            assert!(drawn.contains("</svg>") && !drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
        }
    }
}
