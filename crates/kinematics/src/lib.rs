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

mod action;
mod block;
mod leg;
mod model;
pub mod motion;
mod path;
mod per_wheel;
mod plan;
mod pose;
mod profile;
mod step;
mod summary;
#[cfg(test)]
mod testing;
mod traction;
mod walk;

pub use action::{LegKind, MotionPrimitive};
pub use leg::{ActionIndex, Call, Leg, Place};
pub use model::{Geometry, Model, ModelError, Settable, Setting, Turning};
pub use path::{RobotPath, TimedPose};
pub use per_wheel::PerWheel;
pub use plan::{
    MAX_ACTIONS, Plan, PlanError, RobotPlan, Run, plan, plan_movement, plan_schedule, plan_step, plan_steps,
};
pub use pose::{Pose, Twist, angle_between, heading_degrees, wrap_angle};
pub use profile::SpeedProfile;
pub use pydslrep_robots::Drive;
pub use step::{Movement, Step, StepKind};
pub use summary::{MAX_PLAN_DURATION, Motion, Summary};
pub use traction::{Traction, scrub_factor};
