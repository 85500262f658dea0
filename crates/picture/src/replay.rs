//! A picture that drives: an SVG whose robots move as they did, over and over.
//!
//! The animation is declared in the SVG (SMIL), so that every browser plays it and nothing in it is a program.

use pydslrep_kinematics::{TimedPose, angle_between};
use svg::node::element::{Animate, AnimateTransform, Circle, Group, Polyline, Text};

use crate::legend::Key;
use crate::paper::{AXIS, INK, QUIET, line, list, pixels, text};
use crate::route::{Picture, Route, duration};
use crate::view::View;
use crate::{legend, robots};

/// A replay lasts at most so long, seconds; longer drives are played faster.
const LONGEST: f64 = 16.0;

/// How many times faster than driven a replay may be.
const FACTORS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];

/// The rest at the end, seconds.
const REST: f64 = 1.5;

/// What a body may be off on the screen, pixels and degrees.
const FINENESS: f64 = 0.4;

/// The way that was driven before, as dark as that.
const TRAIL_OPACITY: f64 = 0.25;

/// Room for the time below the floor, pixels.
const TIME_HEIGHT: f64 = 44.0;

impl Picture<'_> {
    /// Draws robots that drive, as SVG: along what they drove, or along their plans where they have not driven. Where no
    /// times are known, nothing moves.
    pub fn replay(&self) -> String {
        let Some(seconds) = duration(self.routes) else { return self.svg() };
        let clock = Clock::of(seconds);
        let (view, sheet) = self.sheet(TIME_HEIGHT);
        sheet
            .add(self.each(|route, colour| robots::planned(&view, route, colour)))
            .add(self.each(|route, colour| trail(&view, route, colour, &clock)))
            .add(self.each(|route, colour| body(&view, route, colour, &clock)))
            .add(time_line(&view, &clock))
            .add(legend::draw(self, Key::Moving, Picture::beside(&view)))
            .to_string()
    }
}

/// How simulated time passes in the replay.
struct Clock {
    /// What is played, simulated seconds.
    seconds: f64,
    /// How many times faster than driven.
    factor: f64,
}

impl Clock {
    fn of(seconds: f64) -> Self {
        let fast_enough = |factor: &f64| seconds / factor <= LONGEST;
        let factor = FACTORS.into_iter().find(fast_enough).unwrap_or(seconds / LONGEST);
        Self { seconds, factor }
    }

    /// How long it takes with the rest at the end, seconds.
    fn length(&self) -> f64 {
        self.seconds / self.factor + REST
    }

    /// The part of the replay that is over at a simulated time, from 0 to 1.
    fn part(&self, seconds: f64) -> f64 {
        (seconds.clamp(0.0, self.seconds) / self.factor / self.length()).clamp(0.0, 1.0)
    }

    /// The parts at which an animation has its values, from the start to the end of the replay.
    fn key_times(&self, times: impl Iterator<Item = f64>) -> String {
        let inner = times.map(|time| format!("{:.5}", self.part(time)));
        let all: Vec<String> = std::iter::once("0".to_owned()).chain(inner).chain(["1".to_owned()]).collect();
        all.join(";")
    }
}

/// What a robot shows at a time, pixels and degrees; degrees go on beyond 360.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Frame {
    seconds: f64,
    x: f64,
    y: f64,
    degrees: f64,
}

/// The moments between which a robot's motion looks straight.
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

/// Leaves out frames that nobody misses (Douglas and Peucker's way, over time).
fn thin(frames: &[Frame]) -> Vec<Frame> {
    let Some(last) = frames.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![false; frames.len()];
    kept[0] = true;
    kept[last] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |index: &usize| frames[*index].off(&frames[from], &frames[to]);
        let worst = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(worst) = worst.filter(|worst| off(worst) > FINENESS) {
            kept[worst] = true;
            open.extend([(from, worst), (worst, to)]);
        }
    }
    frames.iter().zip(kept).filter_map(|(frame, kept)| kept.then_some(*frame)).collect()
}

impl Frame {
    /// How far this is from where the straight motion between two others is at its time.
    fn off(&self, from: &Self, to: &Self) -> f64 {
        let part = (self.seconds - from.seconds) / (to.seconds - from.seconds);
        let between = |from: f64, to: f64| from + part * (to - from);
        let (x, y) = (between(from.x, to.x), between(from.y, to.y));
        let turned = (self.degrees - between(from.degrees, to.degrees)).abs();
        (self.x - x).hypot(self.y - y).max(turned)
    }
}

/// Values for the start, each frame and the end.
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

/// The way, and how much of it is driven.
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
    // A dash as long as the way is pushed onto it.
    let left: Vec<String> = driven.iter().map(|driven| pixels(length - driven).to_string()).collect();
    let values = format!("{};{};{}", left[0], left.join(";"), left[left.len() - 1]);
    let times = clock.key_times(frames.iter().map(|frame| frame.seconds));
    let bold = way()
        .set("stroke-opacity", robots::DRIVEN_OPACITY)
        .set("stroke-dasharray", format!("{0} {0}", pixels(length)))
        .add(animation(clock, "stroke-dashoffset", values, &times));
    Group::new().add(faint).add(bold)
}

/// The robot, which a viewer without animation shows at the end.
fn body(view: &View, route: &Route, colour: &str, clock: &Clock) -> Group {
    let frames = frames(view, route);
    let Some(last) = frames.last() else { return Group::new() };
    let times = clock.key_times(frames.iter().map(|frame| frame.seconds));
    let places = values(&frames, |frame| format!("{},{}", pixels(frame.x), pixels(frame.y)));
    let turns = values(&frames, |frame| pixels(frame.degrees).to_string());
    let turned = Group::new()
        .set("transform", format!("rotate({})", pixels(last.degrees)))
        .add(transformation(clock, "rotate", turns, &times))
        .add(robots::body_about_origin(view.scale, route.body, colour, robots::END_FILL, 2.0));
    Group::new()
        .set("transform", format!("translate({} {})", pixels(last.x), pixels(last.y)))
        .add(transformation(clock, "translate", places, &times))
        .add(turned)
}

/// How far the replay has got.
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
        1.0 => "as fast as driven".to_owned(),
        factor => format!("{factor:.0} times as fast"),
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
    fn what_looks_straight_is_one_motion() {
        let steady: Vec<(f64, f64)> = (0..=100).map(|i| (f64::from(i), 0.02 * f64::from(i))).collect();
        let routes = [route(along(&steady))];
        let view = View::of(&routes, &[], 0.0, 0.0);
        assert_eq!(frames(&view, &routes[0]).len(), 2);
        let rests = [route(along(&[(0.0, 0.0), (10.0, 1.0), (20.0, 1.0), (30.0, 2.0)]))];
        assert_eq!(frames(&view, &rests[0]).len(), 4, "a rest is seen");
    }

    #[test]
    fn turns_go_on_beyond_half_a_circle() {
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
        assert!(drawn.contains("50 times as fast") && drawn.contains("\n410.0 s\n"), "{drawn}");
    }

    #[test]
    fn strange_routes_are_still_pictures() {
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
