//! The simulated world: robots driven by their wheels in fixed time steps, with contacts.

mod contact;
mod movers;
mod noise;

use std::fmt;

use pydslrep_kinematics::{ModelError, PerWheel, Pose, Traction, Twist, motion};
use pydslrep_scene::{Body, Scene, SensorKind, Sighting, Space};

use contact::Surroundings;
pub use movers::Strike;
use movers::{Bystander, Mover};
use noise::{Slip, body_error, reading_error};
use pydslrep_trace::TraceRecord;

use crate::engine::{Engine, Physics};

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
    physics: Option<Physics>,
}

#[derive(Debug, Clone)]
struct RobotState {
    /// As clients know them.
    radii: Vec<f64>,
    /// By which share of it each radius really is larger.
    radius_error: f64,
    traction: Traction,
    body: Body,
    pose: Pose,
    /// How far contacts have moved it from that pose in the latest step.
    jitter: [f64; 3],
    twist: Twist,
    /// Metres to the left per radian that it turns.
    drift: f64,
    joints: Vec<Joint>,
    /// Whether something has run into it while it drove: it stays where it is until its wheels stand still.
    is_struck: bool,
}

#[derive(Debug, Clone)]
struct Joint {
    target: f64,
    rate: f64,
    angle: f64,
    released: bool,
    slip: Slip,
}

/// Why a scene cannot be simulated.
#[derive(Debug, Clone, PartialEq)]
pub enum WorldError {
    /// A robot has no kinematic model.
    Model {
        /// Its name.
        robot: String,
        /// The cause.
        error: ModelError,
    },
    /// A robot's motors have no speed or acceleration.
    Motor {
        /// Its name.
        robot: String,
    },
    /// The step is not positive, or too long.
    Step {
        /// Seconds.
        step: f64,
    },
}

/// The longest step, seconds: within a longer one no controller could correct anything.
const MAX_STEP: f64 = 10.0;

fn is_step(step: f64) -> bool {
    step > 0.0 && step <= MAX_STEP
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model { robot, error } => write!(f, "robot `{robot}` cannot drive: {error}"),
            Self::Motor { robot } => {
                write!(
                    f,
                    "robot `{robot}` cannot drive: the acceleration and speed of its motors must be positive"
                )
            }
            Self::Step { step } => {
                write!(f, "the simulation step must be above 0 and up to {MAX_STEP} s, but it is {step:e} s")
            }
        }
    }
}

impl std::error::Error for WorldError {}

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
        let robots =
            (0..scene.robots.len()).map(|robot| robot_at_rest(&scene, robot)).collect::<Result<_, _>>()?;
        Ok(Self {
            space: Space::of(&scene),
            movers: Mover::all(&scene),
            strikes: Vec::new(),
            scene,
            robots,
            step,
            steps: 0,
            obstacle_time: 0.0,
            physics: None,
        })
    }

    /// From now on steps take `step` seconds. What an engine does depends on it: see [`World::use_engine`].
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

    /// From now on an engine does to the robots what real ones do; the scene's seed decides how.
    pub fn use_engine(&mut self, engine: Engine) {
        self.physics = engine.physics(self.step);
        let Some(physics) = self.physics else { return };
        for (robot, state) in self.robots.iter_mut().enumerate() {
            // Not from the readings after any step.
            let [side, amount, _] = body_error(self.scene.seed, robot, u64::MAX);
            state.drift = physics.drift * side.signum() * (1.0 - 0.2 * amount.abs());
        }
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
            state.pose = robot.start;
            state.jitter = [0.0; 3];
            state.twist = Twist::default();
            state.is_struck = false;
            for joint in &mut state.joints {
                (joint.target, joint.rate, joint.angle) = (0.0, 0.0, 0.0);
            }
        }
    }

    /// The pose of a robot; the origin if there is no such robot.
    pub fn pose(&self, robot: usize) -> Pose {
        self.robots.get(robot).map_or_else(Pose::default, RobotState::seen_pose)
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

    /// Whether a wheel's motor follows its target (velocity control); otherwise it brakes.
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
        if let Some(physics) = self.physics {
            for (robot, state) in self.robots.iter_mut().enumerate() {
                // The difference of two such errors is as large as the jitter.
                let error = body_error(self.scene.seed, robot, self.steps);
                state.jitter = error.map(|error| error * physics.jitter / 2.0);
            }
        }
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
        let twist = state.drive(parts.motor_acceleration, parts.motor_speed, self.physics, seconds);
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
            let Pose { x, y, theta } = state.seen_pose();
            let wheels = state.joints.iter().map(|joint| joint.rate).collect();
            TraceRecord { t, robot: robot.name.clone(), x, y, theta, wheels, movement: None, action: None }
        })
    }

    fn joint(&self, robot: usize, wheel: usize) -> Option<&Joint> {
        self.robots.get(robot)?.joints.get(wheel)
    }

    fn joint_mut(&mut self, robot: usize, wheel: usize) -> Option<&mut Joint> {
        self.robots.get_mut(robot)?.joints.get_mut(wheel)
    }
}

