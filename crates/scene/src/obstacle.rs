//! Fixed obstacles on the floor.

use pydslrep_kinematics::Pose;

use crate::Body;

/// Something that robots cannot drive through.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Its name, also for clients of the remote API.
    pub name: String,
    /// The frame of its shape.
    pub pose: Pose,
    /// Its outline.
    pub shape: Shape,
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
    /// A straight wall between two points, `thickness` metres thick.
    pub fn wall(name: impl Into<String>, from: (f64, f64), to: (f64, f64), thickness: f64) -> Self {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        Self {
            name: name.into(),
            pose: Pose::new(f64::midpoint(from.0, to.0), f64::midpoint(from.1, to.1), dy.atan2(dx)),
            shape: Shape::Box(Body { length: dx.hypot(dy), width: thickness }),
        }
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
}
