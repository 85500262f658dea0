use pydslrep_kinematics::Drive;
use pydslrep_scene::{Noise, Obstacle, Robot, SceneObject, Shape, Trajectory, Waypoint, Wheel};

use super::*;

fn world(drive: Drive) -> World {
    let wheels = (0..drive.wheel_count()).map(|i| Wheel::new(format!("w{i}"), 0.05)).collect();
    World::new(Scene::empty_floor(vec![Robot::new("r", drive, wheels, vec![])])).unwrap()
}

#[test]
fn motors_reach_their_target_at_their_acceleration() {
    let mut world = world(Drive::TwoWheel);
    for wheel in 0..2 {
        world.set_target(0, wheel, 4.0); // rim 0.2 m/s at 1 m/s²: 0.2 s, 20 mm
    }
    let rates: Vec<f64> = (0..6)
        .map(|_| {
            world.step();
            (world.rate(0, 0) * 1e9).round() / 1e9
        })
        .collect();
    assert_eq!(rates, [1.0, 2.0, 3.0, 4.0, 4.0, 4.0]);
    assert!((world.pose(0).x - (0.02 + 0.02)).abs() < 1e-12, "{:?}", world.pose(0));
    assert!((world.angle(0, 0) * 0.05 - world.pose(0).x).abs() < 1e-12);
    assert!((world.time() - 0.3).abs() < 1e-12);
}

#[test]
fn a_step_has_a_length() {
    let mut world = world(Drive::TwoWheel);
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e308, 10.1] {
        let error = world.set_step_length(step).unwrap_err().to_string();
        assert!(error.len() < 100, "{error}");
    }
    world.set_step_length(0.1).unwrap();
    world.step();
    assert!((world.time() - 0.1).abs() < 1e-12);
}

#[test]
fn turns_on_the_spot_to_the_left() {
    let mut world = world(Drive::TwoWheel);
    world.set_target(0, 0, -1.0);
    world.set_target(0, 1, 1.0);
    for _ in 0..20 {
        world.step();
    }
    let pose = world.pose(0);
    let rim = 0.05 * (1.0 - 0.025); // a quarter of a tenth of a second is lost in the ramp
    assert!(pose.distance(&Pose::default()) < 1e-12 && (pose.theta - rim / 0.15).abs() < 1e-12, "{pose:?}");
}

#[test]
fn mecanum_wheels_drive_sideways() {
    let mut world = world(Drive::Mecanum);
    for (wheel, rate) in [-1.0, 1.0, 1.0, -1.0].into_iter().enumerate() {
        world.set_target(0, wheel, rate);
    }
    world.step();
    let (pose, twist) = (world.pose(0), world.twist(0));
    assert!(
        pose.y > 0.0 && pose.x.abs() < 1e-12 && (twist.vy - 0.05 * 0.95 / 1.05).abs() < 1e-12,
        "{pose:?} {twist:?}"
    );
}

#[test]
fn skid_steered_wheels_scrub() {
    let mut world = world(Drive::FourWheel);
    for (wheel, rate) in [-1.0, -1.0, 1.0, 1.0].into_iter().enumerate() {
        world.set_target(0, wheel, rate);
    }
    world.step();
    world.step();
    let ideal = 0.05 / 0.15;
    assert!((world.twist(0).omega - ideal / (1.0 + (0.25_f64 / 0.30).powi(2))).abs() < 1e-12);
}

#[test]
fn a_released_wheel_brakes_and_ignores_its_target() {
    let mut world = world(Drive::TwoWheel);
    world.set_target(0, 0, 1.0);
    world.step();
    assert!(world.rate(0, 0) > 0.0);
    world.set_controlled(0, 0, false);
    world.step();
    world.set_target(0, 0, 3.0);
    world.step();
    assert!(world.rate(0, 0) == 0.0 && !world.is_controlled(0, 0));
}

