//! Runs in `MuJoCo`, which is in the process of the script: the world that it drives in, and its arguments.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_kinematics::RobotPath;
use pydslrep_scene::{Scene, mjcf};

use crate::failure::Failure;

/// The world of a run, and how it is watched.
#[derive(Debug)]
pub(crate) struct World {
    path: PathBuf,
    speed: Option<f64>,
    view: bool,
}

impl World {
    /// Writes a scene into a folder, with the planned `paths` in view; `speed` is in simulated seconds per second.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn write(
        scene: &Scene,
        paths: &[RobotPath],
        folder: &Path,
        speed: Option<f64>,
        view: bool,
    ) -> Result<Self, Failure> {
        let path = folder.join("world.xml");
        fs::write(&path, mjcf(scene, paths)).map_err(|error| Failure::unwritten(&path, &error))?;
        Ok(Self { path, speed, view })
    }

    /// The script's arguments for it.
    pub(crate) fn arguments(&self) -> Vec<OsString> {
        let mut all: Vec<OsString> = vec!["--mujoco".into(), (&self.path).into()];
        if let Some(speed) = self.speed {
            all.extend(["--speed".into(), speed.to_string().into()]);
        }
        all.extend(self.view.then(|| "--view".into()));
        all
    }
}