fn robot_at_rest(scene: &Scene, index: usize) -> Result<RobotState, WorldError> {
    let robot = &scene.robots[index];
    let model = robot.model().map_err(|error| WorldError::Model { robot: robot.name.clone(), error })?;
    let can_speed_up = robot.motor_acceleration.is_finite() && robot.motor_acceleration > 0.0;
    if !can_speed_up || robot.motor_speed.is_nan() || robot.motor_speed <= 0.0 {
        return Err(WorldError::Motor { robot: robot.name.clone() });
    }
    let joint = |wheel| Joint {
        target: 0.0,
        rate: 0.0,
        angle: 0.0,
        released: false,
        slip: Slip::new(scene.noise, scene.seed, index, wheel),
    };
    let joints = (0..model.settable().rates).map(joint).collect();
    let (track_error, radius_error) =
        scene.noise.map_or((0.0, 0.0), |noise| (noise.track_error, noise.radius_error));
    Ok(RobotState {
        radii: model.radii().to_vec(),
        traction: robot.traction(track_error),
        radius_error,
        body: robot.body,
        pose: robot.start,
        jitter: [0.0; 3],
        twist: Twist::default(),
        drift: 0.0,
        joints,
        is_struck: false,
    })
}

impl RobotState {
    /// The pose as clients see it.
    fn seen_pose(&self) -> Pose {
        let [x, y, theta] = self.jitter;
        Pose { x: self.pose.x + x, y: self.pose.y + y, theta: self.pose.theta + theta }
    }

    fn is_driving(&self) -> bool {
        self.joints.iter().any(|joint| joint.rate.abs() > 0.0)
    }

    fn as_bystander(&self) -> Bystander {
        Bystander { body: self.body, pose: self.pose, is_driving: self.is_driving() }
    }

    /// Runs the motors and returns the mean twist that the wheels give the body, ignoring contacts.
    fn drive(
        &mut self,
        rim_acceleration: f64,
        rim_speed: f64,
        physics: Option<Physics>,
        seconds: f64,
    ) -> Twist {
        let (creep, least_speed) = physics.map_or((0.0, 0.0), |physics| (physics.creep, physics.least_speed));
        let rims = self.joints.iter_mut().zip(&self.radii).map(|(joint, radius)| {
            let mean =
                joint.advance(rim_acceleration / radius, rim_speed / radius, least_speed / radius, seconds);
            let on_floor = radius * (1.0 + self.radius_error) * (1.0 + joint.slip.value - creep);
            (joint.rate * on_floor, mean * on_floor)
        });
        let (rims, mean_rims): (PerWheel, PerWheel) = rims.unzip();
        self.twist = self.drifting(self.traction.twist(&rims));
        self.drifting(self.traction.twist(&mean_rims))
    }

    /// A twist and the drift that it causes.
    fn drifting(&self, twist: Twist) -> Twist {
        Twist { vy: twist.vy + self.drift * twist.omega, ..twist }
    }
}

