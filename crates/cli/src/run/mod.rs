//! Runs: from a Python interpreter to the result.
//!
//! [`python`] and [`vrep_client`] prepare what a script needs, [`script`] runs it and reads its events, [`progress`] shows
//! them, [`reporter`] passes them on, [`outcome`] compares [`driven`] with [`planned`], and [`strikes`] warns of what moving obstacles ran into. [`scene_tasks`]
//! reads and changes the scene of a simulator that runs elsewhere. [`ros2_world`] makes the simulator a node of ROS 2.

pub(crate) mod driven;
pub(crate) mod exploring;
pub(crate) mod interrupt;
pub(crate) mod outcome;
pub(crate) mod own_robots;
pub(crate) mod pictures;
pub(crate) mod planned;
pub(crate) mod progress;
pub(crate) mod python;
pub(crate) mod reporter;
pub(crate) mod ros2_world;
pub(crate) mod scene_description;
pub(crate) mod scene_tasks;
pub(crate) mod script;
pub(crate) mod strikes;
pub(crate) mod vrep_client;
