//! Topological maps: nodes and the driven edges between them.

use serde::{Deserialize, Serialize};

/// The map of one robot, metres.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Map {
    /// The visited places.
    pub nodes: Vec<(f64, f64)>,
    /// The driven connections between two places.
    pub edges: Vec<((f64, f64), (f64, f64))>,
}

/// The relevant part of a map file, with the maps of all robots of a script.
#[derive(Debug, Clone, Default, Deserialize)]
pub struct MapFile {
    nodes: Vec<Node>,
    edges: Vec<Edge>,
}

#[derive(Debug, Clone, Deserialize)]
struct Node {
    robot: String,
    x: f64,
    y: f64,
}

#[derive(Debug, Clone, Deserialize)]
struct Edge {
    from: usize,
    to: usize,
}

impl MapFile {
    /// The map of one robot; edges with unknown nodes are dropped.
    pub fn of(&self, robot: &str) -> Map {
        let place = |index: usize| {
            self.nodes.get(index).filter(|node| node.robot == robot).map(|node| (node.x, node.y))
        };
        Map {
            nodes: (0..self.nodes.len()).filter_map(place).collect(),
            edges: self.edges.iter().filter_map(|edge| Some((place(edge.from)?, place(edge.to)?))).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_robot_has_its_own_map() {
        let text = r#"{"nodes": [{"id": 0, "robot": "a", "x": 0, "y": 1}, {"id": 1, "robot": "b", "x": 2, "y": 3},
            {"id": 2, "robot": "b", "x": 4, "y": 5}], "edges": [{"from": 1, "to": 2, "length": 2.8}, {"from": 1, "to": 9}]}"#;
        let file: MapFile = serde_json::from_str(text).unwrap();
        assert_eq!(file.of("a"), Map { nodes: vec![(0.0, 1.0)], edges: vec![] });
        let edges = vec![((2.0, 3.0), (4.0, 5.0))];
        assert_eq!(file.of("b"), Map { nodes: vec![(2.0, 3.0), (4.0, 5.0)], edges });
        assert_eq!(file.of("stranger"), Map::default());
        assert!(serde_json::from_str::<MapFile>("{}").is_err());
    }
}
