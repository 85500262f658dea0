//! A robot in the world: its motors, and how its wheels move it.

use pydslrep_kinematics::{PerWheel, Pose, Traction, Twist};
use pydslrep_scene::{Body, Scene};

use super::error::WorldError;
use super::movers::Bystander;
use super::noise::Slip;

/// Where it is, how fast, and what its wheels do.
#[derive(Debug, Clone)]
pub(super) struct RobotState {
    /// As clients know them.
    radii: Vec<f64>,
    /// By which share of it each radius really is larger.
    radius_error: f64,
    traction: Traction,
    pub(super) body: Body,
    pub(super) pose: Pose,
    pub(super) twist: Twist,
    pub(super) joints: Vec<Joint>,
    /// True if something has run into it while it drove: it stays where it is until its wheels stand still.
    pub(super) is_struck: bool,
}

/// A wheel's motor. Rates are in rad/s, angles in radians.
#[derive(Debug, Clone)]
pub(super) struct Joint {
    pub(super) target: f64,
    pub(super) rate: f64,
    pub(super) angle: f64,
    pub(super) released: bool,
    pub(super) slip: Slip,
}

impl RobotState {
    /// A robot of a scene at its start.
    ///
    /// # Errors
    /// If its wheels or motors cannot move it.
    pub(super) fn at_rest(scene: &Scene, index: usize) -> Result<Self, WorldError> {
        let robot = &scene.robots[index];
        let model = robot.model().map_err(|error| WorldError::Model { robot: robot.name.clone(), error })?;
        let can_speed_up = robot.motor_acceleration.is_finite() && robot.motor_acceleration > 0.0;
        if !can_speed_up || robot.motor_speed.is_nan() || robot.motor_speed <= 0.0 {
            return Err(WorldError::Motor { robot: robot.name.clone() });
        }
        let joint = |wheel| {
            let slip = Slip::new(scene.noise, scene.seed, index, wheel);
            Joint { target: 0.0, rate: 0.0, angle: 0.0, released: false, slip }
        };
        let joints = (0..model.settable().rates).map(joint).collect();
        let (track_error, radius_error) =
            scene.noise.map_or((0.0, 0.0), |noise| (noise.track_error, noise.radius_error));
        Ok(Self {
            radii: model.radii().to_vec(),
            traction: robot.traction(track_error),
            radius_error,
            body: robot.body,
            pose: robot.start,
            twist: Twist::default(),
            joints,
            is_struck: false,
        })
    }

    /// Puts it at its start, at rest.
    pub(super) fn park(&mut self, start: Pose) {
        self.pose = start;
        self.twist = Twist::default();
        self.is_struck = false;
        for joint in &mut self.joints {
            (joint.target, joint.rate, joint.angle) = (0.0, 0.0, 0.0);
        }
    }

    pub(super) fn is_driving(&self) -> bool {
        self.joints.iter().any(|joint| joint.rate.abs() > 0.0)
    }

    pub(super) fn as_bystander(&self) -> Bystander {
        Bystander { body: self.body, pose: self.pose, is_driving: self.is_driving() }
    }

    /// Runs the motors and returns the mean twist that the wheels give the body, ignoring contacts.
    pub(super) fn drive(&mut self, rim_acceleration: f64, rim_speed: f64, seconds: f64) -> Twist {
        let rims = self.joints.iter_mut().zip(&self.radii).map(|(joint, radius)| {
            let mean = joint.advance(rim_acceleration / radius, rim_speed / radius, seconds);
            let on_floor = radius * (1.0 + self.radius_error) * (1.0 + joint.slip.value);
            (joint.rate * on_floor, mean * on_floor)
        });
        let (rims, mean_rims): (PerWheel, PerWheel) = rims.unzip();
        self.twist = self.traction.twist(&rims);
        self.traction.twist(&mean_rims)
    }
}

impl Joint {
    /// Runs the motor towards its target at `acceleration` rad/s², up to `max` rad/s, and returns the mean rate.
    fn advance(&mut self, acceleration: f64, max: f64, seconds: f64) -> f64 {
        let target = if self.released { 0.0 } else { self.target.clamp(-max, max) };
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
