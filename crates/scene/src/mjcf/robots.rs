//! A robot: its hull, casters, sensors, wheels and motors. Its origin is on the floor, below the middle of its wheels.

use std::collections::HashSet;

use super::obstacles::yaw;
use super::wheels::{self, Mount};
use super::xml::Element;
use super::{BODY_FRICTION, FLOOR, HULL, OBSTACLE, SLIPPERY, UNSEEN};
use crate::{Robot, Scene};

/// Kilograms.
const MASS: f64 = 4.0;

/// Metres between the floor and the hull.
const CLEARANCE: f64 = 0.02;

/// Metres.
const HULL_HEIGHT: f64 = 0.1;

/// The greatest radius of a caster, metres, and how far it is from the end of the hull.
const CASTER: f64 = 0.015;
const CASTER_INSET: f64 = 0.03;

/// The greatest force of a motor at the wheel's rim, newtons.
const MOTOR_FORCE: f64 = 90.0;

/// The body of a robot, and its motors.
pub(super) fn robot(robot: &Robot, scene: &Scene) -> (Element, Vec<Element>) {
    let mounts = mounts(robot, scene);
    let start = robot.start;
    let body = Element::new("body")
        .text("name", &robot.name)
        .numbers("pos", &[start.x, start.y, 0.0])
        .numbers("quat", &yaw(start.theta))
        .with([Element::new("freejoint"), hull(robot, scene.collisions)])
        .with(casters(robot))
        .with(sensors(robot))
        .with(mounts.iter().map(|mount| wheels::wheel(robot, mount)));
    (body, mounts.iter().map(|mount| motor(robot, mount)).collect())
}

/// Its wheels as they are, which scripts may not know.
fn mounts(robot: &Robot, scene: &Scene) -> Vec<Mount> {
    let noise = scene.noise;
    let (wider, larger) = noise.map_or((0.0, 0.0), |noise| (noise.track_error, noise.radius_error));
    let places = robot.drive.row().wheels;
    let positions = robot.geometry.wheel_positions(robot.drive);
    let wheels = robot.wheels.iter().zip(places).zip(positions);
    wheels
        .map(|((wheel, place), known)| Mount {
            name: wheels::name(robot, wheel),
            known,
            known_radius: wheel.radius,
            place: (known.0, known.1 * (1.0 + wider)),
            radius: wheel.radius * (1.0 + larger),
            push: place.push,
        })
        .collect()
}

fn least_radius(robot: &Robot) -> f64 {
    robot.wheels.iter().map(|wheel| wheel.radius).fold(f64::INFINITY, f64::min)
}

/// Returns the height of the hull's middle and of the sensors; metres.
fn middle(robot: &Robot) -> f64 {
    CLEARANCE.min(least_radius(robot) / 2.0) + HULL_HEIGHT / 2.0
}

fn hull(robot: &Robot, is_solid: bool) -> Element {
    let (length, width) = (robot.body.length, robot.body.width);
    let stopped_by = FLOOR | OBSTACLE | HULL;
    Element::new("geom")
        .text("type", "box")
        .numbers("size", &[length / 2.0, width / 2.0, HULL_HEIGHT / 2.0])
        .numbers("pos", &[0.0, 0.0, middle(robot)])
        .numbers("mass", &[MASS])
        .text("contype", if is_solid { HULL } else { 0 }.to_string())
        .text("conaffinity", stopped_by.to_string())
        .numbers("friction", &BODY_FRICTION)
        .numbers("rgba", &[0.2, 0.45, 0.7, 0.6])
}

/// Returns the casters that support a robot with one axle, ahead and behind.
fn casters(robot: &Robot) -> Vec<Element> {
    if robot.drive.row().has_wheelbase() {
        return Vec::new();
    }
    let radius = CASTER.min(least_radius(robot));
    let away = (robot.body.length / 2.0 - CASTER_INSET).max(robot.body.length / 4.0);
    let caster = |x: f64| {
        Element::new("geom")
            .text("type", "sphere")
            .numbers("size", &[radius])
            .numbers("pos", &[x, 0.0, radius])
            .numbers("mass", &[0.05])
            .text("contype", "0")
            .text("conaffinity", (FLOOR | OBSTACLE).to_string())
            // The floor's friction is not for it.
            .text("priority", "1")
            .numbers("friction", &SLIPPERY)
            .text("group", UNSEEN)
            .numbers("rgba", &[0.3, 0.3, 0.3, 1.0])
    };
    [away, -away].map(caster).to_vec()
}

/// Sites that face where its sensors do; one where a sensor and a bumper have one name.
fn sensors(robot: &Robot) -> Vec<Element> {
    let mut names = HashSet::new();
    let sensors = robot.sensors.iter().filter(|sensor| names.insert(&sensor.name));
    let site = |sensor: &crate::Sensor| {
        let mount = sensor.mount;
        Element::new("site")
            .text("name", format!("{}/{}", robot.name, sensor.name))
            .numbers("pos", &[mount.pose.x, mount.pose.y, middle(robot)])
            .numbers("quat", &yaw(mount.pose.theta))
            .numbers("user", &[mount.range, mount.cone])
    };
    sensors.map(site).collect()
}

/// Returns a motor that holds the rate it is set to.
fn motor(robot: &Robot, mount: &Mount) -> Element {
    let motor = Element::new("velocity")
        .text("name", &mount.name)
        .text("joint", &mount.name)
        .numbers("gear", &[1.0])
        .numbers("kv", &[robot.motor_gain * mount.radius.powi(2)])
        .numbers("forcerange", &[-MOTOR_FORCE * mount.radius, MOTOR_FORCE * mount.radius]);
    if robot.motor_speed.is_finite() {
        let fastest = robot.motor_speed / mount.known_radius;
        motor.numbers("ctrlrange", &[-fastest, fastest])
    } else {
        motor
    }
}
