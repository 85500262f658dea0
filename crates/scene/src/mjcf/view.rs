//! What `MuJoCo`'s viewer shows: where its camera looks when it opens, the light, and the floor.

use pydslrep_kinematics::{Pose, RobotPath};

use super::xml::Element;
use crate::{Obstacle, Scene};

/// The minimum side of what is shown, metres, so that a robot at rest has surroundings.
const MIN_SPAN: f64 = 1.5;

/// Points of a planned leg that are looked at; arcs have to be in view, too.
const POINTS_PER_LEG: u32 = 8;

/// The middle and the size of what is in view when the viewer opens: obstacles, and robots with their planned paths. The camera
/// looks at the middle from one and a half times the size away.
pub(super) fn view(scene: &Scene, paths: &[RobotPath]) -> Element {
    let points: Vec<(f64, f64)> = robots(scene, paths)
        .chain(obstacles(scene))
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let (x, width) = span(points.iter().map(|point| point.0));
    let (y, depth) = span(points.iter().map(|point| point.1));
    let extent = width.max(depth).max(MIN_SPAN);
    Element::new("statistic").numbers("center", &[x, y, 0.0]).numbers("extent", &[extent])
}

/// Corners around each place where robots are or will be.
fn robots(scene: &Scene, paths: &[RobotPath]) -> impl Iterator<Item = (f64, f64)> {
    let reach = scene.robots.iter().map(|robot| robot.body.reach()).fold(0.0, f64::max);
    let starts = scene.robots.iter().map(|robot| robot.start);
    let poses = starts.chain(paths.iter().flat_map(poses));
    poses.flat_map(move |pose| [(pose.x - reach, pose.y - reach), (pose.x + reach, pose.y + reach)])
}

/// Where a path leads, and where it may lead from where that depends on sensors.
fn poses(path: &RobotPath) -> impl Iterator<Item = Pose> {
    let possible = path.sample_possible(POINTS_PER_LEG).into_iter().flatten();
    path.sample(POINTS_PER_LEG).into_iter().chain(possible).map(|timed| timed.pose)
}

fn obstacles(scene: &Scene) -> impl Iterator<Item = (f64, f64)> {
    scene.obstacles.iter().flat_map(Obstacle::corners_on_its_way)
}

/// A light at the viewer's eye, bright enough for the colours to be seen as they are.
pub(super) fn light() -> Element {
    let light = Element::new("headlight")
        .numbers("ambient", &[0.5; 3])
        .numbers("diffuse", &[0.45; 3])
        .numbers("specular", &[0.0; 3]);
    Element::new("visual").with([light])
}

/// The name of the floor's material.
pub(super) const FLOOR_MATERIAL: &str = "squares";

/// One-metre squares, which show how far robots drive.
pub(super) fn floor_material() -> [Element; 2] {
    let squares = Element::new("texture")
        .text("name", FLOOR_MATERIAL)
        .text("type", "2d")
        .text("builtin", "checker")
        .text("width", "256")
        .text("height", "256")
        .numbers("rgb1", &[0.93, 0.93, 0.91])
        .numbers("rgb2", &[0.88, 0.88, 0.86]);
    // The texture is two squares wide.
    let material = Element::new("material")
        .text("name", FLOOR_MATERIAL)
        .text("texture", FLOOR_MATERIAL)
        .text("texuniform", "true")
        .numbers("texrepeat", &[0.5, 0.5]);
    [squares, material]
}

/// The middle of numbers, and how far they are apart; of none, zero.
fn span(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let low = values.clone().reduce(f64::min).unwrap_or_default();
    let high = values.reduce(f64::max).unwrap_or_default();
    (f64::midpoint(low, high), high - low)
}