impl Joint {
    /// Runs the motor towards its target at `acceleration` rad/s², up to `max` rad/s, and returns the mean rate. Targets
    /// below `least` stand for rest.
    fn advance(&mut self, acceleration: f64, max: f64, least: f64, seconds: f64) -> f64 {
        let stands = self.released || self.target.abs() < least;
        let target = if stands { 0.0 } else { self.target.clamp(-max, max) };
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
    use pydslrep_scene::{Noise, Obstacle, Robot, Shape, Thing, Trajectory, Waypoint, Wheel};

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
        assert!(
            pose.distance(&Pose::default()) < 1e-12 && (pose.theta - rim / 0.15).abs() < 1e-12,
            "{pose:?}"
        );
    }

    /// A robot in an engine, after driving its wheels at some rates for some steps.
    fn driven(engine: Engine, rates: [f64; 2], steps: u32) -> World {
        let mut world = world(Drive::TwoWheel);
        world.use_engine(engine);
        for (wheel, rate) in rates.into_iter().enumerate() {
            world.set_target(0, wheel, rate);
        }
        for _ in 0..steps {
            world.step();
        }
        world
    }

    #[test]
    fn bodies_creep_drift_and_tremble_in_an_engine() {
        let [ideal, real] =
            [Engine::Ideal, Engine::CoppeliaSim46].map(|engine| driven(engine, [2.0; 2], 200));
        assert!((real.pose(0).x / ideal.pose(0).x - 0.89).abs() < 1e-3, "{:?}", real.pose(0));
        let [ideal, real] =
            [Engine::Ideal, Engine::CoppeliaSim46].map(|engine| driven(engine, [-2.0, 2.0], 50));
        assert!(ideal.pose(0).distance(&Pose::default()) < 1e-12);
        let drift = real.pose(0).distance(&Pose::default());
        assert!((0.02..0.04).contains(&drift), "{drift}");
        let mut rest = driven(Engine::CoppeliaSim46, [0.01; 2], 1);
        let steps: Vec<f64> = (0..100)
            .map(|_| {
                let before = rest.pose(0);
                rest.step();
                before.distance(&rest.pose(0))
            })
            .collect();
        assert!(steps.iter().all(|&step| step > 0.0 && step < 1.5e-4), "{steps:?}");
        assert!(rest.pose(0).distance(&Pose::default()) < 1e-4, "slower than its wheels start to turn");
    }

    #[test]
    fn engines_repeat_by_seed() {
        let end = |seed| {
            let mut world = world(Drive::TwoWheel);
            world.scene.seed = seed;
            world.use_engine(Engine::CoppeliaSim47);
            world.set_target(0, 0, 1.0);
            (0..20).for_each(|_| world.step());
            world.pose(0)
        };
        assert_eq!(end(3), end(3));
        assert_ne!(end(3), end(4));
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
        let sensors =
            vec![("front".to_owned(), SensorKind::Distance), ("bump".to_owned(), SensorKind::Bumper)];
        let mut robot = Robot::new(name, Drive::TwoWheel, wheels, sensors);
        robot.start = Pose::new(x, y, theta);
        robot
    }

    #[test]
    fn a_wall_stops_a_robot_but_does_not_hold_it() {
        let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
        let scene =
            Scene { robots: vec![robot("r", 0.0, 0.0, 0.0)], obstacles: vec![wall], ..Scene::default() };
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
        assert!((seen.distance - 0.8).abs() < 1e-9 && seen.what == Thing::Obstacle(0), "{seen:?}");
        assert_eq!(world.sight(0, 1), None, "out of range of a bumper");
        let seen = world.sight(1, 0).unwrap();
        assert!((seen.distance - 0.2).abs() < 1e-9 && seen.what == Thing::Robot(2), "{seen:?}");
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
        let mut world =
            World::new(Scene { robots, obstacles: vec![wall], noise, ..Scene::default() }).unwrap();
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
    fn a_parked_robot_is_where_it_started() {
        let mut world = world(Drive::TwoWheel);
        world.use_engine(Engine::CoppeliaSim46);
        world.step();
        assert_ne!(world.pose(0), Pose::default(), "its contacts tremble");
        world.park();
        assert_eq!(world.pose(0), Pose::default());
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
}
