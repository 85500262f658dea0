//! Obstacles on the floor: fixed ones, and those that move as they like.

use pydslrep_kinematics::Pose;

use crate::{Body, Trajectory, defaults};

/// Something that robots cannot drive through.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Its name, also for clients of the remote API.
    pub name: String,
    /// The frame of its shape; where it starts if it moves.
    pub pose: Pose,
    /// Its outline.
    pub shape: Shape,
    /// Its height above the floor, metres.
    pub height: f64,
    /// Where its middle is at which time, if it moves; its heading stays.
    pub trajectory: Option<Trajectory>,
}

/// The outline of an obstacle, in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A rectangle about the origin.
    Box(Body),
    /// A circle about the origin.
    Cylinder {
        /// Metres.
        radius: f64,
    },
    /// A polygon that need not be convex and does not cross itself: its corners in order, metres.
    Polygon(Vec<(f64, f64)>),
}

impl Obstacle {
    /// One that does not move.
    pub fn fixed(name: impl Into<String>, pose: Pose, shape: Shape) -> Self {
        Self { name: name.into(), pose, shape, height: defaults::HEIGHT, trajectory: None }
    }

    /// One that moves and keeps its heading, radians.
    pub fn moving(name: impl Into<String>, heading: f64, shape: Shape, trajectory: Trajectory) -> Self {
        let (x, y) = trajectory.at(0.0);
        Self { trajectory: Some(trajectory), ..Self::fixed(name, Pose::new(x, y, heading), shape) }
    }

    /// Its pose at a time, seconds since the start of the simulation.
    pub fn pose_at(&self, time: f64) -> Pose {
        let place = self.trajectory.as_ref().map(|trajectory| trajectory.at(time));
        place.map_or(self.pose, |(x, y)| Pose { x, y, ..self.pose })
    }

    /// It with another height, metres.
    #[must_use]
    pub fn of_height(self, height: f64) -> Self {
        Self { height, ..self }
    }

    /// A straight wall between two points, `thickness` metres thick.
    pub fn wall(name: impl Into<String>, from: (f64, f64), to: (f64, f64), thickness: f64) -> Self {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let pose = Pose::new(f64::midpoint(from.0, to.0), f64::midpoint(from.1, to.1), dy.atan2(dx));
        Self::fixed(name, pose, Shape::Box(Body { length: dx.hypot(dy), width: thickness }))
    }

    /// The corners of its outline on the floor, in order; for a circle, those of a regular polygon with `sides` corners.
    pub fn outline(&self, sides: u32) -> Vec<(f64, f64)> {
        let own: Vec<(f64, f64)> = match &self.shape {
            Shape::Box(body) => body.corners().to_vec(),
            Shape::Cylinder { radius } => (0..sides)
                .map(|side| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(side) / f64::from(sides)).sin_cos();
                    (radius * cos, radius * sin)
                })
                .collect(),
            Shape::Polygon(corners) => corners.clone(),
        };
        let placed = own.into_iter().map(|(x, y)| self.pose.compose(&Pose::new(x, y, 0.0)));
        placed.map(|corner| (corner.x, corner.y)).collect()
    }

    /// The corners of its outline at each point of its trajectory; for a circle, four points of it.
    pub fn corners_on_its_way(&self) -> Vec<(f64, f64)> {
        let path = self.trajectory.iter().flat_map(Trajectory::points);
        let ways = path.map(|point| (point.x - self.pose.x, point.y - self.pose.y));
        let ways: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(ways).collect();
        let corners = self.outline(4);
        ways.iter()
            .flat_map(|(x, y)| corners.iter().map(move |corner| (corner.0 + x, corner.1 + y)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn outlines_go_once_around() {
        let pose = Pose::new(1.0, 2.0, FRAC_PI_2);
        let outline = |shape| Obstacle::fixed("", pose, shape).outline(4);
        let cases = [
            (Shape::Cylinder { radius: 0.5 }, [(1.0, 2.5), (0.5, 2.0), (1.0, 1.5), (1.5, 2.0)]),
            (Shape::Box(Body { length: 2.0, width: 1.0 }), [(0.5, 3.0), (0.5, 1.0), (1.5, 1.0), (1.5, 3.0)]),
            (
                Shape::Polygon(vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.2, 0.3)]),
                [(1.0, 2.0), (1.0, 3.0), (0.0, 3.0), (0.7, 2.2)],
            ),
        ];
        for (shape, expected) in cases {
            let found = outline(shape);
            let is_near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).hypot(a.1 - b.1) < 1e-12;
            assert!(found.len() == 4 && found.iter().zip(&expected).all(is_near), "{found:?}");
        }
    }

    #[test]
    fn a_wall_is_between_its_ends() {
        let wall = Obstacle::wall("w", (1.0, 1.0), (1.0, 4.0), 0.2);
        let corners = wall.outline(0);
        for corner in [(0.9, 1.0), (1.1, 1.0), (0.9, 4.0), (1.1, 4.0)] {
            let is_there = corners.iter().any(|at| (at.0 - corner.0).hypot(at.1 - corner.1) < 1e-12);
            assert!(is_there, "{corners:?}");
        }
    }
}
