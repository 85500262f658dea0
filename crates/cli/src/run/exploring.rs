//! Exploring: the script's arguments and the map that it writes.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_analysis::environment::{Environment, ResolvedActionKind, nested};
use pydslrep_scene::Scene;
use pydslrep_trace::{Map, MapFile};

use crate::failure::Failure;

/// Returns whether a movement of the environment explores.
pub(crate) fn explores(environment: &Environment) -> bool {
    let actions = environment.movements.iter().flat_map(|movement| nested(&movement.actions));
    actions.into_iter().any(|action| action.kind == ResolvedActionKind::Slam)
}

/// The file for an environment's map: the one that was asked for, or one of the environment's name.
pub(crate) fn file(asked: Option<&Path>, environment: &Environment) -> PathBuf {
    asked.map_or_else(|| format!("{}_map.json", environment.name).into(), Path::to_owned)
}

/// Arguments for facts that scripts do not get from every simulator: the size of robots and the field of view of sensors.
pub(crate) fn arguments(scene: &Scene) -> Vec<OsString> {
    let mut all = Vec::new();
    for robot in &scene.robots {
        all.extend(["--radius".into(), format!("{}={}", robot.name, robot.body.reach()).into()]);
        for sensor in &robot.sensors {
            let (name, mount) = (format!("{}.{}", robot.name, sensor.name), sensor.mount);
            all.extend(["--range".into(), format!("{name}={}", mount.range).into()]);
            all.extend(["--cone".into(), format!("{name}={}", mount.cone.to_degrees()).into()]);
        }
    }
    all
}

/// The map of one robot.
///
/// # Errors
/// If the file cannot be read or is not a map.
pub(crate) fn read(file: &Path, robot: &str) -> Result<Map, Failure> {
    let failure =
        |reason: &dyn std::fmt::Display| Failure::new(format!("cannot read {}: {reason}", file.display()));
    let text = fs::read_to_string(file).map_err(|error| failure(&error))?;
    let found: MapFile = serde_json::from_str(&text).map_err(|error| failure(&error))?;
    Ok(found.of(robot))
}
