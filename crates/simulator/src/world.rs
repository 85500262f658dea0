//! Robots on a floor, moved by their wheels in fixed steps of simulation time.

use std::fmt;

use pydslrep_kinematics::{Model, ModelError, Pose, Twist, motion};
use pydslrep_scene::Scene;

use crate::TraceRecord;

/// Motors and motion are integrated this many times per step, as CoppeliaSim does (5 ms in a step of 50 ms).
const SUBSTEPS: u32 = 10;

/// A scene in motion. Rates here are rolling rates: positive rolls the robot forward, whatever way the wheel's
/// joint is mounted.
#[derive(Debug, Clone)]
pub struct World {
    scene: Scene,
    robots: Vec<Moving>,
    step: f64,
    steps: u64,
}

#[derive(Debug, Clone)]
struct Moving {
    model: Model,
    pose: Pose,
    twist: Twist,
    joints: Vec<Joint>,
}

#[derive(Debug, Clone, Default)]
struct Joint {
    target: f64,
    rate: f64,
    angle: f64,
    released: bool,
}

/// Why a scene cannot move.
#[derive(Debug, Clone, PartialEq)]
pub enum WorldError {
    /// A robot has no kinematic model.
    Model {
        /// Its name.
        robot: String,
        /// Why.
        error: ModelError,
    },
    /// A robot's motors cannot change their rate.
    Motor {
        /// Its name.
        robot: String,
    },
    /// The step is not a time above zero.
    Step {
        /// Seconds.
        step: f64,
    },
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model { robot, error } => write!(f, "robot `{robot}` cannot drive: {error}"),
            Self::Motor { robot } => {
                write!(f, "robot `{robot}` cannot drive: the acceleration of its motors must be above zero")
            }
            Self::Step { step } => write!(f, "the simulation step must be above zero, it is {step} s"),
        }
    }
}

impl std::error::Error for WorldError {}

impl World {
    /// The scene at rest, with the default step of [`motion::STEP`].
    ///
    /// # Errors
    /// When a robot's figures allow no motion.
    pub fn new(scene: Scene) -> Result<Self, WorldError> {
        Self::with_step(scene, motion::STEP)
    }

    /// The scene at rest, stepped by `step` seconds.
    ///
    /// # Errors
    /// When a robot's figures allow no motion or the step is not above zero.
    pub fn with_step(scene: Scene, step: f64) -> Result<Self, WorldError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(WorldError::Step { step });
        }
        let robots = scene.robots.iter().map(at_rest).collect::<Result<_, _>>()?;
        Ok(Self { scene, robots, step, steps: 0 })
    }

    /// What the world was made from.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Length of a step, seconds.
    pub fn step_length(&self) -> f64 {
        self.step
    }

    /// Simulation time, seconds.
    pub fn time(&self) -> f64 {
        #[allow(clippy::cast_precision_loss)] // exact for the first 10 million years
        let steps = self.steps as f64;
        steps * self.step
    }

    /// Steps taken since the last [`World::reset`].
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Everything back to where the scene has it, at time 0 and at rest.
    pub fn reset(&mut self) {
        self.steps = 0;
        self.park();
    }

    /// Robots back to their starts and at rest; the time stays.
    pub fn park(&mut self) {
        for (moving, robot) in self.robots.iter_mut().zip(&self.scene.robots) {
            moving.pose = robot.start;
            moving.twist = Twist::default();
            for joint in &mut moving.joints {
                *joint = Joint { released: joint.released, ..Joint::default() };
            }
        }
    }

    /// Where a robot is; the origin when there is no such robot.
    pub fn pose(&self, robot: usize) -> Pose {
        self.robots.get(robot).map_or_else(Pose::default, |robot| robot.pose)
    }

    /// How a robot moves in its own frame; at rest when there is no such robot.
    pub fn twist(&self, robot: usize) -> Twist {
        self.robots.get(robot).map_or_else(Twist::default, |robot| robot.twist)
    }

    /// The rate of a wheel, rad/s.
    pub fn rate(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.rate)
    }

    /// The angle a wheel has rolled since the start, radians, not wrapped.
    pub fn angle(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.angle)
    }

    /// The rate a wheel is asked for, rad/s.
    pub fn target(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.target)
    }

    /// Asks a wheel for a rate in rad/s; its motor gets there as fast as it can. What is not finite is ignored.
    pub fn set_target(&mut self, robot: usize, wheel: usize, rate: f64) {
        if let Some(joint) = self.joint_mut(robot, wheel).filter(|_| rate.is_finite()) {
            joint.target = rate;
        }
    }

    /// Whether a wheel's motor follows its target (velocity control); otherwise it brakes to a stop.
    pub fn is_controlled(&self, robot: usize, wheel: usize) -> bool {
        self.joint(robot, wheel).is_some_and(|joint| !joint.released)
    }

    /// Switches velocity control of a wheel on or off.
    pub fn set_controlled(&mut self, robot: usize, wheel: usize, controlled: bool) {
        if let Some(joint) = self.joint_mut(robot, wheel) {
            joint.released = !controlled;
        }
    }

    /// One step of simulation time for everybody.
    pub fn step(&mut self) {
        let seconds = self.step / f64::from(SUBSTEPS);
        for (moving, robot) in self.robots.iter_mut().zip(&self.scene.robots) {
            for _ in 0..SUBSTEPS {
                moving.advance(robot.motor_acceleration, seconds);
            }
        }
        self.steps += 1;
    }

    /// All robots as they are now.
    pub fn records(&self) -> impl Iterator<Item = TraceRecord> {
        let t = self.time();
        self.robots.iter().zip(&self.scene.robots).map(move |(moving, robot)| TraceRecord {
            t,
            robot: robot.name.clone(),
            x: moving.pose.x,
            y: moving.pose.y,
            theta: moving.pose.theta,
            wheels: moving.joints.iter().map(|joint| joint.rate).collect(),
            movement: None,
            action: None,
        })
    }

    fn joint(&self, robot: usize, wheel: usize) -> Option<&Joint> {
        self.robots.get(robot)?.joints.get(wheel)
    }

    fn joint_mut(&mut self, robot: usize, wheel: usize) -> Option<&mut Joint> {
        self.robots.get_mut(robot)?.joints.get_mut(wheel)
    }
}

