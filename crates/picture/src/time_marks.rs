//! Time marks: arrowheads on paths at equal time intervals, with the robot's heading.

use pydslrep_kinematics::Pose;
use svg::node::element::{Group, Polygon};

use crate::route::{Route, duration, pose_at};
use crate::style::{PAPER, colour, list, pixels, text};
use crate::view::View;

/// The possible intervals between marks, seconds.
const STEPS: [f64; 12] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0];

/// The maximum number of marks, if an interval is long enough.
const MAX_MARKS: f64 = 12.0;

/// The minimum distance between marks, pixels; closer ones are omitted while the robot stands or turns.
const SPACING: f64 = 18.0;

/// The distance from the tip of a mark to its centre, pixels.
const SIZE: f64 = 6.5;

/// The distance from a mark to its label, pixels.
const OFFSET: f64 = 13.0;

/// The height and approximate width of a letter, pixels.
const LETTERS: u32 = 10;
const LETTER_WIDTH: f64 = 5.8;

/// The interval between marks, seconds; `None` if times are unknown.
pub(crate) fn step(routes: &[Route]) -> Option<f64> {
    let duration = duration(routes)?;
    STEPS.into_iter().find(|step| duration / step <= MAX_MARKS)
}

/// The marks of all routes, with labels where there is space.
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

/// The poses at the marks, except where the robot has not moved on since the last one, and near the end.
fn poses(view: &View, route: &Route, step: f64) -> Vec<(f64, Pose)> {
    let path = route.path();
    let (Some(first), Some(end)) = (path.first(), path.last()) else { return Vec::new() };
    let mut last = view.place(first.pose.x, first.pose.y);
    let end_place = view.place(end.pose.x, end.pose.y);
    let mut marks = Vec::new();
    for number in 1.. {
        let seconds = f64::from(number) * step;
        // The path may begin after the first mark.
        if end.time.is_none_or(|time| time <= seconds) {
            break;
        }
        let Some(pose) = pose_at(&path, seconds) else { continue };
        let place = view.place(pose.x, pose.y);
        // At the end the body itself is drawn.
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

/// An arrowhead at a point of the picture, with a heading in radians.
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

/// A free area for a label to the left or right of a mark.
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

/// An area of the picture, pixels.
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
    fn marks_have_equal_intervals_while_the_robot_moves() {
        // 4 m in 40 s, with a pause of 20 s in the middle.
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
    fn labels_do_not_overlap() {
        let path = || along(&[(0.0, 0.0), (60.0, 4.0)]);
        // On the same line, so only two of three labels have a free side.
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
