//! Warnings of robots that moving obstacles of the embedded simulator have run into.

use std::collections::BTreeMap;

use pydslrep_scene::Scene;
use pydslrep_simulator::Strike;

use crate::report::numbers::fixed;
use crate::run::reporter::Reporter;

/// Warns of each robot that was struck, once for each obstacle that struck it.
pub(crate) fn report(reporter: &Reporter, scene: &Scene, strikes: &[Strike]) {
    for (text, help) in warnings(scene, strikes) {
        reporter.warn(&text, Some(&help));
    }
}

/// The warnings with advice, in the order of time.
fn warnings(scene: &Scene, strikes: &[Strike]) -> Vec<(String, String)> {
    let mut counts: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for strike in strikes {
        *counts.entry((strike.robot, strike.obstacle)).or_default() += 1;
    }
    let firsts = strikes.iter().filter_map(|strike| {
        let more = counts.remove(&(strike.robot, strike.obstacle))? - 1;
        let (robot, obstacle) = (scene.robots.get(strike.robot)?, scene.obstacles.get(strike.obstacle)?);
        Some(warning(strike, &robot.name, &obstacle.name, more))
    });
    firsts.collect()
}

fn warning(strike: &Strike, robot: &str, obstacle: &str, more: usize) -> (String, String) {
    let doing = if strike.was_driving { "drove" } else { "stood still" };
    let (time, x, y) = (fixed(strike.time, 1), fixed(strike.pose.x, 2), fixed(strike.pose.y, 2));
    let again = match more {
        0 => String::new(),
        1 => ", and once more later".to_owned(),
        more => format!(", and {more} times more later"),
    };
    let text = format!(
        "`{obstacle}` ran into `{robot}` after {time} s, where it {doing} at x {x} m, y {y} m{again}"
    );
    (text, format!("keep `{robot}` out of its way, or change the `path` of `{obstacle}` in the scene"))
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::{Drive, Pose};
    use pydslrep_scene::{Obstacle, Robot};

    use super::*;

    #[test]
    fn each_robot_is_named_once_for_each_obstacle() {
        let robot = |name: &str| Robot::new(name, Drive::TwoWheel, vec![], vec![]);
        let wall = |name: &str| Obstacle::wall(name, (0.0, 0.0), (1.0, 0.0), 0.1);
        let obstacles = vec![wall("person"), wall("cart")];
        let scene = Scene { robots: vec![robot("guard"), robot("rover")], obstacles, ..Scene::default() };
        let strike = |time, robot, obstacle, was_driving| Strike {
            time,
            robot,
            pose: Pose::new(2.0, -0.001, 0.0),
            obstacle,
            was_driving,
        };
        let strikes = [
            strike(31.25, 0, 0, false),
            strike(40.0, 1, 0, true),
            strike(50.0, 0, 0, true),
            strike(51.0, 0, 1, false),
            strike(60.0, 0, 0, false),
        ];
        let texts: Vec<String> = warnings(&scene, &strikes).into_iter().map(|(text, _)| text).collect();
        assert_eq!(
            texts,
            [
                "`person` ran into `guard` after 31.2 s, where it stood still at x 2.00 m, y 0.00 m, and 2 times more later",
                "`person` ran into `rover` after 40.0 s, where it drove at x 2.00 m, y 0.00 m",
                "`cart` ran into `guard` after 51.0 s, where it stood still at x 2.00 m, y 0.00 m",
            ]
        );
        assert_eq!(warnings(&scene, &[strike(1.0, 7, 0, false)]), []);
    }
}