#[test]
fn reset_restores_the_world_and_park_keeps_the_time() {
    let mut world = world(Drive::TwoWheel);
    let fresh: Vec<_> = world.records().collect();
    world.set_target(0, 1, 2.0);
    world.step();
    world.set_target(0, 0, f64::NAN);
    assert!(world.target(0, 0) == 0.0);
    world.park();
    assert!(world.pose(0) == Pose::default() && world.time() > 0.0 && world.target(0, 1) == 0.0);
    world.reset();
    assert_eq!(world.records().collect::<Vec<_>>(), fresh);
}

#[test]
fn errors_name_the_robot_that_cannot_drive() {
    let mut robot = Robot::new("r", Drive::TwoWheel, vec![Wheel::new("w", 0.05)], vec![]);
    let error = World::new(Scene::empty_floor(vec![robot.clone()])).unwrap_err();
    let want = "robot `r` cannot drive: this layout has 2 wheels, but 1 wheel radii are given";
    assert_eq!(error.to_string(), want);
    robot.wheels.push(Wheel::new("v", 0.05));
    robot.motor_acceleration = 0.0;
    assert!(World::new(Scene::empty_floor(vec![robot])).is_err());
    assert!(World::with_step(Scene::default(), f64::NAN).is_err());
}

fn drive(world: &mut World, robot: usize, rates: [f64; 2]) {
    for (wheel, rate) in rates.into_iter().enumerate() {
        world.set_target(robot, wheel, rate);
    }
}

fn robot(name: &str, x: f64, y: f64, theta: f64) -> Robot {
    let wheels = vec![Wheel::new("l", 0.05), Wheel::new("r", 0.05)];
    let sensors = vec![("front".to_owned(), SensorKind::Distance), ("bump".to_owned(), SensorKind::Bumper)];
    let mut robot = Robot::new(name, Drive::TwoWheel, wheels, sensors);
    robot.start = Pose::new(x, y, theta);
    robot
}

#[test]
fn a_wall_stops_a_robot_but_does_not_hold_it() {
    let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
    let scene = Scene { robots: vec![robot("r", 0.0, 0.0, 0.0)], obstacles: vec![wall], ..Scene::default() };
    let mut world = World::new(scene.clone()).unwrap();
    drive(&mut world, 0, [10.0, 10.0]);
    for _ in 0..100 {
        world.step();
    }
    let pose = world.pose(0);
    assert!((pose.x - 0.8).abs() < 0.002 && pose.y.abs() < 1e-9, "{pose:?}");
    assert!(
        world.twist(0) == Twist::default() && (world.rate(0, 0) - 10.0).abs() < 1e-12,
        "its wheels still turn"
    );
    drive(&mut world, 0, [-10.0, -10.0]);
    for _ in 0..100 {
        world.step();
    }
    assert!(world.pose(0).x < 0.0, "{:?}", world.pose(0));
    let mut ghost = World::new(Scene { collisions: false, ..scene }).unwrap();
    drive(&mut ghost, 0, [10.0, 10.0]);
    for _ in 0..100 {
        ghost.step();
    }
    assert!(ghost.pose(0).x > 2.0);
}

/// A world with a robot at the origin, heading along x, and a person of 40 cm who walks.
fn with_person(rows: &[[f64; 3]], repeats: bool) -> World {
    let points = rows.iter().map(|&[time, x, y]| Waypoint { time, x, y }).collect();
    let trajectory = Trajectory::new(points, repeats).unwrap();
    let person = Obstacle::moving("person", 0.0, Shape::Cylinder { radius: 0.2 }, trajectory);
    let robots = vec![robot("r", 0.0, 0.0, 0.0)];
    World::new(Scene { robots, obstacles: vec![person], ..Scene::default() }).unwrap()
}

fn run(world: &mut World, seconds: f64) {
    let end = world.time() + seconds - world.step_length() / 2.0;
    while world.time() < end {
        world.step();
    }
}

