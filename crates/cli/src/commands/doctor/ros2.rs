//! `pydslrep doctor --target ros2`: the robots found in ROS 2, and their problems. A Python process
//! (`pydslrep_runtime.ros2_tasks`) looks, as only that knows ROS 2.

use std::process::ExitCode;

use pydslrep_analysis::FileId;
use pydslrep_analysis::environment::Environment;
use pydslrep_scene::Robot;
use pydslrep_script::used_sensors;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Arguments, Finding, exit_code, print};
use crate::failure::Failure;
use crate::inputs::{Inputs, program};
use crate::report::output;
use crate::run::interrupt;
use crate::run::scene_description;
use crate::run::scene_tasks::carry_out_in_own_python;

const MODULE: &str = "pydslrep_runtime.ros2_tasks";

/// The table cell for a missing value.
const NOTHING: &str = "–";

#[derive(Debug, Serialize)]
struct Request {
    robots: Vec<Value>,
    drive: bool,
}

#[derive(Debug, Deserialize)]
struct Answer {
    /// True if topics of other nodes were found.
    reached: bool,
    topics: Vec<Topic>,
    findings: Vec<Finding>,
    /// The findings of the test drive.
    notes: Vec<String>,
}

/// A topic, as far as it is known.
#[derive(Debug, Deserialize)]
struct Topic {
    #[serde(rename = "topic")]
    name: String,
    r#type: Option<String>,
    rate: Option<String>,
    frames: Option<String>,
    nodes: Option<String>,
}

/// Looks for the robots of a program.
///
/// # Errors
/// If options contradict each other, the program or its scene cannot be read, or Python cannot be started or has no
/// `rclpy`.
pub(super) fn check_program(
    arguments: &Arguments,
    inputs: &mut Inputs,
    file: FileId,
) -> Result<ExitCode, Failure> {
    check_options(arguments)?;
    let id = program::environment(inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let Some(environment) = program::prepare(inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let scene = inputs.scene(file, &environment)?;
    let request = Request { robots: robots(&environment, &scene.robots), drive: arguments.drive };
    check(arguments, &request, "the robots fit the program")
}

/// Lists the topics of others.
///
/// # Errors
/// If options contradict each other, or Python cannot be started or has no `rclpy`.
pub(super) fn list(arguments: &Arguments) -> Result<ExitCode, Failure> {
    check_options(arguments)?;
    if arguments.drive || arguments.scene.is_some() || arguments.environment.is_some() {
        return Err(Failure::new("--drive, --scene and --environment need a program")
            .help("name one: `pydslrep doctor --target ros2 PROGRAM`"));
    }
    let request = Request { robots: Vec::new(), drive: false };
    check(arguments, &request, "name a program to check its robots against these")
}

fn check_options(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.host.is_some() || !arguments.port.is_empty() {
        return Err(Failure::new(
            "--host and --port are for CoppeliaSim, and robots of ROS 2 have no address",
        )
        .help("`--target coppeliasim` checks a scene; ROS_DOMAIN_ID chooses among robots in one network"));
    }
    Ok(())
}

/// The robots with the sensors that actions read.
fn robots(environment: &Environment, robots: &[Robot]) -> Vec<Value> {
    let used = used_sensors(environment);
    let robots = robots.iter().zip(&environment.robots).zip(used);
    let robots = robots.map(|((robot, declared), used)| {
        let names: Vec<&str> = used.iter().map(|&sensor| declared.sensors[sensor].name.as_str()).collect();
        let mut described = scene_description::ros2_robot(robot);
        if let Some(sensors) = described["sensors"].as_array_mut() {
            sensors.retain(|sensor| sensor["name"].as_str().is_some_and(|name| names.contains(&name)));
        }
        described
    });
    robots.collect()
}

fn check(arguments: &Arguments, request: &Request, all_well: &str) -> Result<ExitCode, Failure> {
    let answer = carry_out_in_own_python::<Answer>(arguments.python.as_deref(), MODULE, request)?;
    let Some(answer) = answer else {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    if !arguments.json {
        output::print(&report(&answer, request.robots.is_empty()))?;
    }
    print(arguments, &answer.findings, all_well)?;
    Ok(exit_code(answer.reached, &answer.findings))
}

/// The topics, one line each, and the findings of the test drive.
fn report(answer: &Answer, is_list: bool) -> String {
    if answer.topics.is_empty() {
        return String::new();
    }
    let shown = |text: &Option<String>| text.clone().unwrap_or_else(|| NOTHING.to_owned());
    // As people write types: there is no other kind of them among topics.
    let kind = |topic: &Topic| shown(&topic.r#type).replace("/msg/", "/");
    let table = if is_list {
        let mut table = output::table(["topic", "type", "nodes"]);
        for topic in &answer.topics {
            table.add_row([topic.name.clone(), kind(topic), shown(&topic.nodes)]);
        }
        table
    } else {
        let mut table = output::table(["topic", "type", "rate", "frames"]);
        for topic in &answer.topics {
            table.add_row([topic.name.clone(), kind(topic), shown(&topic.rate), shown(&topic.frames)]);
        }
        table
    };
    let mut text = format!("{}\n\n", table.trim_fmt());
    for note in &answer.notes {
        text += &format!("{note}\n\n");
    }
    text
}
