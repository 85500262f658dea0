//! Obstacles that stand or move on the floor.

use std::collections::HashSet;

use super::xml::Element;
use super::{BODY_FRICTION, OBSTACLE, numeric};
use crate::{Obstacle, Scene, Shape, triangulate};

/// The obstacles of a scene.
#[derive(Default)]
pub(super) struct World {
    pub(super) bodies: Vec<Element>,
    /// The shapes of polygons.
    pub(super) meshes: Vec<Element>,
    /// Where obstacles that move are at which time.
    pub(super) paths: Vec<Element>,
    /// The names that are taken.
    names: HashSet<String>,
    /// True if robots are stopped by them.
    is_solid: bool,
}

impl World {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut world = Self { is_solid: scene.collisions, ..Self::default() };
        for obstacle in &scene.obstacles {
            world.add(obstacle);
        }
        world
    }

    fn add(&mut self, obstacle: &Obstacle) {
        let name = self.name(&obstacle.name);
        let geoms = self.geoms(&name, obstacle);
        let pose = obstacle.pose;
        let body = Element::new("body")
            .text("name", &name)
            .numbers("pos", &[pose.x, pose.y, 0.0])
            .numbers("quat", &yaw(pose.theta));
        let Some(trajectory) = &obstacle.trajectory else {
            self.bodies.push(body.with(geoms));
            return;
        };
        self.bodies.push(body.text("mocap", "true").with(geoms));
        let rows: Vec<f64> =
            trajectory.points().iter().flat_map(|point| [point.time, point.x, point.y]).collect();
        self.paths.push(numeric(format!("path/{name}"), &rows));
        self.paths.extend(trajectory.repeats().then(|| numeric(format!("repeat/{name}"), &[1.0])));
    }

    /// A name of its own, which no robot has.
    fn name(&mut self, name: &str) -> String {
        let mut own = format!("obstacle/{name}");
        while !self.names.insert(own.clone()) {
            own.push('\'');
        }
        own
    }

    fn geoms(&mut self, name: &str, obstacle: &Obstacle) -> Vec<Element> {
        let half = obstacle.height / 2.0;
        let geom = |kind: &'static str| {
            Element::new("geom")
                .text("type", kind)
                .text("contype", if self.is_solid { OBSTACLE } else { 0 }.to_string())
                .text("conaffinity", "0")
                .numbers("friction", &BODY_FRICTION)
                .numbers("rgba", if obstacle.trajectory.is_some() { &MOVING } else { &FIXED })
        };
        let standing = |geom: Element| geom.numbers("pos", &[0.0, 0.0, half]);
        match &obstacle.shape {
            Shape::Box(body) => {
                vec![standing(geom("box")).numbers("size", &[body.length / 2.0, body.width / 2.0, half])]
            }
            Shape::Cylinder { radius } => vec![standing(geom("cylinder")).numbers("size", &[*radius, half])],
            Shape::Polygon(corners) => {
                let prisms = triangulate(corners);
                let meshes = (1..=prisms.len()).map(|number| format!("{name}/{number}"));
                let geoms = meshes.clone().map(|mesh| geom("mesh").text("mesh", mesh)).collect();
                let prisms = prisms.iter().zip(meshes);
                self.meshes.extend(prisms.map(|(prism, mesh)| prism_mesh(mesh, prism, obstacle.height)));
                geoms
            }
        }
    }
}

const FIXED: [f64; 4] = [0.62, 0.62, 0.65, 1.0];
const MOVING: [f64; 4] = [0.85, 0.55, 0.3, 1.0];

/// A triangle as high as an obstacle: a collision shape has to be convex.
fn prism_mesh(name: String, corners: &[(f64, f64); 3], height: f64) -> Element {
    let vertices: Vec<f64> =
        [0.0, height].iter().flat_map(|&z| corners.iter().flat_map(move |&(x, y)| [x, y, z])).collect();
    // A thin one has hardly any volume, from which its inertia would follow.
    Element::new("mesh").text("name", name).text("inertia", "shell").numbers("vertex", &vertices)
}

/// A rotation about the vertical, as a quaternion.
pub(super) fn yaw(angle: f64) -> [f64; 4] {
    let (sin, cos) = (angle / 2.0).sin_cos();
    [cos, 0.0, 0.0, sin]
}
