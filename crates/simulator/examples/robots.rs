//! Simulates two-wheel robots `robot_1`, `robot_2`, … on an empty floor, to test scripts with:
//! `cargo run -p pydslrep-simulator --example robots -- 2` prints one port per robot and runs until its standard input
//! is closed.

#![allow(clippy::print_stdout)]

use std::io::Read;

use pydslrep_kinematics::Drive;
use pydslrep_scene::{Robot, Scene, SensorKind, Wheel};
use pydslrep_simulator::{Options, Simulator};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: usize = std::env::args().nth(1).map_or(Ok(1), |count| count.parse())?;
    let robot = |number| {
        let wheels = vec![Wheel::new("wheelL", 0.035), Wheel::new("wheelR", 0.035)];
        let sensors = vec![("fSensor".to_owned(), SensorKind::Distance)];
        Robot::new(format!("robot_{number}"), Drive::TwoWheel, wheels, sensors)
    };
    let scene = Scene::empty_floor((1..=count).map(robot).collect());
    let options = Options { ports: vec![0; count], ..Options::default() };
    let simulator = Simulator::start(scene, &options)?;
    println!("{:?}", simulator.ports());
    std::io::stdin().read_to_end(&mut Vec::new())?;
    println!("{} trace records, {:.2} s", simulator.take_trace().len(), simulator.time());
    Ok(())
}
