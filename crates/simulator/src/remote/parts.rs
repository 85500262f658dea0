//! The descriptions of the objects that clients create.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use nalgebra::{Isometry3, Vector3};

use super::info;

/// An object that a client has created.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) kind: PartKind,
    /// Its frame relative to its parent, or to the world.
    pub(super) local: Isometry3<f64>,
    /// Custom data by name.
    pub(super) data: BTreeMap<String, String>,
    /// The sum of `sim.objectspecialproperty_…`.
    pub(super) special: i64,
    /// The parameters of physics engines that clients have set.
    pub(super) engine: BTreeMap<i64, f64>,
}

/// Meshes of more triangles count as not convex: to find out takes time.
const MAX_CONVEX: usize = 300;

/// The sides of a cuboid, whose corners count x, y and z as bits.
const CUBOID: [[usize; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];

/// The kind of an object.
#[derive(Debug, Clone)]
pub(super) enum PartKind {
    Shape(ShapePart),
    Joint(JointPart),
    Sensor(SensorPart),
    ForceSensor,
    Dummy,
}

#[derive(Debug, Clone)]
pub(super) struct ShapePart {
    pub(super) form: Form,
    pub(super) is_static: bool,
    pub(super) is_respondable: bool,
    pub(super) mask: i64,
    /// Kilograms.
    pub(super) mass: f64,
}

/// The form of a shape about its own origin, metres.
#[derive(Debug, Clone)]
pub(super) enum Form {
    /// A primitive: its number in `sim.primitiveshape_…` and its size along each axis.
    Primitive(i64, Vector3<f64>),
    /// Triangles.
    Mesh(Vec<[Vector3<f64>; 3]>),
}

/// The corners of a mesh, metres, and its triangles as indices of three corners each.
pub(super) type Mesh = (Vec<Vector3<f64>>, Vec<[usize; 3]>);

#[derive(Debug, Clone)]
pub(super) struct JointPart {
    /// Its number in `sim.joint_…_subtype`.
    pub(super) subtype: i64,
    pub(super) mode: i64,
    pub(super) control: i64,
    /// Newton metres.
    pub(super) torque: f64,
    /// The target rate, rad/s, until the object is one of a robot.
    pub(super) target: f64,
}

#[derive(Debug, Clone)]
pub(super) struct SensorPart {
    /// Its number in `sim.proximitysensor_…_subtype`.
    pub(super) subtype: i64,
    /// Where its volume begins and how long it is, metres.
    pub(super) offset: f64,
    pub(super) range: f64,
    /// The opening angle of its cone, radians.
    pub(super) angle: f64,
    /// The edge of the box that it is drawn as, metres.
    pub(super) size: f64,
}

/// The length and the diameter that a joint is drawn with, metres.
const JOINT_SIZE: (f64, f64) = (0.15, 0.02);

/// The density that shapes have first, kg/m³, and the mass of a mesh, kg.
const DENSITY: f64 = 500.0;
const MESH_MASS: f64 = 1.0;

/// The friction that shapes have first in the engine Bullet.
const PRIMITIVE_FRICTION: f64 = 1.0;
const MESH_FRICTION: f64 = 0.71;

impl PartKind {
    /// The number of its type.
    pub(super) fn type_number(&self) -> i64 {
        match self {
            Self::Shape(_) => info::TYPE_SHAPE,
            Self::Joint(_) => info::TYPE_JOINT,
            Self::Sensor(_) => info::TYPE_SENSOR,
            Self::ForceSensor => info::TYPE_FORCE_SENSOR,
            Self::Dummy => info::TYPE_DUMMY,
        }
    }

    /// Returns the alias of a new object of this kind.
    pub(super) fn alias(&self) -> &'static str {
        match self {
            Self::Shape(ShapePart { form: Form::Primitive(kind, _), .. }) => match *kind {
                info::PRIMITIVE_CUBOID => "Cuboid",
                info::PRIMITIVE_SPHERE => "Sphere",
                info::PRIMITIVE_CYLINDER => "Cylinder",
                _ => "Shape",
            },
            Self::Shape(_) => "Shape",
            Self::Joint(JointPart { subtype: info::JOINT_REVOLUTE, .. }) => "Revolute_joint",
            Self::Joint(JointPart { subtype: info::JOINT_PRISMATIC, .. }) => "Prismatic_joint",
            Self::Joint(_) => "Spherical_joint",
            Self::Sensor(_) => "Proximity_sensor",
            Self::ForceSensor => "ForceSensor",
            Self::Dummy => "Dummy",
        }
    }

    /// The sum of `sim.objectspecialproperty_…` that it has first.
    pub(super) fn special(&self) -> i64 {
        if matches!(self, Self::Shape(_)) { info::SPECIAL_ALL } else { 0 }
    }

    /// The corners of its bounding box as the engine reports them, metres.
    ///
    /// That of a mesh has axes of its own there: it has the size of the mesh, not its place.
    pub(super) fn reported_bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let half = match self {
            Self::Shape(ShapePart { form: Form::Primitive(_, size), .. }) => size / 2.0,
            Self::Shape(ShapePart { form, .. }) => {
                let mut sizes: [f64; 3] = form.size().into();
                sizes.sort_by(f64::total_cmp);
                Vector3::from(sizes) / 2.0
            }
            Self::Joint(_) => Vector3::new(JOINT_SIZE.1, JOINT_SIZE.1, JOINT_SIZE.0) / 2.0,
            Self::Sensor(sensor) => Vector3::repeat(sensor.size / 2.0),
            Self::ForceSensor | Self::Dummy => Vector3::zeros(),
        };
        (-half, half)
    }
}