#[test]
fn sensors_see_an_obstacle_where_it_is_at_the_time() {
    let mut world = with_person(&[[0.0, 0.9, 0.0], [2.0, 0.9, 0.0], [4.0, 0.9, 2.0]], true);
    let seen = |world: &World| world.sight(0, 0).map(|seen| (seen.distance * 1e6).round() / 1e6);
    assert_eq!(seen(&world), Some(0.55));
    run(&mut world, 3.0);
    assert_eq!((seen(&world), world.obstacle_pose(0)), (None, Some(Pose::new(0.9, 1.0, 0.0))));
    run(&mut world, 3.0);
    assert_eq!(seen(&world), Some(0.55), "it has come back");
    run(&mut world, 5.0);
    assert_eq!(seen(&world), None);
    world.park();
    assert_eq!((seen(&world), world.obstacle_pose(0)), (Some(0.55), Some(Pose::new(0.9, 0.0, 0.0))));
    assert_eq!(world.obstacle_pose(1), None);
}

#[test]
fn a_robot_that_waits_is_struck_but_not_pushed() {
    let mut world = with_person(&[[0.0, 2.0, 0.0], [10.0, -2.0, 0.0]], false);
    run(&mut world, 4.0);
    assert_eq!((world.strikes().len(), world.pose(0)), (0, Pose::default()));
    run(&mut world, 1.0);
    let [strike] = world.strikes() else { panic!("{:?}", world.strikes()) };
    assert!((strike.time - 1.65 / 0.4).abs() < 0.01, "{strike:?}");
    assert_eq!((strike.robot, strike.obstacle, strike.was_driving), (0, 0, false));
    drive(&mut world, 0, [2.0, 2.0]);
    run(&mut world, 0.5);
    assert_eq!((world.pose(0), world.twist(0)), (Pose::default(), Twist::default()), "it is covered");
    run(&mut world, 4.0);
    assert!(world.pose(0).x > 0.1 && world.strikes().len() == 1, "it goes on: {:?}", world.pose(0));
    world.reset();
    assert_eq!(world.strikes(), []);
}

#[test]
fn a_robot_that_drives_and_is_struck_stays_until_its_wheels_stop() {
    // The person crosses the way within half a second.
    let mut world = with_person(&[[2.0, 0.5, 1.0], [3.0, 0.5, -3.0]], false);
    drive(&mut world, 0, [4.0, 4.0]);
    run(&mut world, 10.0);
    let [strike] = *world.strikes() else { panic!("{:?}", world.strikes()) };
    assert!(strike.was_driving && strike.time > 2.0 && strike.time < 3.0, "{strike:?}");
    assert_eq!((world.pose(0), world.twist(0)), (strike.pose, Twist::default()));
    assert!(world.angle(0, 0) * 0.05 > 1.8, "its wheels turn");
    drive(&mut world, 0, [0.0, 0.0]);
    run(&mut world, 1.0);
    drive(&mut world, 0, [4.0, 4.0]);
    run(&mut world, 1.0);
    assert!(world.pose(0).x > strike.pose.x + 0.1, "{:?}", world.pose(0));
}

#[test]
fn a_robot_that_drives_into_an_obstacle_is_blocked_until_it_has_left() {
    let mut world = with_person(&[[0.0, 1.0, 0.05], [10.0, 1.0, -0.05], [12.0, 1.0, -3.0]], false);
    drive(&mut world, 0, [10.0, 10.0]);
    run(&mut world, 5.0);
    let reached = world.pose(0).x;
    assert!(reached > 0.6 && reached < 0.66 && world.strikes().is_empty(), "{reached}");
    run(&mut world, 15.0);
    assert!(world.pose(0).x > 2.0, "{:?} {:?}", world.pose(0), world.strikes());
}