fn at_rest(robot: &pydslrep_scene::Robot) -> Result<Moving, WorldError> {
    let model = robot.model().map_err(|error| WorldError::Model { robot: robot.name.clone(), error })?;
    if !(robot.motor_acceleration.is_finite() && robot.motor_acceleration > 0.0) {
        return Err(WorldError::Motor { robot: robot.name.clone() });
    }
    let joints = vec![Joint::default(); robot.wheels.len()];
    Ok(Moving { model, pose: robot.start, twist: Twist::default(), joints })
}

impl Moving {
    /// Motors and body over a short time. The body moves with the mean rates of that time, which makes the
    /// wheels' angles and the body's path agree.
    fn advance(&mut self, rim_acceleration: f64, seconds: f64) {
        let means: Vec<f64> = self
            .joints
            .iter_mut()
            .zip(self.model.radii())
            .map(|(joint, radius)| joint.advance(rim_acceleration / radius, seconds))
            .collect();
        self.pose = self.pose.advance(self.model.forward(&means), seconds);
        let rates: Vec<f64> = self.joints.iter().map(|joint| joint.rate).collect();
        self.twist = self.model.forward(&rates);
    }
}

impl Joint {
    /// Runs the motor towards its target at `acceleration` rad/s²; returns the mean rate.
    fn advance(&mut self, acceleration: f64, seconds: f64) -> f64 {
        let target = if self.released { 0.0 } else { self.target };
        let before = self.rate;
        let ramp = ((target - before).abs() / acceleration).min(seconds);
        self.rate = if ramp < seconds {
            target
        } else {
            before + (target - before).signum() * acceleration * seconds
        };
        let mean = (f64::midpoint(before, self.rate) * ramp + self.rate * (seconds - ramp)) / seconds;
        self.angle += mean * seconds;
        mean
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::Drive;
    use pydslrep_scene::{Robot, Wheel};

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
    fn turns_on_the_spot_to_the_left() {
        let mut world = world(Drive::TwoWheel);
        world.set_target(0, 0, -1.0);
        world.set_target(0, 1, 1.0);
        for _ in 0..20 {
            world.step();
        }
        let pose = world.pose(0);
        let rim = 0.05 * (1.0 - 0.025); // a quarter of a tenth of a second is lost in the ramp
        assert!(
            pose.distance(&Pose::default()) < 1e-12 && (pose.theta - rim / 0.15).abs() < 1e-12,
            "{pose:?}"
        );
    }

    #[test]
    fn mecanum_wheels_drive_sideways() {
        let mut world = world(Drive::FourMecanum);
        for (wheel, rate) in [-1.0, 1.0, 1.0, -1.0].into_iter().enumerate() {
            world.set_target(0, wheel, rate);
        }
        world.step();
        let (pose, twist) = (world.pose(0), world.twist(0));
        assert!(
            pose.y > 0.0 && pose.x.abs() < 1e-12 && (twist.vy - 0.05).abs() < 1e-12,
            "{pose:?} {twist:?}"
        );
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
    fn reset_is_a_new_world_and_parking_keeps_the_time() {
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
    fn says_which_robot_cannot_drive() {
        let mut robot = Robot::new("r", Drive::TwoWheel, vec![Wheel::new("w", 0.05)], vec![]);
        let error = World::new(Scene::empty_floor(vec![robot.clone()])).unwrap_err();
        let want = "robot `r` cannot drive: this layout has 2 wheels, but 1 wheel radii are given";
        assert_eq!(error.to_string(), want);
        robot.wheels.push(Wheel::new("v", 0.05));
        robot.motor_acceleration = 0.0;
        assert!(World::new(Scene::empty_floor(vec![robot])).is_err());
        assert!(World::with_step(Scene::default(), f64::NAN).is_err());
    }
}
