//! From the objects that clients have created to the robots and obstacles that are simulated.
//!
//! A robot is a dynamic shape with as many revolute joints below it as a type has wheels, each of which turns one: a dynamic
//! shape that collides. Wheels that carry joints themselves have rollers: they are mecanum wheels. Obstacles are static shapes
//! that collide and rise above the floor.

use nalgebra::{Isometry3, Vector2, Vector3};
use pydslrep_kinematics::{Drive, Pose};
use pydslrep_scene::{Body, Mount, Obstacle, Robot, Scene, SensorKind, Shape, Wheel, geometry_of};

use super::info;
use super::objects::{Handle, Kind, Objects, planar};
use super::parts::{Form, PartKind, ShapePart};
use crate::World;

/// The maximum number of robots; every step takes time for each pair of them.
const MAX_ROBOTS: usize = 32;

/// The maximum number of convex obstacles.
const MAX_OBSTACLES: usize = 4000;

/// The height above the floor up to which objects are not obstacles, metres.
pub(super) const FLOOR: f64 = 0.02;

/// The scene of a program with the objects that clients have created, and their roles in it.
pub(super) struct Recognized {
    pub(super) scene: Scene,
    pub(super) roles: Vec<(Handle, Kind)>,
    /// For each robot that clients have created, its object and where that is relative to the robot.
    pub(super) offsets: Vec<(Handle, Isometry3<f64>)>,
}

/// Recognizes the robots and obstacles among the objects that clients have created.
pub(super) fn recognize(objects: &Objects, program: &Scene) -> Recognized {
    let mut found = Recognized { scene: program.clone(), roles: Vec::new(), offsets: Vec::new() };
    for handle in objects.made() {
        let Some(shape) = objects.shape(handle) else { continue };
        if shape.is_static {
            add_obstacle(objects, handle, shape, &mut found);
        } else if found.scene.robots.len() < program.robots.len() + MAX_ROBOTS {
            add_robot(objects, handle, shape, &mut found);
        }
    }
    // A client that creates a scene gives the positions itself.
    found.scene.collisions |= !found.roles.is_empty();
    found
}

fn is_joint(objects: &Objects, handle: Handle) -> bool {
    objects.part(handle).is_some_and(|part| matches!(part.kind, PartKind::Joint(_)))
}

struct FoundWheel {
    handle: Handle,
    frame: Isometry3<f64>,
    radius: f64,
    has_rollers: bool,
}

