//! The objects that clients create: what each of them is made of.

use std::collections::BTreeMap;

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
}

/// What an object is.
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
}

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

    /// What an object of this kind is called before it gets an alias.
    pub(super) fn alias(&self) -> &'static str {
        match self {
            Self::Shape(_) => "Shape",
            Self::Joint(_) => "joint",
            Self::Sensor(_) => "proximitySensor",
            Self::ForceSensor => "forceSensor",
            Self::Dummy => "dummy",
        }
    }
}

impl JointPart {
    /// Whether a motor turns it at its target rate.
    pub(super) fn follows_velocity(&self) -> bool {
        self.mode == info::JOINT_MODE_DYNAMIC && self.control == info::CONTROL_VELOCITY && self.torque != 0.0
    }
}

impl Form {
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
