//! What a script that explores is told, and the map that it leaves.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use pydslrep_analysis::environment::{ActionKind, Environment};
use pydslrep_picture::Map;
use pydslrep_scene::Scene;
use serde::Deserialize;

use crate::failure::Failure;

/// Whether some listed movement explores.
pub(crate) fn explores(environment: &Environment) -> bool {
    let actions = environment.movements.iter().flat_map(|movement| &movement.actions);
    actions.into_iter().any(|action| action.kind == ActionKind::Slam)
}

/// What the map of an environment is called where nobody says.
pub(crate) fn default_file(environment: &Environment) -> PathBuf {
    format!("{}_map.json", environment.name).into()
}

/// The arguments that tell a script of robots what not every simulator can: how big they are, and what sensors see.
pub(crate) fn arguments(scene: &Scene) -> Vec<OsString> {
    let mut all = Vec::new();
    for robot in &scene.robots {
        let radius = robot.body.length.hypot(robot.body.width) / 2.0;
        all.extend(["--radius".into(), format!("{}={radius}", robot.name).into()]);
        for sensor in &robot.sensors {
            let (name, mount) = (format!("{}.{}", robot.name, sensor.name), sensor.mount);
            all.extend(["--range".into(), format!("{name}={}", mount.range).into()]);
            all.extend(["--cone".into(), format!("{name}={}", mount.cone.to_degrees()).into()]);
        }
    }
    all
}

/// A map file, as far as it matters here.
#[derive(Deserialize)]
struct MapFile {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
}

#[derive(Deserialize)]
struct Node {
    robot: String,
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
struct Edge {
    from: usize,
    to: usize,
}

/// What a robot found.
///
/// # Errors
/// When the file cannot be read or is no map.
pub(crate) fn read(file: &Path, robot: &str) -> Result<Map, Failure> {
    let failure =
        |reason: &dyn std::fmt::Display| Failure::new(format!("cannot read {}: {reason}", file.display()));
    let text = fs::read_to_string(file).map_err(|error| failure(&error))?;
    let found: MapFile = serde_json::from_str(&text).map_err(|error| failure(&error))?;
    let place =
        |index: usize| found.nodes.get(index).filter(|node| node.robot == robot).map(|node| (node.x, node.y));
    Ok(Map {
        nodes: (0..found.nodes.len()).filter_map(place).collect(),
        edges: found.edges.iter().filter_map(|edge| Some((place(edge.from)?, place(edge.to)?))).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_robot_has_its_part_of_the_map() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("map.json");
        let text = r#"{"nodes": [{"id": 0, "robot": "a", "x": 0, "y": 1}, {"id": 1, "robot": "b", "x": 2, "y": 3},
            {"id": 2, "robot": "b", "x": 4, "y": 5}], "edges": [{"from": 1, "to": 2, "length": 2.8}, {"from": 1, "to": 9}]}"#;
        fs::write(&file, text).unwrap();
        let of = |robot| read(&file, robot).unwrap_or_default();
        assert_eq!(of("a"), Map { nodes: vec![(0.0, 1.0)], edges: vec![] });
        let edges = vec![((2.0, 3.0), (4.0, 5.0))];
        assert_eq!(of("b"), Map { nodes: vec![(2.0, 3.0), (4.0, 5.0)], edges });
        fs::write(&file, "no map").unwrap();
        assert!(read(&file, "a").is_err());
    }
}
