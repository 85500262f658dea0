//! Runs: from a Python interpreter to the result.
//!
//! [`python`] and [`vrep_client`] prepare what a script needs, [`script`] runs it and reads its events, [`progress`] shows
//! them, [`mujoco`] is another simulator, [`ros2_world`] makes the simulator a node of ROS 2, [`reporter`] passes events on,
//! [`outcome`] compares [`driven`] with [`planned`], [`trace_file`] is what is kept of it and [`record`] what is read again, and [`strikes`] warns of what moving obstacles ran into. [`scene_tasks`]
//! reads and changes the scene of a simulator that runs elsewhere.

pub(crate) mod driven;
pub(crate) mod exploring;
pub(crate) mod interrupt;
pub(crate) mod mujoco;
pub(crate) mod outcome;
pub(crate) mod own_robots;
pub(crate) mod pictures;
pub(crate) mod planned;
pub(crate) mod progress;
pub(crate) mod python;
pub(crate) mod record;
pub(crate) mod reporter;
pub(crate) mod ros2_world;
pub(crate) mod scene_description;
pub(crate) mod scene_tasks;
pub(crate) mod script;
pub(crate) mod strikes;
pub(crate) mod trace_file;
pub(crate) mod vrep_client;
