//! Marks on paths at equal times, which point where the robot heads.

use pydslrep_kinematics::Pose;
use svg::node::element::{Group, Polygon};

use crate::paper::{PAPER, colour, list, pixels, text};
use crate::route::{Route, duration, pose_at};
use crate::view::View;

/// Seconds between marks that people can count in.
const STEPS: [f64; 12] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0];

/// So many marks at most, while a step is long enough for it.
const MOST: f64 = 12.0;

/// Marks nearer to the one before are left out, pixels: the robot stands or turns.
const SPACING: f64 = 18.0;

/// From the tip of a mark to its middle, pixels.
const SIZE: f64 = 6.5;

/// From a mark to its time, pixels.
const OFFSET: f64 = 13.0;

/// The height of letters, and about how wide one is, pixels.
const LETTERS: u32 = 10;
const LETTER_WIDTH: f64 = 5.8;

/// Seconds from mark to mark; `None` where times are not known.
pub(crate) fn step(routes: &[Route]) -> Option<f64> {
    let duration = duration(routes)?;
    STEPS.into_iter().find(|step| duration / step <= MOST)
}

/// The marks of all routes, and their times where there is room for them.
pub(crate) fn draw(view: &View, routes: &[Route], step: Option<f64>) -> Group {
    let Some(step) = step else { return Group::new() };
    let mut taken = Vec::new();
    let mut marks = Vec::new();
    for (index, route) in routes.iter().enumerate() {
        for (seconds, pose) in poses(view, route, step) {
            taken.push(Area::about(view.place(pose.x, pose.y), 2.0 * SIZE, 2.0 * SIZE));
            marks.push((index, seconds, pose));
        }
    }
    marks.into_iter().fold(Group::new(), |group, (index, seconds, pose)| {
        let mark = mark(view, &pose, colour(index));
        let words = format!("{seconds} s");
        let Some(area) = free_place(view, &pose, &words, &taken) else { return group.add(mark) };
        taken.push(area);
        let (x, y) = area.middle();
        let label = text(&words, x, y + 0.35 * f64::from(LETTERS), LETTERS)
            .set("text-anchor", "middle")
            .set("fill", colour(index))
            .set("stroke", PAPER)
            .set("stroke-width", 2.5)
            .set("stroke-linejoin", "round")
            .set("paint-order", "stroke");
        group.add(mark).add(label)
    })
}

/// Where a robot is at the marks, but for where it has not got on since the one before, and for the end.
fn poses(view: &View, route: &Route, step: f64) -> Vec<(f64, Pose)> {
    let path = route.path();
    let (Some(first), Some(end)) = (path.first(), path.last()) else { return Vec::new() };
    let mut last = view.place(first.pose.x, first.pose.y);
    let end_place = view.place(end.pose.x, end.pose.y);
    let mut marks = Vec::new();
    for number in 1.. {
        let seconds = f64::from(number) * step;
        // The path may begin later than the first mark.
        if end.time.is_none_or(|time| time <= seconds) {
            break;
        }
        let Some(pose) = pose_at(&path, seconds) else { continue };
        let place = view.place(pose.x, pose.y);
        // Where the robot stands at the end its body shows it.
        if [last, end_place].iter().all(|other| (place.0 - other.0).hypot(place.1 - other.1) >= SPACING) {
            marks.push((seconds, pose));
            last = place;
        }
    }
    marks
}

/// An arrowhead.
fn mark(view: &View, pose: &Pose, colour: &str) -> Polygon {
    arrowhead(view.place(pose.x, pose.y), pose.theta, colour)
}

/// An arrowhead at a place of the picture, with a heading in radians.
pub(crate) fn arrowhead((x, y): (f64, f64), heading: f64, colour: &str) -> Polygon {
    let (sin, cos) = heading.sin_cos();
    let corner = |(ahead, left): (f64, f64)| {
        (x + SIZE * (ahead * cos - left * sin), y - SIZE * (ahead * sin + left * cos))
    };
    let corners = [(1.0, 0.0), (-0.8, 0.75), (-0.35, 0.0), (-0.8, -0.75)].map(corner);
    Polygon::new()
        .set("points", list(&corners))
        .set("fill", colour)
        .set("stroke", PAPER)
        .set("stroke-width", 1)
        .set("stroke-linejoin", "round")
}

/// A place beside a mark, to its left or its right, where nothing else is written.
fn free_place(view: &View, pose: &Pose, words: &str, taken: &[Area]) -> Option<Area> {
    let (x, y) = view.place(pose.x, pose.y);
    #[allow(clippy::cast_precision_loss)] // a few letters
    let width = LETTER_WIDTH * words.chars().count() as f64;
    let side = |sign: f64| {
        let (across_x, across_y) = (-pose.theta.sin() * sign, -pose.theta.cos() * sign);
        let away = OFFSET + across_x.abs() * (width / 2.0 - 4.0).max(0.0);
        Area::about((x + away * across_x, y + away * across_y), width, f64::from(LETTERS))
    };
    [1.0, -1.0].map(side).into_iter().find(|area| taken.iter().all(|other| !area.meets(other)))
}

/// A part of the picture, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Area {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Area {
    fn about((x, y): (f64, f64), width: f64, height: f64) -> Self {
        let (left, right) = (x - width / 2.0, x + width / 2.0);
        Self { left, right, top: y - height / 2.0, bottom: y + height / 2.0 }
    }

    fn middle(&self) -> (f64, f64) {
        (pixels(f64::midpoint(self.left, self.right)), pixels(f64::midpoint(self.top, self.bottom)))
    }

    fn meets(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{along, route};

    #[test]
    fn a_mark_every_so_many_seconds_while_the_robot_gets_on() {
        // 4 m in 40 s, with a rest of 20 s in the middle.
        let path = along(&[(0.0, 0.0), (20.0, 2.0), (40.0, 2.0), (60.0, 4.0)]);
        let routes = [route(path)];
        let step = step(&routes);
        assert_eq!(step, Some(5.0));
        let view = View::of(&routes, &[], 0.0, 0.0);
        let times: Vec<f64> = poses(&view, &routes[0], 5.0).iter().map(|mark| mark.0).collect();
        assert_eq!(times, [5.0, 10.0, 15.0, 20.0, 45.0, 50.0, 55.0]);
        let drawn = draw(&view, &routes, step).to_string();
        assert_eq!(drawn.matches("<polygon").count(), 7);
        assert!(drawn.contains("\n45 s\n"), "{drawn}");
    }

    #[test]
    fn times_are_not_written_over_each_other() {
        let path = || along(&[(0.0, 0.0), (60.0, 4.0)]);
        // On the same line, so only two of three have a side of their own.
        let routes = [route(path()), route(path()), route(path())];
        let view = View::of(&routes, &[], 0.0, 0.0);
        let drawn = draw(&view, &routes, Some(30.0)).to_string();
        assert_eq!((drawn.matches("<polygon").count(), drawn.matches("30 s").count()), (3, 2));
    }

    #[test]
    fn no_marks_without_times() {
        let mut path = along(&[(0.0, 0.0), (60.0, 4.0)]);
        for timed in &mut path {
            timed.time = None;
        }
        assert_eq!(step(&[route(path)]), None);
        assert_eq!(step(&[]), None);
    }
}
