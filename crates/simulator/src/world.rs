//! The simulated world: robots driven by their wheels in fixed time steps, with contacts.

mod contact;
mod error;
mod movers;
mod noise;
mod robot;

use std::collections::BTreeMap;

use pydslrep_kinematics::{Pose, Twist, motion};
use pydslrep_scene::{Body, Scene, SensorKind, Sighting, Space};
use pydslrep_trace::TraceRecord;

use contact::Surroundings;
use error::MAX_STEP;
pub use error::WorldError;
pub use movers::Strike;
use movers::{Bystander, Mover};
use noise::{Slip, reading_error};
use robot::{Joint, RobotState};

/// The maximum number of strikes that are kept; nobody would read more.
const MAX_STRIKES: usize = 10_000;

/// The number of integration steps per simulation step, as in CoppeliaSim (5 ms in a step of 50 ms).
const SUBSTEPS: u32 = 10;

/// A simulated scene. Rates are rolling rates: positive values roll the robot forward, regardless of the direction of
/// the wheel's joint.
#[derive(Debug, Clone)]
pub struct World {
    scene: Scene,
    space: Space,
    robots: Vec<RobotState>,
    movers: Vec<Mover>,
    strikes: Vec<Strike>,
    step: f64,
    steps: u64,
    /// Obstacles that move are where they are at this time, seconds.
    obstacle_time: f64,
}

fn is_step(step: f64) -> bool {
    step > 0.0 && step <= MAX_STEP
}

impl World {
    /// The scene at rest, with the default step of [`motion::STEP`].
    ///
    /// # Errors
    /// If a robot cannot drive.
    pub fn new(scene: Scene) -> Result<Self, WorldError> {
        Self::with_step(scene, motion::STEP)
    }