fn add_robot(objects: &Objects, body: Handle, shape: &ShapePart, found: &mut Recognized) {
    let above = objects.ancestors(body);
    if above.iter().any(|&above| objects.shape(above).is_some_and(|shape| !shape.is_static)) {
        // It is a part of the robot above.
        return;
    }
    let below = objects.below(body);
    let mut wheels: Vec<FoundWheel> = below.iter().filter_map(|&joint| wheel(objects, body, joint)).collect();
    let drive = Drive::inferred(wheels.len(), || wheels.iter().all(|wheel| wheel.has_rollers));
    let Some((frame, drive)) = objects.rest_frame(body).zip(drive) else { return };
    let Some(heading) = heading(&frame, &wheels) else { return };
    let turned = planar(Pose::new(0.0, 0.0, heading), 0.0);
    let on_floor = |wheel: &FoundWheel| turned.inverse_transform_vector(&wheel.frame.translation.vector);
    let across = |a: &FoundWheel, b: &FoundWheel| on_floor(b).y.total_cmp(&on_floor(a).y);
    wheels.sort_by(across);
    let half = wheels.len() / 2;
    for side in wheels.chunks_mut(half) {
        side.sort_by(|a, b| on_floor(b).x.total_cmp(&on_floor(a).x));
    }
    let positions: Vec<Vector3<f64>> = wheels.iter().map(on_floor).collect();
    let count = if half == 1 { 2.0 } else { 4.0 };
    let places: Vec<(f64, f64)> = positions.iter().map(|at| (at.x, at.y)).collect();
    let geometry = geometry_of(drive, &places);
    if geometry.track <= 0.0 || geometry.wheelbase <= 0.0 {
        return;
    }
    let middle = turned * (positions.iter().sum::<Vector3<f64>>() / count);
    let start = Pose::new(middle.x, middle.y, heading);
    let origin = planar(start, 0.0);
    let name = objects.alias(body);
    let parts: Vec<Wheel> = wheels
        .iter()
        .map(|wheel| Wheel {
            name: objects.alias(wheel.handle),
            radius: wheel.radius,
            mirrored: (origin.inverse() * wheel.frame * Vector3::z()).y < 0.0,
        })
        .collect();
    let index = found.scene.robots.len();
    let mut robot = Robot::new(name, drive, parts, Vec::new());
    robot.start = start;
    robot.geometry = geometry;
    robot.body = outline(&(origin.inverse() * frame), &shape.form);
    for &sensor in &below {
        let Some(mount) = mount(objects, sensor, &origin) else { continue };
        let name = objects.alias(sensor);
        found.roles.push((sensor, Kind::Sensor { robot: index, sensor: robot.sensors.len() }));
        robot.sensors.push(pydslrep_scene::Sensor { name, kind: SensorKind::Distance, mount });
    }
    found.roles.push((body, Kind::Robot(index)));
    for (number, wheel) in wheels.iter().enumerate() {
        found.roles.push((wheel.handle, Kind::Wheel { robot: index, wheel: number }));
    }
    found.offsets.push((body, origin.inverse() * frame));
    found.scene.robots.push(robot);
}

/// A joint below a body, if it turns a wheel.
fn wheel(objects: &Objects, body: Handle, joint: Handle) -> Option<FoundWheel> {
    let PartKind::Joint(part) = &objects.part(joint)?.kind else { return None };
    let between = objects.ancestors(joint);
    let inner = between.iter().take_while(|&&above| above != body);
    if part.subtype != info::JOINT_REVOLUTE || inner.clone().any(|&above| is_joint(objects, above)) {
        return None;
    }
    let frame = objects.rest_frame(joint)?;
    let below = objects.below(joint);
    let reach = |&shape: &Handle| -> Option<f64> {
        let part = objects.shape(shape).filter(|shape| !shape.is_static && shape.is_respondable)?;
        let middle = (frame.inverse() * objects.rest_frame(shape)?).translation.vector;
        Some(middle.xy().norm() + part.form.size().max() / 2.0)
    };
    let radius = below.iter().filter_map(reach).fold(0.0, f64::max);
    let has_rollers = below.iter().any(|&below| is_joint(objects, below));
    (radius > 0.0).then_some(FoundWheel { handle: joint, frame, radius, has_rollers })
}

/// Where a robot drives when its wheels roll forward: across their axes, and the way that its x axis points.
fn heading(body: &Isometry3<f64>, wheels: &[FoundWheel]) -> Option<f64> {
    let axis = wheels.first()?.frame * Vector3::z();
    let ahead = axis.cross(&Vector3::z());
    let ahead = if ahead.dot(&(body * Vector3::x())) < -1e-6 { -ahead } else { ahead };
    (ahead.norm() > 0.5).then(|| ahead.y.atan2(ahead.x))
}

/// The rectangle around a body, in its robot's frame.
fn outline(frame: &Isometry3<f64>, form: &Form) -> Body {
    let half = form.size() / 2.0;
    let rotation = frame.rotation.to_rotation_matrix();
    let extent = |row: usize| -> f64 { (0..3).map(|axis| rotation[(row, axis)].abs() * half[axis]).sum() };
    Body { length: 2.0 * extent(0), width: 2.0 * extent(1) }
}

