//! Kinematic models of wheeled robots, exact integration of their motion, and planned paths.
//!
//! Knows numbers only; of a type of robot, where its wheels are and which way they push. Must never know the language,
//! files, clocks or threads.
//! Units everywhere: metres, seconds, radians; x forward, y left, θ counter-clockwise.
//!
//! The formulas for two wheels are equations 1 to 6 of the article "PyDSLRep: A domain-specific language for
//! robotic simulation in V-Rep" (doi 10.1371/journal.pone.0235271), with rim speeds `v_l` and `v_r`,
//! wheel radius r and wheel separation d:
//!
//! | formula | here |
//! |---|---|
//! | v = (`v_r` + `v_l`)/2, ω = (`v_r` − `v_l`)/d | [`Model::forward`] |
//! | R = d (`v_l` + `v_r`) / (2 (`v_r` − `v_l`)) | [`Twist::turning_radius`] |
//! | centre of rotation (x − R sin θ, y + R cos θ) | [`Pose::centre_of_rotation`] |
//! | the pose after turning about it by ωΔt | [`Pose::advance`] |
//! | `v_r` = v + ω d/2, `v_l` = v − ω d/2, wheel rate v/r | [`Model::inverse`] |

mod model;
pub mod motion;
mod per_wheel;
mod plan;
mod pose;
mod profile;
mod traction;

pub use model::{Geometry, Model, ModelError, Settable, Setting, Turning};
pub use per_wheel::PerWheel;
pub use plan::{
    Action, ActionIndex, Leg, Plan, PlanError, RobotPath, RobotPlan, Run, TimedPose, plan, plan_movement,
};
pub use pose::{Pose, Twist, angle_between, heading_degrees, wrap_angle};
pub use profile::SpeedProfile;
pub use pydslrep_robots::Drive;
pub use traction::{SCRIPT_TRACK_FACTOR, Traction, scrub_factor};