    /// The scene at rest, stepped by `step` seconds.
    ///
    /// # Errors
    /// If a robot cannot drive, or the step is not positive or longer than 10 s.
    pub fn with_step(scene: Scene, step: f64) -> Result<Self, WorldError> {
        if !is_step(step) {
            return Err(WorldError::Step { step });
        }
        let robots = (0..scene.robots.len())
            .map(|robot| RobotState::at_rest(&scene, robot))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            space: Space::of(&scene),
            movers: Mover::all(&scene),
            strikes: Vec::new(),
            scene,
            robots,
            step,
            steps: 0,
            obstacle_time: 0.0,
        })
    }

    /// From now on steps take `step` seconds.
    ///
    /// # Errors
    /// If the step is not positive or longer than 10 s.
    pub fn set_step_length(&mut self, step: f64) -> Result<(), WorldError> {
        if !is_step(step) {
            return Err(WorldError::Step { step });
        }
        self.step = step;
        Ok(())
    }

    /// The simulated scene.
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

    /// Resets the world to the scene, at time 0 and at rest.
    pub fn reset(&mut self) {
        self.steps = 0;
        self.strikes.clear();
        self.park();
        for (robot, state) in self.robots.iter_mut().enumerate() {
            for (wheel, joint) in state.joints.iter_mut().enumerate() {
                joint.slip = Slip::new(self.scene.noise, self.scene.seed, robot, wheel);
            }
        }
    }

    /// Returns the robots to their start poses, at rest, and the obstacles that move to where they start; keeps the time and
    /// the strikes.
    pub fn park(&mut self) {
        self.obstacle_time = 0.0;
        self.space.move_to(0.0);
        self.movers.iter_mut().for_each(Mover::forget);
        for (state, robot) in self.robots.iter_mut().zip(&self.scene.robots) {
            state.park(robot.start);
        }
    }

    /// The pose of a robot; the origin if there is no such robot.
    pub fn pose(&self, robot: usize) -> Pose {
        self.robots.get(robot).map_or_else(Pose::default, |robot| robot.pose)
    }

    /// The pose of an obstacle, which may move; `None` if there is no such obstacle.
    pub fn obstacle_pose(&self, obstacle: usize) -> Option<Pose> {
        self.scene.obstacles.get(obstacle).map(|obstacle| obstacle.pose_at(self.obstacle_time))
    }

    /// The robots that moving obstacles have run into since the last [`World::reset`], in the order of time.
    pub fn strikes(&self) -> &[Strike] {
        &self.strikes
    }

    /// The twist of a robot in its own frame; zero if there is no such robot.
    pub fn twist(&self, robot: usize) -> Twist {
        self.robots.get(robot).map_or_else(Twist::default, |robot| robot.twist)
    }

    /// The rate of a wheel, rad/s.
    pub fn rate(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.rate)
    }

    /// The rolled angle of a wheel since the start, radians, not wrapped.
    pub fn angle(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.angle)
    }

    /// The target rate of a wheel, rad/s.
    pub fn target(&self, robot: usize, wheel: usize) -> f64 {
        self.joint(robot, wheel).map_or(0.0, |joint| joint.target)
    }

    /// Sets the target rate of a wheel, rad/s; its motor accelerates to it. Non-finite rates are ignored.
    pub fn set_target(&mut self, robot: usize, wheel: usize, rate: f64) {
        if let Some(joint) = self.joint_mut(robot, wheel).filter(|_| rate.is_finite()) {
            joint.target = rate;
        }
    }

    /// Returns whether a wheel's motor follows its target (velocity control); otherwise it brakes.
    pub fn is_controlled(&self, robot: usize, wheel: usize) -> bool {
        self.joint(robot, wheel).is_some_and(|joint| !joint.released)
    }

    /// Switches velocity control of a wheel on or off.
    pub fn set_controlled(&mut self, robot: usize, wheel: usize, controlled: bool) {
        if let Some(joint) = self.joint_mut(robot, wheel) {
            joint.released = !controlled;
        }
    }

    /// Advances all robots by one step, and the obstacles that move.
    pub fn step(&mut self) {
        for joint in self.robots.iter_mut().flat_map(|state| &mut state.joints) {
            joint.slip.advance(self.step);
        }
        let (begin, seconds) = (self.time(), self.step / f64::from(SUBSTEPS));
        for substep in 1..=SUBSTEPS {
            for robot in 0..self.robots.len() {
                self.advance(robot, seconds);
            }
            self.move_obstacles(begin + self.step * f64::from(substep) / f64::from(SUBSTEPS));
        }
        self.steps += 1;
    }

    /// The measurement of a sensor; `None` if it detects nothing.
    pub fn sight(&self, robot: usize, sensor: usize) -> Option<Sighting> {
        let part = self.scene.robots.get(robot)?.sensors.get(sensor)?;
        let others: Vec<(usize, Body, Pose)> = self
            .robots
            .iter()
            .enumerate()
            .filter(|&(index, _)| index != robot)
            .map(|(index, other)| (index, other.body, other.pose))
            .collect();
        let seen = self.space.sight(self.pose(robot), &part.mount, &others)?;
        if part.kind == SensorKind::Bumper {
            return Some(seen);
        }
        let error = reading_error(self.scene.noise, self.scene.seed, robot, sensor, self.steps);
        let distance = (seen.distance + error).max(0.0);
        (distance <= part.mount.range).then_some(Sighting { distance, ..seen })
    }

    /// Moves obstacles to where they are at a time, past the robots, which stand still meanwhile.
    fn move_obstacles(&mut self, time: f64) {
        if self.movers.is_empty() {
            return;
        }
        if self.scene.collisions {
            let robots: Vec<Bystander> = self.robots.iter().map(RobotState::as_bystander).collect();
            let mut strikes: Vec<Strike> = Vec::new();
            for mover in &mut self.movers {
                strikes.extend(mover.advance(self.obstacle_time, time, &robots));
            }
            strikes.sort_by(|a, b| a.time.total_cmp(&b.time));
            for strike in &strikes {
                self.robots[strike.robot].is_struck |= strike.was_driving;
            }
            self.strikes.extend(strikes);
            self.strikes.truncate(MAX_STRIKES);
        }
        self.obstacle_time = time;
        self.space.move_to(time);
    }

    /// Advances the motors and body of a robot. The body moves with the mean rates of the interval, so that the wheels'
    /// angles and the body's path agree.
    fn advance(&mut self, robot: usize, seconds: f64) {
        let others: Vec<(Body, Pose)> = if self.scene.collisions {
            let others = self.robots.iter().enumerate().filter(|&(index, _)| index != robot);
            others.map(|(_, other)| (other.body, other.pose)).collect()
        } else {
            Vec::new()
        };
        let (Some(state), Some(parts)) = (self.robots.get_mut(robot), self.scene.robots.get(robot)) else {
            return;
        };
        let twist = state.drive(parts.motor_acceleration, parts.motor_speed, seconds);
        if !self.scene.collisions {
            state.pose = state.pose.advance(twist, seconds);
            return;
        }
        state.is_struck &= state.is_driving();
        if state.is_struck || self.movers.iter().any(|mover| mover.covers(robot)) {
            state.twist = Twist::default();
            return;
        }
        let around = Surroundings { space: &self.space, others: &others };
        let (pose, changed) = around.advance(state.body, state.pose, twist, seconds);
        state.pose = pose;
        if let Some(twist) = changed {
            state.twist = twist;
        }
    }

    /// The current trace records of all robots.
    pub fn records(&self) -> impl Iterator<Item = TraceRecord> {
        let t = self.time();
        self.robots.iter().zip(&self.scene.robots).map(move |(state, robot)| {
            let Pose { x, y, theta } = state.pose;
            let (robot, readings) = (robot.name.clone(), BTreeMap::new());
            let wheels = state.joints.iter().map(|joint| joint.rate).collect();
            TraceRecord { t, robot, x, y, theta, wheels, readings, movement: None, action: None }
        })
    }

    fn joint(&self, robot: usize, wheel: usize) -> Option<&Joint> {
        self.robots.get(robot)?.joints.get(wheel)
    }

    fn joint_mut(&mut self, robot: usize, wheel: usize) -> Option<&mut Joint> {
        self.robots.get_mut(robot)?.joints.get_mut(wheel)
    }
}

#[cfg(test)]
mod tests;
