//! Sight of sensors beyond the simulated world: floors, and single objects on request.

use ciborium::Value;
use nalgebra::{Isometry3, Point3, Vector3};
use pydslrep_kinematics::Pose;
use pydslrep_scene::{Mount, Obstacle, Scene, Space};

use super::arguments::{self, Arguments, Outcome};
use super::calls::{CallContext, undetected};
use super::info;
use super::objects::{Handle, Kind, Objects};
use super::parts::{Form, PartKind};
use super::recognition::{FLOOR, outlines, top_of};
use crate::World;

/// A sensor in the world: its frame, whose z axis is its direction, and its cone.
struct Sensor {
    frame: Isometry3<f64>,
    /// Metres.
    range: f64,
    /// The opening angle, radians.
    cone: f64,
}

/// A sensor's sight of an object.
pub(super) struct Seen {
    /// Metres.
    pub(super) distance: f64,
    /// The nearest point, in the world.
    pub(super) point: Point3<f64>,
    /// The normal of the surface there.
    pub(super) normal: Vector3<f64>,
}

/// `sim.checkProximitySensor`: whether a sensor sees an object, also while the simulation is stopped, and whether the object is
/// detectable or not. Of a program's own objects, it sees obstacles.
pub(super) fn check(context: &CallContext, arguments: &Arguments) -> Outcome {
    let (handle, other) = (context.object(arguments)?.0, arguments.integer(1)?);
    context.sensor(arguments)?;
    if context.objects.get(other).is_none() {
        return Err(arguments.failure(316, "object does not exist."));
    }
    let sensor = sensor(context.objects, context.world, handle);
    let seen = sensor.as_ref().and_then(|sensor| sight_of(context, sensor, other));
    let Some((sensor, seen)) = sensor.zip(seen) else {
        return Ok(undetected(0));
    };
    let point = sensor.frame.inverse_transform_point(&seen.point).coords;
    let normal = sensor.frame.inverse_transform_vector(&seen.normal);
    let (point, normal) = (arguments::vector(point), arguments::vector(normal));
    Ok(vec![Value::from(1), seen.distance.into(), point, other.into(), normal])
}

/// The nearest detectable floor that a created sensor sees.
pub(super) fn nearest_floor(objects: &Objects, world: &World, handle: Handle) -> Option<(Handle, Seen)> {
    if objects.floors().is_empty() {
        return None;
    }
    let sensor = sensor(objects, world, handle)?;
    let seen = objects.floors().iter().filter_map(|&floor| {
        let shape = objects.shape(floor)?;
        Some((floor, sensor.floor(&objects.rest_frame(floor)?, &shape.form)?))
    });
    seen.min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance))
}

/// Returns whether a created object is a floor that sensors see.
pub(super) fn is_detectable_floor(objects: &Objects, handle: Handle) -> bool {
    let is_detectable = objects.part(handle).is_some_and(|part| part.special & info::SPECIAL_DETECTABLE != 0);
    let shape = objects.shape(handle).filter(|shape| shape.is_static && is_detectable);
    shape.zip(objects.rest_frame(handle)).is_some_and(|(shape, frame)| top_of(&frame, &shape.form) <= FLOOR)
}

fn sensor(objects: &Objects, world: &World, handle: Handle) -> Option<Sensor> {
    let frame = objects.frame(handle, world)?;
    match (objects.part(handle).map(|part| &part.kind), objects.get(handle)?.kind) {
        (Some(PartKind::Sensor(part)), _) => {
            Some(Sensor { frame, range: part.offset + part.range, cone: part.angle })
        }
        (_, Kind::Sensor { robot, sensor }) => {
            let Mount { range, cone, .. } = world.scene().robots.get(robot)?.sensors.get(sensor)?.mount;
            Some(Sensor { frame, range, cone })
        }
        _ => None,
    }
}

fn sight_of(context: &CallContext, sensor: &Sensor, other: Handle) -> Option<Seen> {
    if let Some(shape) = context.objects.shape(other) {
        let frame = context.objects.frame(other, context.world)?;
        if top_of(&frame, &shape.form) <= FLOOR {
            return sensor.floor(&frame, &shape.form);
        }
        let outlines = outlines(&frame, &shape.form).into_iter();
        return sensor.obstacle(outlines.map(|(pose, shape)| Obstacle::fixed("", pose, shape)).collect());
    }
    match context.objects.get(other)?.kind {
        Kind::Obstacle(index) => {
            let obstacle = context.world.scene().obstacles.get(index)?;
            let (pose, shape) = (context.world.obstacle_pose(index)?, obstacle.shape.clone());
            sensor.obstacle(vec![Obstacle::fixed("", pose, shape)])
        }
        _ => None,
    }
}

impl Sensor {
    /// Returns the sight of an obstacle, which is as high as the sensor.
    fn obstacle(&self, parts: Vec<Obstacle>) -> Option<Seen> {
        let direction = self.frame * Vector3::z();
        let at = self.frame.translation.vector;
        let pose = Pose::new(at.x, at.y, direction.y.atan2(direction.x));
        let mount = Mount { pose: Pose::default(), range: self.range, cone: self.cone };
        let space = Space::of(&Scene { obstacles: parts, ..Scene::default() });
        let seen = space.sight(pose, &mount, &[])?;
        Some(Seen {
            distance: seen.distance,
            point: Point3::new(seen.point.0, seen.point.1, at.z),
            normal: Vector3::new(seen.normal.0, seen.normal.1, 0.0),
        })
    }

    /// Returns the sight of a floor: where the lower edge of the cone meets it.
    fn floor(&self, frame: &Isometry3<f64>, form: &Form) -> Option<Seen> {
        let direction = self.frame * Vector3::z();
        let at = self.frame.translation.vector;
        let height = at.z - top_of(frame, form);
        let fall = (self.cone / 2.0 - direction.z.clamp(-1.0, 1.0).asin()).min(std::f64::consts::FRAC_PI_2);
        if height <= 0.0 || fall <= 1e-9 {
            return None;
        }
        let distance = height / fall.sin();
        let way = direction.xy().try_normalize(1e-9).unwrap_or_default() * distance * fall.cos();
        let point = Point3::new(at.x + way.x, at.y + way.y, at.z - height);
        let (low, high) = form.bounds();
        let on_floor = frame.inverse_transform_point(&point);
        let is_on = (0..2).all(|axis| (low[axis]..=high[axis]).contains(&on_floor[axis]));
        (is_on && distance <= self.range).then_some(Seen { distance, point, normal: Vector3::z() })
    }
}
