//! Bytes as settings and as scenes.

use pydslrep_config::Config;
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Robot, Scene, SensorKind, Wheel, problems, read};
use pydslrep_schema::Problem;
use pydslrep_simulator::World;

fn lies_in(problem: &Problem, text: &str) -> bool {
    problem.span.is_none_or(|span| span.end as usize <= text.len())
}

/// Reads settings.
pub(crate) fn settings(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let (_, found) = Config::from_toml(&text);
    assert!(found.iter().all(|problem| lies_in(problem, &text)), "a problem after the end");
}

/// Reads a scene, and simulates it for a second if it can be simulated.
pub(crate) fn scene(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let wheels = vec![Wheel::new("l", 0.04), Wheel::new("r", 0.04)];
    let sensors = vec![("s".to_owned(), SensorKind::Distance)];
    let robot = Robot::new("rover".to_owned(), Drive::TwoWheel, wheels, sensors);
    assert!(problems(&text).iter().all(|problem| lies_in(problem, &text)), "a problem after the end");
    let (scene, _) = read(&text, Scene::empty_floor(vec![robot]));
    if let Ok(mut world) = World::new(scene) {
        world.set_target(0, 0, 1.0);
        for _ in 0..20 {
            world.step();
        }
        let pose = world.pose(0);
        assert!(pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite(), "the robot is nowhere");
    }
}
