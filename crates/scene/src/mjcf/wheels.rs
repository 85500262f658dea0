//! A wheel: a cylinder that rolls, or a hub with rollers that turn freely.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use super::xml::Element;
use super::{FLOOR, FLOOR_NAME, OBSTACLE, SLIPPERY, UNSEEN, floor_friction};
use crate::{Robot, Scene, Wheel};

/// The inertia of a motor's rotor at the rim, kilograms. With less, motors swing.
const ROTOR: f64 = 0.5;

/// The drag of a wheel, newtons at the rim for each metre per second.
const DRAG: f64 = 0.5;

/// Kilograms.
const WHEEL_MASS: f64 = 0.2;
const HUB_MASS: f64 = 0.1;
const ROLLER_MASS: f64 = 0.012;

/// Of a mecanum wheel.
const ROLLERS: u32 = 9;

/// The distance of a roller's axis from the axle, as a share of the wheel's radius.
const ROLLER_AXIS: f64 = 0.73;

/// The inertia of a roller about its axis, kilograms, and what brakes it, newtons for each metre per second; both at the rim of
/// the wheel. They keep it from chattering, and are too small to drag.
const ROLLER_ROTOR: f64 = 0.001;
const ROLLER_DRAG: f64 = 0.01;

/// How tyres that scrub take friction: the time in which sliding ends, seconds, and its damping.
const TYRE_FRICTION: [f64; 2] = [0.1, 1.0];

/// How much of the floor's support they have at once and when they have sunk in so many metres, the last number.
const TYRE_SUPPORT: [f64; 3] = [0.1, 0.9, 0.0005];

/// From an axis along z to one along y.
const ALONG_Y: [f64; 4] = [FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0, 0.0];

/// Where a wheel is, and where scripts believe it to be.
pub(super) struct Mount {
    /// [`name`].
    pub(super) name: String,
    /// Metres ahead and to the left.
    pub(super) known: (f64, f64),
    pub(super) known_radius: f64,
    pub(super) place: (f64, f64),
    pub(super) radius: f64,
    /// Which way it pushes, [`pydslrep_kinematics::WheelPlace::push`].
    pub(super) push: f64,
}

/// What the body, the joint, the motor and the tyre of a wheel are called.
pub(super) fn name(robot: &Robot, wheel: &Wheel) -> String {
    format!("{}/{}", robot.name, wheel.name)
}

/// The body of a wheel, with its joint.
pub(super) fn wheel(robot: &Robot, mount: &Mount) -> Element {
    let (radius, inertia) = (mount.radius, mount.radius.powi(2));
    let known = [mount.known_radius, mount.known.0, mount.known.1, robot.motor_acceleration];
    let joint = Element::new("joint")
        .text("name", &mount.name)
        .numbers("axis", &[0.0, 1.0, 0.0])
        .numbers("armature", &[ROTOR * inertia])
        .numbers("damping", &[DRAG * inertia])
        .numbers("user", &known);
    let body = Element::new("body")
        .text("name", &mount.name)
        .numbers("pos", &[mount.place.0, mount.place.1, radius])
        .with([joint]);
    if robot.drive.row().mecanum {
        body.with([hub(radius)]).with((0..ROLLERS).map(|index| roller(radius, mount.push, index)))
    } else {
        body.with([tyre(mount, robot.wheel_width)])
    }
}

/// How the tyres of robots that scrub touch the floor: a default, and a pair for each wheel; both void without such robots.
///
/// In a contact of `MuJoCo`, what slides is also lifted: the stiffer friction is compared to the support, the higher. With its
/// defaults, wheels that slide sideways hop, and robots turn a third less than friction and their wheels make them. So friction
/// is softer here than the support, and wheels sink in by 0.4 mm. Only pairs can tell the two apart.
pub(super) fn contacts(scene: &Scene) -> (Element, Element) {
    let scrubbing = scene.robots.iter().filter(|robot| robot.drive.row().scrubs());
    let wheels = scrubbing.flat_map(|robot| robot.wheels.iter().map(|wheel| name(robot, wheel)));
    let pairs: Vec<Element> =
        wheels.map(|wheel| Element::new("pair").text("geom1", FLOOR_NAME).text("geom2", wheel)).collect();
    if pairs.is_empty() {
        return (Element::new("default"), Element::new("contact"));
    }
    let [sliding, spinning, rolling] = floor_friction(scene);
    let every = Element::new("pair")
        .text("condim", "4")
        .numbers("friction", &[sliding, sliding, spinning, rolling, rolling])
        .numbers("solreffriction", &TYRE_FRICTION)
        .numbers("solimp", &TYRE_SUPPORT);
    (Element::new("default").with([every]), Element::new("contact").with(pairs))
}

fn tyre(mount: &Mount, width: f64) -> Element {
    rolling(
        Element::new("geom")
            .text("name", &mount.name)
            .text("type", "cylinder")
            .numbers("size", &[mount.radius, width / 2.0])
            .numbers("quat", &ALONG_Y)
            .numbers("mass", &[WHEEL_MASS])
            .numbers("rgba", &[0.15, 0.15, 0.15, 1.0]),
    )
}

/// Makes a geom that rolls on the floor, and on nothing of its own robot: the rollers of a wheel would brake each
/// other, and `MuJoCo` lets those of one wheel collide.
fn rolling(geom: Element) -> Element {
    geom.text("contype", "0")
        .text("conaffinity", (FLOOR | OBSTACLE).to_string())
        .text("condim", "4")
        .numbers("friction", &SLIPPERY)
        .text("group", UNSEEN)
}

/// Makes a hub, on which rollers are mounted; it touches nothing.
fn hub(radius: f64) -> Element {
    Element::new("geom")
        .text("type", "cylinder")
        .numbers("size", &[radius * 0.3, radius * 0.3])
        .numbers("quat", &ALONG_Y)
        .numbers("mass", &[HUB_MASS])
        .text("contype", "0")
        .text("conaffinity", "0")
        .text("group", UNSEEN)
        .numbers("rgba", &[0.4, 0.4, 0.4, 1.0])
}

/// A roller: an ellipsoid whose axis leads, where it touches the floor, the way that the wheel pushes. It is as long as makes the
/// wheel round there.
fn roller(radius: f64, push: f64, index: u32) -> Element {
    let centre = ROLLER_AXIS * radius;
    let thickness = radius - centre;
    // The lowest point of an ellipsoid of these half axes, seen from the axle, is at the same distance to the second order of the
    // angle by which the wheel turns.
    let half = (2.0 * centre * thickness + thickness.powi(2)).sqrt();
    let (sin, cos) = (TAU * f64::from(index) / f64::from(ROLLERS)).sin_cos();
    let axis = [cos * FRAC_1_SQRT_2, push * FRAC_1_SQRT_2, -sin * FRAC_1_SQRT_2];
    let inertia = radius.powi(2);
    let joint = Element::new("joint")
        .numbers("axis", &axis)
        .numbers("armature", &[ROLLER_ROTOR * inertia])
        .numbers("damping", &[ROLLER_DRAG * inertia]);
    let geom = Element::new("geom")
        .text("type", "ellipsoid")
        .numbers("size", &[thickness, thickness, half])
        .numbers("zaxis", &axis)
        .numbers("mass", &[ROLLER_MASS])
        .numbers("rgba", &[0.15, 0.15, 0.15, 1.0]);
    Element::new("body").numbers("pos", &[-centre * sin, 0.0, -centre * cos]).with([joint, rolling(geom)])
}
