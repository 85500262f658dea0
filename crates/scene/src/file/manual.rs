//! What is published of scene files: the page of documentation and the JSON schema, both made from [`TABLES`].

use serde_json::{Map, Value, json};

use super::ENDING;
use super::keys::{Key, Sort, TABLES, Table, Values};

/// The page of documentation, in Markdown.
pub fn manual() -> String {
    let mut out = format!(
        "# Scenes\n\n\
        The embedded simulator puts the robots of an environment on an empty floor, a metre apart. A file\n\
        `<environment>{ENDING}` beside the program, or one that is named by `--scene`, says what else is there: obstacles,\n\
        where robots start, how they are built, and what goes wrong. With one, robots are stopped by what they touch, or slide\n\
        along it; an action that is stopped, or a move that ends well beside its goal for that, fails. Without one they drive\n\
        through each other, for nobody said where they stand. Nothing in it is required:\n\n\
        ```toml\n{EXAMPLE}```\n\n\
        Lengths are in metres, angles in degrees and counter-clockwise, x points ahead of a robot with heading 0 and y to its\n\
        left. What is misspelt or has a wrong value is reported with its place, and nothing is driven; so is the name of a\n\
        robot or a sensor that the program does not have, and a robot that starts in something.\n\n\
        Editors that know JSON schemas complete and check the file by [scene.schema.json](../editors/scene.schema.json).\n"
    );
    for table in &TABLES {
        out += &format!(
            "\n## {}\n\n{}\n\n| key | value | default | |\n|---|---|---|---|\n",
            table.header(),
            table.summary
        );
        for key in table.keys {
            let default = if key.required { "required" } else { key.default };
            out += &format!("| `{}` | {} | {default} | {} |\n", key.name, key.values.words(), key.summary);
        }
    }
    out
}

const EXAMPLE: &str = "\
[world]
size = [4.0, 3.0]

[[wall]]
from = [-0.5, 0.5]
to = [1.5, 0.5]

[[cylinder]]
at = [1.0, -0.7]
radius = 0.15

[noise]
wheel-slip = 3

[robots.robot_1]
start = [-1.5, 0.0, 0]
track = 0.28

[robots.robot_1.sensors.fSensor]
range = 0.6
cone = 30
";

/// The JSON schema of scene files, for editors that check TOML by one.
pub fn json_schema() -> Value {
    let mut properties = Map::new();
    let of = |name: &str| TABLES.iter().find(|table| table.name == name).map(properties_of);
    for table in TABLES.iter().filter(|table| matches!(table.sort, Sort::Once | Sort::Each)) {
        let mut inner = object(table);
        if table.sort == Sort::Each {
            inner = json!({ "type": "array", "items": inner });
        }
        inner["description"] = json!(table.summary);
        properties.insert(table.name.to_owned(), inner);
    }
    let mut robot = of("robots.NAME").unwrap_or_default();
    let sensor = json!({
        "type": "object", "additionalProperties": false,
        "properties": of("robots.NAME.sensors.NAME").unwrap_or_default(),
    });
    robot.insert("sensors".to_owned(), json!({ "type": "object", "additionalProperties": sensor }));
    let robot = json!({ "type": "object", "additionalProperties": false, "properties": robot });
    properties.insert("robots".to_owned(), json!({ "type": "object", "additionalProperties": robot }));
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": format!("*{ENDING}"),
        "description": "The world that the robots of an environment of PyDSLRep drive in.",
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
    })
}

fn object(table: &Table) -> Value {
    let required: Vec<&str> = table.keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    let mut object =
        json!({ "type": "object", "additionalProperties": false, "properties": properties_of(table) });
    if !required.is_empty() {
        object["required"] = json!(required);
    }
    object
}

fn properties_of(table: &Table) -> Map<String, Value> {
    table.keys.iter().map(|key| (key.name.to_owned(), property(key))).collect()
}

fn property(key: &Key) -> Value {
    let numbers = |least: usize, most: usize, item: Value| json!({ "type": "array", "items": item, "minItems": least, "maxItems": most });
    let number = || json!({ "type": "number" });
    let mut property = match key.values {
        Values::Flag => json!({ "type": "boolean" }),
        Values::Count => json!({ "type": "integer", "minimum": 0, "maximum": u32::MAX }),
        Values::AboveZero => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Values::FromZero => json!({ "type": "number", "minimum": 0 }),
        Values::Share => json!({ "type": "number", "minimum": 0, "maximum": 1 }),
        Values::Angle => number(),
        Values::Opening => json!({ "type": "number", "exclusiveMinimum": 0, "maximum": 180 }),
        Values::Name => json!({ "type": "string", "pattern": r"^[^/]*\S[^/]*$" }),
        Values::Point => numbers(2, 2, number()),
        Values::Size => numbers(2, 2, json!({ "type": "number", "exclusiveMinimum": 0 })),
        Values::Pose => numbers(2, 3, number()),
        Values::Points => {
            json!({ "type": "array", "items": numbers(2, 2, number()), "minItems": 3 })
        }
    };
    property["description"] = json!(key.summary);
    if let Ok(default) = serde_json::from_str::<Value>(key.default.trim_matches('`')) {
        property["default"] = default;
    }
    property
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use expect_test::expect_file;
    use pydslrep_kinematics::Drive;

    use super::*;
    use crate::{Robot, Scene, SensorKind, Wheel, read};

    #[test]
    fn what_is_published_is_what_is_read() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        expect_file![root.join("docs/scenes.md")].assert_eq(&manual());
        let schema = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
        expect_file![root.join("editors/scene.schema.json")].assert_eq(&schema);
    }

    #[test]
    fn the_example_is_fine() {
        let wheels = ["l", "r"].map(|name| Wheel::new(name, 0.045)).to_vec();
        let sensors = vec![("fSensor".to_owned(), SensorKind::Distance)];
        let robot = Robot::new("robot_1", Drive::TwoWheel, wheels, sensors);
        let (scene, problems) = read(EXAMPLE, Scene::empty_floor(vec![robot]));
        assert_eq!((scene.obstacles.len(), problems), (6, vec![]));
    }
}
