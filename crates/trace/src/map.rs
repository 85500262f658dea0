//! Maps of places and the ways between them.

use serde::{Deserialize, Serialize};

/// What a robot found on exploring, metres.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Map {
    /// Places.
    pub nodes: Vec<(f64, f64)>,
    /// Ways that were driven, from one place to another.
    pub edges: Vec<((f64, f64), (f64, f64))>,
}

/// A map file that a script wrote, as far as it matters here: of all its robots.
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
    /// What one robot found; edges between nodes that are not there are none.
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
    fn each_robot_has_its_part() {
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
