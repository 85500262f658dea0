//! The floor: grid, obstacles and planned collisions.

use pydslrep_scene::Obstacle;
use svg::node::element::{Group, Path, Polygon, Polyline, Rectangle};

use crate::style::{
    ALARM, AXIS, FINE_DASHES, GRID, OBSTACLE, OBSTACLE_EDGE, PAPER, QUIET, line, list, pixels, text,
};
use crate::view::View;

/// The number of corners of circles.
const CIRCLE_SIDES: u32 = 48;

/// Half the size of a collision mark, pixels.
const CROSS: f64 = 6.0;

/// The grid with tick labels in metres.
pub(crate) fn grid(view: &View) -> Group {
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

/// The value of a tick with the decimals that the tick distance needs, and a typographic minus sign.
fn tick_label(tick: f64, step: f64) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped to what fits
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let label = format!("{:.decimals$}", tick.abs());
    if tick < 0.0 { format!("−{label}") } else { label }
}

/// The outlines of obstacles; those that move are at their first point.
pub(crate) fn obstacles<'a>(view: &View, obstacles: impl Iterator<Item = &'a Obstacle>) -> Group {
    let mut obstacles = obstacles.peekable();
    if obstacles.peek().is_none() {
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
    obstacles.fold(look, |group, obstacle| group.add(shape(obstacle)))
}

/// The paths of the obstacles that move.
pub(crate) fn obstacle_paths(view: &View, obstacles: &[Obstacle]) -> Group {
    let paths = obstacles.iter().filter_map(|obstacle| obstacle.trajectory.as_ref());
    paths.fold(Group::new(), |group, path| {
        let points: Vec<_> = path.points().iter().map(|point| view.place(point.x, point.y)).collect();
        let line = Polyline::new().set("points", list(&points)).set("fill", "none");
        let line = line.set("stroke", OBSTACLE_EDGE).set("stroke-width", 1);
        group.add(line.set("stroke-dasharray", FINE_DASHES))
    })
}

/// Marks for planned collisions.
pub(crate) fn collisions(view: &View, places: &[(f64, f64)]) -> Group {
    let crosses = places.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
    crosses.fold(Group::new(), |group, &(x, y)| group.add(cross(view.place(x, y))))
}

/// A cross with an outline, visible on any background.
pub(crate) fn cross((x, y): (f64, f64)) -> Group {
    let (left, right, top, bottom) =
        (pixels(x - CROSS), pixels(x + CROSS), pixels(y - CROSS), pixels(y + CROSS));
    let lines = format!("M{left},{top} L{right},{bottom} M{left},{bottom} L{right},{top}");
    let stroke = |colour: &str, width: f64| {
        let path = Path::new().set("d", lines.as_str()).set("fill", "none").set("stroke-linecap", "round");
        path.set("stroke", colour).set("stroke-width", width)
    };
    Group::new().add(stroke(PAPER, 6.0)).add(stroke(ALARM, 3.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers() {
        let labels: Vec<String> =
            [(0.1, 0.1), (-0.5, 0.5), (2.0, 1.0), (-20.0, 20.0)].map(|(t, s)| tick_label(t, s)).into();
        assert_eq!(labels, ["0.1", "−0.5", "2", "−20"]);
    }
}
