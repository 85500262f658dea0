//! A scene in MJCF, the format of `MuJoCo`'s worlds: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.
//!
//! Robots are bodies on wheels that roll on the floor by friction alone. What `python/pydslrep_runtime/mujoco_engine.py` has to
//! know of them besides is in the same file: `user` of a joint has its wheel's radius, the place of the wheel and the limit of
//! its acceleration as scripts know them, that of a site the range and the cone of its sensor, and custom numbers have the step,
//! the seed, noise, and the paths of obstacles that move.

mod obstacles;
mod robots;
mod view;
mod wheels;
mod xml;

use pydslrep_kinematics::{RobotPath, motion};

use self::obstacles::World;
use self::xml::Element;
use crate::Scene;

/// A step of the physics, seconds.
const TIME_STEP: f64 = 0.002;

/// The bits that say which things collide: in `contype`, and in `conaffinity` of the things that are stopped.
const FLOOR: u8 = 1;
const OBSTACLE: u8 = 2;
const HULL: u8 = 4;

/// The group of what sensors do not see: wheels, which are below the hulls.
const UNSEEN: &str = "1";

/// Friction of what is not the floor: sliding, about the normal, rolling; the last two in metres. The floor's is greater, and of
/// two the greater one counts, so that the floor alone decides how wheels roll.
const SLIPPERY: [f64; 3] = [0.0001, 0.0001, 0.0001];
const BODY_FRICTION: [f64; 3] = [0.3, 0.005, 0.0001];

const FLOOR_NAME: &str = "floor";

/// Friction of the floor, as that of others.
fn floor_friction(scene: &Scene) -> [f64; 3] {
    [scene.friction, 0.005, 0.0001]
}

/// The world of a scene for `MuJoCo`. When its viewer opens, the planned `paths` are in view; there may be none.
pub fn mjcf(scene: &Scene, paths: &[RobotPath]) -> String {
    let world = World::of(scene);
    let robots: Vec<_> = scene.robots.iter().map(|robot| robots::robot(robot, scene)).collect();
    let (bodies, motors): (Vec<Element>, Vec<Vec<Element>>) = robots.into_iter().unzip();
    let (defaults, contacts) = wheels::contacts(scene);
    let parts = [
        Element::new("compiler").text("angle", "radian"),
        Element::new("option")
            .numbers("timestep", &[TIME_STEP])
            // Others do not keep wheels from creeping, or motors from swinging.
            .text("integrator", "implicitfast")
            .text("cone", "elliptic")
            .numbers("impratio", &[10.0]),
        view::light(),
        view::view(scene, paths),
        Element::new("size").text("nuser_jnt", "4").text("nuser_site", "2"),
        Element::new("custom").with(numbers(scene)).with(world.paths),
        defaults,
        Element::new("asset").with(view::floor_material()).with(world.meshes),
        Element::new("worldbody").with([floor(scene)]).with(world.bodies).with(bodies),
        contacts,
        Element::new("actuator").with(motors.into_iter().flatten()),
    ];
    let parts = parts.into_iter().filter(|part| !part.is_void());
    let document = Element::new("mujoco").text("model", "pydslrep").with(parts);
    let mut text = format!("<!-- {MARK} -->\n");
    document.write(&mut text, 0);
    text
}

/// The first words of its files, by which they are known when they are written again (`output/src/kind.rs`).
const MARK: &str = "A world for MuJoCo, written by PyDSLRep";

fn floor(scene: &Scene) -> Element {
    Element::new("geom")
        .text("name", FLOOR_NAME)
        .text("type", "plane")
        .numbers("size", &[0.0, 0.0, 1.0])
        .text("contype", FLOOR.to_string())
        .text("conaffinity", "0")
        .numbers("friction", &floor_friction(scene))
        .text("material", view::FLOOR_MATERIAL)
}

/// Returns the numbers that do not belong to the physics.
fn numbers(scene: &Scene) -> Vec<Element> {
    #[expect(clippy::cast_precision_loss, reason = "seeds of files are below 2³²; of others, any will do")]
    let seed = scene.seed as f64;
    let mut all = vec![numeric("step", &[motion::STEP]), numeric("seed", &[seed])];
    all.extend(scene.noise.map(|noise| numeric("noise", &[noise.wheel_slip, noise.sensor])));
    all
}

fn numeric(name: impl Into<String>, data: &[f64]) -> Element {
    Element::new("numeric").text("name", name).numbers("data", data)
}

#[cfg(test)]
mod tests;
