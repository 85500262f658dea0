//! Draws robots that deviate slightly from their plans: `cargo run -p pydslrep-picture --example picture -- 3`.

#![allow(clippy::print_stdout)]

use std::f64::consts::FRAC_PI_2;

use pydslrep_kinematics::{Drive, MotionPrimitive, Pose, TimedPose, plan_movement};
use pydslrep_picture::{Picture, Route};
use pydslrep_scene::{Robot, Scene, Wheel};
use pydslrep_trace::Map;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u32 = std::env::args().nth(1).map_or(Ok(1), |count| count.parse())?;
    let mut routes = Vec::new();
    let robots = (1..=count).map(|number| {
        let wheels = vec![Wheel::new("wheelL", 0.035), Wheel::new("wheelR", 0.035)];
        Robot::new(format!("robot_{number}"), Drive::TwoWheel, wheels, vec![])
    });
    for (number, robot) in (0..).zip(Scene::empty_floor(robots.collect()).robots) {
        let sign = if number % 2 == 0 { -1.0 } else { 1.0 };
        let forward = MotionPrimitive::Move { distance: 1.0 + 0.5 * f64::from(number), speed: 0.09 };
        let turn = MotionPrimitive::Turn { angle: sign * FRAC_PI_2, speed: 0.09 };
        let path = plan_movement(&robot.model()?, robot.start, &[forward, turn, forward, turn]);
        let planned = path.sample(100);
        let drift = |(i, TimedPose { time, pose }): (u32, &TimedPose)| {
            let off = 0.02 * (f64::from(i) / 40.0).sin();
            TimedPose { time: *time, pose: Pose::new(pose.x + off, pose.y - off / 2.0, pose.theta + off) }
        };
        let driven = (0..).zip(&planned).map(drift).collect();
        routes.push(Route {
            name: robot.name,
            body: robot.body,
            planned,
            unknown_after: false,
            possible: vec![],
            driven,
            seen: vec![],
            map: Map::default(),
        });
    }
    let title = "area_1: planned and driven paths";
    println!("{}", Picture { title, routes: &routes, obstacles: &[], collisions: &[] }.svg());
    Ok(())
}