/// Returns the mount of a sensor, if it looks along the floor.
fn mount(objects: &Objects, handle: Handle, origin: &Isometry3<f64>) -> Option<Mount> {
    let PartKind::Sensor(sensor) = &objects.part(handle)?.kind else { return None };
    let frame = origin.inverse() * objects.rest_frame(handle)?;
    let direction = frame * Vector3::z();
    let (at, way) = (frame.translation.vector, Vector2::new(direction.x, direction.y));
    let mount = Mount {
        pose: Pose::new(at.x, at.y, way.y.atan2(way.x)),
        range: sensor.offset + sensor.range,
        cone: if sensor.subtype == info::SENSOR_RAY { 1e-3 } else { sensor.angle },
    };
    (way.norm() > 0.5 && mount.range > 0.0 && mount.cone > 0.0).then_some(mount)
}

fn add_obstacle(objects: &Objects, handle: Handle, shape: &ShapePart, found: &mut Recognized) {
    let Some(frame) = objects.rest_frame(handle).filter(|_| shape.is_respondable) else { return };
    if top_of(&frame, &shape.form) <= FLOOR {
        return;
    }
    let name = objects.alias(handle);
    for (pose, shape) in outlines(&frame, &shape.form) {
        if found.scene.obstacles.len() < MAX_OBSTACLES {
            found.roles.push((handle, Kind::Obstacle(found.scene.obstacles.len())));
            found.scene.obstacles.push(Obstacle::fixed(name.clone(), pose, shape));
        }
    }
}

/// Returns the height of a shape's top, metres.
pub(super) fn top_of(frame: &Isometry3<f64>, form: &Form) -> f64 {
    let (low, high) = form.bounds();
    let corner = |corner: usize| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        (frame * nalgebra::Point3::new(pick(0), pick(1), pick(2))).z
    };
    (0..8).map(corner).fold(f64::NEG_INFINITY, f64::max)
}

pub(super) fn outlines(frame: &Isometry3<f64>, form: &Form) -> Vec<(Pose, Shape)> {
    let at = frame.translation.vector;
    let ahead = frame * Vector3::x();
    let is_upright = (frame * Vector3::z()).z.abs() > 0.999;
    match form {
        Form::Primitive(kind, size) if is_upright || *kind == info::PRIMITIVE_SPHERE => {
            let pose = Pose::new(at.x, at.y, ahead.y.atan2(ahead.x));
            let is_round = [info::PRIMITIVE_CYLINDER, info::PRIMITIVE_SPHERE].contains(kind);
            let shape = if is_round {
                Shape::Cylinder { radius: size.x.max(size.y) / 2.0 }
            } else {
                Shape::Box(Body { length: size.x, width: size.y })
            };
            vec![(pose, shape)]
        }
        Form::Primitive(..) => vec![(Pose::new(at.x, at.y, 0.0), Shape::Box(outline(frame, form)))],
        Form::Mesh(triangles) => triangles
            .iter()
            .filter_map(|corners| {
                let corners = corners.map(|corner| {
                    let corner = frame * nalgebra::Point3::from(corner);
                    (corner.x, corner.y)
                });
                let [a, b, c] = corners;
                let area = (b.0 - a.0) * (c.1 - a.1) - (c.0 - a.0) * (b.1 - a.1);
                // The sides of a prism have no area from above, and its bottom faces down.
                (area > 1e-9).then(|| (Pose::default(), Shape::Polygon(corners.to_vec())))
            })
            .collect(),
    }
}

/// Switches the motors of the created robots: those whose joints do not follow velocities stand still.
pub(super) fn set_motors(objects: &Objects, world: &mut World) {
    for handle in objects.made() {
        let Some(PartKind::Joint(joint)) = objects.part(handle).map(|part| &part.kind) else { continue };
        if let Some(Kind::Wheel { robot, wheel }) = objects.role(handle) {
            world.set_controlled(robot, wheel, joint.follows_velocity());
        }
    }
}