#[test]
fn nothing_is_struck_where_nothing_collides() {
    let mut scene = with_person(&[[0.0, 2.0, 0.0], [10.0, -2.0, 0.0]], false).scene().clone();
    scene.collisions = false;
    let mut world = World::new(scene).unwrap();
    drive(&mut world, 0, [1.0, 1.0]);
    run(&mut world, 10.0);
    assert!(world.strikes().is_empty() && (world.pose(0).x - 0.5).abs() < 0.01, "{:?}", world.pose(0));
    assert_eq!(world.obstacle_pose(0), Some(Pose::new(-2.0, 0.0, 0.0)));
}

#[test]
fn worlds_with_moving_obstacles_repeat() {
    let trace = || {
        let mut scene = with_person(&[[0.5, 2.0, 0.3], [9.0, -2.0, -0.1]], true).scene().clone();
        scene.noise = Some(Noise::default());
        let mut world = World::new(scene).unwrap();
        drive(&mut world, 0, [1.0, 1.2]);
        let mut trace = Vec::new();
        for _ in 0..400 {
            world.step();
            trace.push((world.pose(0), world.sight(0, 0), world.obstacle_pose(0)));
        }
        (trace, world.strikes().to_vec())
    };
    let first = trace();
    assert!(!first.1.is_empty());
    assert_eq!(trace(), first);
}

#[test]
fn robots_stop_each_other() {
    let robots = vec![robot("a", 0.0, 0.0, 0.0), robot("b", 1.0, 0.05, std::f64::consts::PI)];
    let mut world = World::new(Scene { robots, ..Scene::default() }).unwrap();
    drive(&mut world, 0, [6.0, 6.0]);
    drive(&mut world, 1, [6.0, 6.0]);
    for _ in 0..100 {
        world.step();
    }
    let (a, b) = (world.pose(0), world.pose(1));
    assert!(b.x - a.x > 0.3 && b.x - a.x < 0.303 && (a.x - 0.35).abs() < 0.01, "{a:?} {b:?}");
}

#[test]
fn sensors_detect_walls_and_other_robots() {
    let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
    let robots = vec![robot("a", 0.0, 0.0, 0.0), robot("b", 0.0, 3.0, 0.0), robot("c", 0.5, 3.0, 0.0)];
    let world = World::new(Scene { robots, obstacles: vec![wall], ..Scene::default() }).unwrap();
    let seen = world.sight(0, 0).unwrap();
    assert!((seen.distance - 0.8).abs() < 1e-9 && seen.object == SceneObject::Obstacle(0), "{seen:?}");
    assert_eq!(world.sight(0, 1), None, "out of range of a bumper");
    let seen = world.sight(1, 0).unwrap();
    assert!((seen.distance - 0.2).abs() < 1e-9 && seen.object == SceneObject::Robot(2), "{seen:?}");
    assert_eq!((world.sight(2, 0), world.sight(9, 0), world.sight(0, 9)), (None, None, None));
}

#[test]
fn wheels_do_not_tell_that_track_and_radii_are_others() {
    let end = |left: f64, track_error: f64, radius_error: f64| {
        let mut scene = world(Drive::TwoWheel).scene().clone();
        scene.noise = Some(Noise { wheel_slip: 0.0, track_error, radius_error, sensor: 0.0 });
        let mut world = World::new(scene).unwrap();
        drive(&mut world, 0, [left, 2.0]);
        run(&mut world, 2.0);
        (world.pose(0), vec![world.angle(0, 0), world.angle(0, 1)])
    };
    for left in [2.0, -2.0] {
        let (exact, angles) = end(left, 0.0, 0.0);
        assert!(exact.x > 0.1 || exact.theta > 0.5, "{exact:?}");
        for (track_error, radius_error) in [(0.02, 0.0), (0.0, 0.02), (0.05, -0.03)] {
            let (there, seen) = end(left, track_error, radius_error);
            assert_eq!(seen, angles);
            let (way, turn) = (1.0 + radius_error, (1.0 + radius_error) / (1.0 + track_error));
            assert!((there.x - way * exact.x).abs() < 1e-9, "{there:?}");
            assert!((there.theta - turn * exact.theta).abs() < 1e-9, "{there:?}");
        }
    }
}

