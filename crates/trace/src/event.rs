//! The events of a run: what scripts and `pydslrep run` write for programs (`docs/run-events.md`).

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// An event of a run: a line of the file of `--events`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum RunEvent {
    /// The run has begun.
    Started {
        /// The environment.
        environment: String,
        /// Its robots, in the order of their declaration.
        robots: Vec<String>,
        /// The version of this program.
        version: String,
    },
    /// A robot begins an action.
    ActionBegun(Moment),
    /// A robot has completed an action.
    ActionEnded(Moment),
    /// Something seems to be in a robot's way.
    Contact(Moment),
    /// A step of something that takes long.
    Progress {
        /// Simulation time, seconds.
        t: Option<f64>,
        /// The robot that gets on, if it is one.
        robot: Option<String>,
        /// The progress, in words.
        text: String,
    },
    /// Something worth knowing.
    Note {
        /// The note.
        text: String,
    },
    /// Something is wrong, but the run continues.
    Warning {
        /// The warning.
        text: String,
        /// Advice for the user.
        help: Option<String>,
    },
    /// A file of results is complete.
    File {
        /// Its kind.
        kind: FileKind,
        /// Its path.
        path: String,
    },
    /// The result of `pydslrep run`.
    Figures {
        /// As JSON: metres, radians and seconds.
        figures: Value,
        /// The same for people.
        table: String,
    },
    /// The run has failed.
    Failed(RunFailure),
}

/// A robot in the middle of an action.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Simulation time, seconds.
    pub t: f64,
    /// The robot's name.
    pub robot: String,
    /// The movement's name.
    pub movement: String,
    /// The number of the action's statement in its movement, in text order from 1.
    pub action: usize,
    /// The line of the program that it is on, if the script says it.
    pub line: Option<usize>,
    /// The rounds of the loops that it is in, outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rounds: Vec<u32>,
    /// The statements that do other movements and lead to it, outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calls: Vec<Call>,
    /// The action, in the words of the script.
    pub text: String,
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
    /// Radians.
    pub theta: f64,
}

/// A statement that does another movement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Call {
    /// The movement that the statement is in.
    pub movement: String,
    /// The number of the statement in that movement, from 1.
    pub action: usize,
}

/// The kind of a file of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FileKind {
    /// Every step.
    Trace,
    /// The map made by exploring robots.
    Map,
    /// A picture of that.
    MapPicture,
    /// The result in numbers.
    Figures,
    /// The paths.
    Picture,
    /// Robots driving along their paths.
    Replay,
}

/// Why a run failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunFailure {
    /// The kind of failure.
    pub class: FailureClass,
    /// The reason, in words.
    pub message: String,
    /// The robot whose action failed.
    pub robot: Option<String>,
    /// The movement of that action.
    pub movement: Option<String>,
    /// The number of that action in its movement, from 1.
    pub action: Option<usize>,
    /// The line of the program that it is on, if the script says it.
    pub line: Option<usize>,
    /// The rounds of the loops that it is in, outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rounds: Vec<u32>,
    /// The statements that do other movements and lead to it, outermost first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calls: Vec<Call>,
    /// Advice for the user.
    pub help: Option<String>,
    /// Other text that the script wrote to standard error.
    pub output: Option<String>,
}

/// The kind of a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FailureClass {
    /// A robot could not complete an action.
    Action,
    /// The program has errors.
    Program,
    /// A robot, an object of its scene, or something that the run needs is missing.
    Setup,
    /// A simulator or a robot did not reply, or with an error.
    Simulator,
    /// A file cannot be read or written, or a similar error of the system.
    File,
    /// The script, or code that it uses, has an error.
    Crash,
    /// The user has ended the run.
    Interrupted,
}

impl RunEvent {
    /// The event that a line is; `None` for any other text, and for events of later versions.
    pub fn parse(line: &str) -> Option<Self> {
        serde_json::from_str(line).ok()
    }

    /// The event as a line, with its end.
    pub fn line(&self) -> String {
        // Plain numbers and texts can always be written.
        serde_json::to_string(self).unwrap_or_default() + "\n"
    }
}

impl RunFailure {
    /// A failure that is none of an action.
    pub fn new(class: FailureClass, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            class,
            message,
            robot: None,
            movement: None,
            action: None,
            line: None,
            rounds: Vec::new(),
            calls: Vec::new(),
            help: None,
            output: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    const SCHEMA: &str = include_str!("../../../editors/run-events.schema.json");

    /// The definitions of the events, with their names.
    fn definitions() -> Vec<(String, Value)> {
        let schema: Value = serde_json::from_str(SCHEMA).unwrap();
        let kinds = schema["oneOf"].as_array().unwrap().iter();
        let name = |kind: &Value| kind["$ref"].as_str().unwrap().rsplit('/').next().unwrap().to_owned();
        kinds.map(name).map(|name| (name.clone(), schema["$defs"][&name].clone())).collect()
    }

    fn examples(definition: &Value) -> Vec<Value> {
        definition["examples"].as_array().unwrap().clone()
    }

    #[test]
    fn the_examples_of_the_schema_are_read_and_written() {
        for (name, definition) in definitions() {
            for example in examples(&definition) {
                let event =
                    RunEvent::parse(&example.to_string()).unwrap_or_else(|| panic!("{name}: {example}"));
                assert_eq!(serde_json::from_str::<Value>(&event.line()).unwrap(), example);
            }
        }
    }

    #[test]
    fn what_the_schema_requires_is_required() {
        for (name, definition) in definitions() {
            let example = examples(&definition).remove(0);
            let names: BTreeSet<&String> = definition["properties"].as_object().unwrap().keys().collect();
            assert_eq!(names, example.as_object().unwrap().keys().collect(), "{name}");
            for (field, property) in definition["properties"].as_object().unwrap() {
                let may_be_null = property["type"].as_array().is_some();
                let may_be_missing =
                    !definition["required"].as_array().unwrap().contains(&field.as_str().into());
                let mut without = example.clone();
                without.as_object_mut().unwrap().remove(field);
                assert_eq!(
                    RunEvent::parse(&without.to_string()).is_some(),
                    may_be_null || may_be_missing,
                    "{name} without {field}"
                );
            }
        }
    }

    /// The names that a type writes for its variants are in the error for a name that is none of them.
    fn variants<T: for<'a> Deserialize<'a>>(json: &Value) -> BTreeSet<String> {
        let error = serde_json::from_value::<T>(json.clone()).err().unwrap().to_string();
        error.split('`').skip(3).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn the_schema_has_every_name() {
        let named: BTreeSet<String> = definitions().into_iter().map(|(name, _)| name).collect();
        assert_eq!(variants::<RunEvent>(&serde_json::json!({ "event": "?" })), named);
        let schema: Value = serde_json::from_str(SCHEMA).unwrap();
        let listed = |path: &str| -> BTreeSet<String> {
            let names = schema.pointer(path).unwrap().as_array().unwrap();
            names.iter().map(|name| name.as_str().unwrap().to_owned()).collect()
        };
        let unknown = Value::from("?");
        assert_eq!(variants::<FileKind>(&unknown), listed("/$defs/file/properties/kind/enum"));
        assert_eq!(variants::<FailureClass>(&unknown), listed("/$defs/failed/properties/class/enum"));
    }

    #[test]
    fn other_lines_are_no_events() {
        for line in ["", "    1.00 s  rover  trip  1: move 1 m", "{}", "[]", r#"{"event": "later"}"#] {
            assert_eq!(RunEvent::parse(line), None, "{line}");
        }
    }
}