impl JointPart {
    /// Returns whether a motor turns it at its target rate.
    pub(super) fn follows_velocity(&self) -> bool {
        self.mode == info::JOINT_MODE_DYNAMIC && self.control == info::CONTROL_VELOCITY && self.torque != 0.0
    }
}

impl Form {
    /// The mass that a shape has first, kilograms.
    pub(super) fn mass(&self) -> f64 {
        let Self::Primitive(kind, size) = self else { return MESH_MASS };
        let share = match *kind {
            info::PRIMITIVE_SPHERE => PI / 6.0,
            info::PRIMITIVE_CYLINDER => PI / 4.0,
            _ => 1.0,
        };
        (DENSITY * share * size.product()).max(1e-7)
    }

    /// The friction that a shape has first in the engine Bullet.
    pub(super) fn friction(&self) -> f64 {
        if matches!(self, Self::Primitive(..)) { PRIMITIVE_FRICTION } else { MESH_FRICTION }
    }

    /// Returns whether no corner is outside of any triangle.
    pub(super) fn is_convex(&self) -> bool {
        let Self::Mesh(triangles) = self else { return true };
        let tolerance = 1e-6 * self.size().norm();
        triangles.iter().take(MAX_CONVEX).all(|[a, b, c]| {
            let normal = (b - a).cross(&(c - a)).normalize();
            triangles.iter().flatten().all(|corner| normal.dot(&(corner - a)) <= tolerance)
        }) && triangles.len() <= MAX_CONVEX
    }

    /// Its corners, and its triangles as three indices each, counter-clockwise from outside. Of the primitives, only a cuboid
    /// has them here.
    pub(super) fn mesh(&self) -> Option<Mesh> {
        match self {
            Self::Primitive(info::PRIMITIVE_CUBOID, size) => {
                let side = |corner: usize, bit: usize| if corner >> bit & 1 == 0 { -0.5 } else { 0.5 };
                let corner =
                    |corner: usize| Vector3::from([0, 1, 2].map(|axis| side(corner, axis) * size[axis]));
                Some(((0..8).map(corner).collect(), CUBOID.to_vec()))
            }
            Self::Primitive(..) => None,
            Self::Mesh(triangles) => {
                let corners = triangles.iter().flatten().copied().collect();
                Some((
                    corners,
                    (0..triangles.len()).map(|first| [0, 1, 2].map(|next| 3 * first + next)).collect(),
                ))
            }
        }
    }

    /// The corners of its bounding box, metres.
    pub(super) fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        match self {
            Self::Primitive(_, size) => (-size / 2.0, size / 2.0),
            Self::Mesh(triangles) => {
                let mut corners = triangles.iter().flatten();
                let first = corners.next().copied().unwrap_or_default();
                corners.fold((first, first), |(low, high), corner| (low.inf(corner), high.sup(corner)))
            }
        }
    }

    /// Its size along each axis, metres.
    pub(super) fn size(&self) -> Vector3<f64> {
        let (low, high) = self.bounds();
        high - low
    }
}