#[test]
fn noise_depends_only_on_the_seed() {
    let wall = Obstacle::wall("w", (9.0, -1.0), (9.0, 1.0), 0.1);
    let run = |seed, noise, reads: bool| {
        let mut a = robot("a", 0.0, 0.0, 0.0);
        a.sensors[0].mount.range = 20.0;
        let mut world = World::new(Scene {
            robots: vec![a],
            obstacles: vec![wall.clone()],
            noise,
            seed,
            ..Scene::default()
        })
        .unwrap();
        let mut first = None;
        for _ in 0..2 {
            drive(&mut world, 0, [2.0, 2.0]);
            for _ in 0..200 {
                world.step();
                if reads {
                    world.sight(0, 0);
                }
            }
            let end = (world.pose(0), world.sight(0, 0).unwrap().distance);
            assert_eq!(*first.get_or_insert(end), end, "a second run equals the first");
            world.reset();
        }
        first.unwrap()
    };
    let noise = Some(Noise::default());
    assert_eq!(run(1, noise, false), run(1, noise, true));
    assert_ne!(run(1, noise, false), run(2, noise, false));
    let (pose, reading) = run(1, noise, false);
    let off = pose.relative(&run(1, None, false).0);
    assert!(off.y.abs() > 1e-4 && off.y.abs() < 0.2 && off.x.abs() < 0.05, "{off:?}");
    assert!((reading - (9.0 - 0.05 - 0.15 - pose.x)).abs() < 0.05, "{reading}");
}

#[test]
fn the_slip_of_wheels_changes_within_a_second() {
    let mut scene = Scene::empty_floor(vec![robot("a", 0.0, 0.0, 0.0)]);
    scene.noise = Some(Noise::default());
    let mut world = World::new(scene).unwrap();
    let slips: Vec<f64> = (0..4000)
        .map(|_| {
            world.step();
            world.robots[0].joints[0].slip.value
        })
        .collect();
    let product = |after: usize| -> f64 { slips.iter().zip(&slips[after..]).map(|(a, b)| a * b).sum() };
    // In theory 0.37 of a value is left after a second, which is 20 steps.
    let left = product(20) / product(0);
    assert!((0.15..0.6).contains(&left), "{left}");
}

#[test]
fn noise_takes_no_reading_beyond_the_range() {
    let wall = Obstacle::wall("w", (1.2, -1.0), (1.2, 1.0), 0.1);
    let robots = vec![robot("a", 0.0, 0.0, 0.0)];
    let noise = Some(Noise::default());
    let mut world = World::new(Scene { robots, obstacles: vec![wall], noise, ..Scene::default() }).unwrap();
    let readings: Vec<Option<f64>> = (0..100)
        .map(|_| {
            world.step();
            world.sight(0, 0).map(|seen| seen.distance)
        })
        .collect();
    // The wall is exactly at the end of the range: about half of the readings would be beyond it.
    assert!(readings.iter().flatten().all(|distance| *distance <= 1.0), "{readings:?}");
    let seen = readings.iter().flatten().count();
    assert!((30..70).contains(&seen), "{seen}");
}

#[test]
fn motors_have_a_top_speed() {
    let mut slow = robot("r", 0.0, 0.0, 0.0);
    slow.motor_speed = 0.2;
    let mut world = World::new(Scene { robots: vec![slow], ..Scene::default() }).unwrap();
    drive(&mut world, 0, [-100.0, 100.0]);
    for _ in 0..20 {
        world.step();
    }
    assert!((world.rate(0, 0) + 4.0).abs() < 1e-12 && (world.rate(0, 1) - 4.0).abs() < 1e-12);
}
