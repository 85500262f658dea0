//! Group "environment": the schedule.

use super::repeated;
use super::value::port_number;
use crate::Finding;
use crate::program::{Body, Entity, Environment, Movement, Name, Program, Robot};
use crate::project::{Declared, Scope};

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for (entity, environment) in scope.program().environments() {
        if environment.robots.is_empty() {
            findings.push(Finding::new("empty-environment", &environment.robot_list));
        }
        for robot in repeated(&environment.robots) {
            findings.push(Finding::new("repeated-robot", &robot.range));
        }
        movement_robot_missing(scope, environment, findings);
        idle_robot(scope, environment, findings);
        parallel_conflict(scope, environment, findings);
        if scope.file().for_vrep {
            duplicate_port(scope, environment, findings);
        }
        script_name(scope.program(), entity, findings);
    }
    if !scope.is_imported() {
        single_parallel(scope, findings);
    }
}

/// Lists a movement but not its robot. An unknown robot is an error of the movement itself.
fn movement_robot_missing(scope: Scope<'_>, environment: &Environment, findings: &mut Vec<Finding>) {
    let listed: Vec<_> = environment.robots.iter().filter_map(|name| scope.robot(&name.text)).collect();
    for name in &environment.movements {
        let Some(robot) = driven_robot(scope, name) else { continue };
        if !listed.iter().any(|other| other.is(&robot)) {
            findings.push(Finding::new("movement-robot-missing", &name.range));
        }
    }
}

/// Lists a robot without a listed movement. An unknown movement may be for any robot.
fn idle_robot(scope: Scope<'_>, environment: &Environment, findings: &mut Vec<Finding>) {
    let driven: Option<Vec<_>> = environment.movements.iter().map(|name| driven_robot(scope, name)).collect();
    let Some(driven) = driven else { return };
    for name in &environment.robots {
        let robot = scope.robot(&name.text);
        if robot.is_some_and(|robot| !driven.iter().any(|other| other.is(&robot))) {
            findings.push(Finding::new("idle-robot", &name.range));
        }
    }
}

/// The robot that a movement means where that is declared.
fn driven_robot<'a>(scope: Scope<'a>, movement: &Name) -> Option<Declared<'a, Robot>> {
    let movement = scope.movement(&movement.text)?;
    movement.home.robot(&movement.robot.text)
}

/// Two robots share a port, and V-REP serves one on each. Robots without a port, and those listed twice, are other
/// problems.
fn duplicate_port(scope: Scope<'_>, environment: &Environment, findings: &mut Vec<Finding>) {
    let mut earlier: Vec<Declared<'_, Robot>> = Vec::new();
    for name in &environment.robots {
        let Some(robot) = scope.robot(&name.text) else { continue };
        let Some(port) = port_number(&robot.port).filter(|_| !earlier.iter().any(|other| other.is(&robot)))
        else {
            continue;
        };
        if earlier.iter().any(|other| port_number(&other.port) == Some(port)) {
            findings.push(Finding::new("duplicate-port", &name.range));
        }
        earlier.push(robot);
    }
}

/// Maximal runs of consecutive `parallel` movements. Unknown movements separate them.
fn parallel_groups<'a>(scope: Scope<'_>, environment: &'a Environment) -> Vec<Vec<&'a Name>> {
    let mut groups = vec![Vec::new()];
    for name in &environment.movements {
        let is_parallel = scope.movement(&name.text).is_some_and(|movement| movement.parallel.is_some());
        match groups.last_mut() {
            Some(group) if is_parallel => group.push(name),
            _ => groups.push(Vec::new()),
        }
    }
    groups
}

/// Two movements of one robot in the same parallel group.
fn parallel_conflict(scope: Scope<'_>, environment: &Environment, findings: &mut Vec<Finding>) {
    for group in parallel_groups(scope, environment) {
        for (index, name) in group.iter().enumerate() {
            let Some(robot) = driven_robot(scope, name) else { continue };
            let mut earlier = group[..index].iter().filter_map(|earlier| driven_robot(scope, earlier));
            if earlier.any(|other| other.is(&robot)) {
                findings.push(Finding::new("parallel-conflict", &name.range));
            }
        }
    }
}

/// A `parallel` movement that never runs in parallel with another. A movement that never runs is unused instead, and an
/// unknown one may be parallel.
fn single_parallel(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    let program = scope.program();
    for entity in &program.entities {
        let Body::Movement(Movement { parallel: Some(parallel), .. }) = &entity.body else { continue };
        let may_be_parallel = |name: Option<&Name>| {
            let movement = name.map(|name| scope.movement(&name.text));
            movement.is_some_and(|movement| movement.is_none_or(|movement| movement.parallel.is_some()))
        };
        let (mut listed, mut accompanied) = (false, false);
        for (_, environment) in program.environments() {
            let names = &environment.movements;
            for place in (0..names.len()).filter(|place| names[*place].text == entity.name.text) {
                listed = true;
                let before = place.checked_sub(1).and_then(|before| names.get(before));
                accompanied |= may_be_parallel(before) || may_be_parallel(names.get(place + 1));
            }
        }
        if listed && !accompanied {
            findings.push(Finding::new("single-parallel", parallel));
        }
    }
}

/// The script's file would shadow a Python standard or client module or the runtime, is run by Python at start, is
/// reserved on Windows, or differs from another
/// script's only in case; the first environment with a valid name keeps it.
fn script_name(program: &Program, entity: &Entity, findings: &mut Vec<Finding>) {
    let name = entity.name.text.as_str();
    let is_taken = |name: &str| is_module(name) || is_reserved(name);
    let mut names = program.environments().map(|(other, _)| other.name.text.as_str());
    let keeper = names.find(|other| other.eq_ignore_ascii_case(name) && !is_taken(other));
    if is_taken(name) || keeper.is_some_and(|keeper| keeper != name) {
        findings.push(Finding::new("script-name", &entity.name.range));
    }
}

/// The modules of Python 3.11, of the clients of all targets, the runtime, and what Python runs at start.
fn is_module(name: &str) -> bool {
    const CLIENT: [&str; 8] =
        ["coppeliasim_zmqremoteapi_client", "zmq", "cbor", "cbor2", "sim", "simConst", "vrep", "vrepConst"];
    const OTHERS: [&str; 3] = ["pydslrep_runtime", "sitecustomize", "usercustomize"];
    const ROS: [&str; 7] = [
        "rclpy",
        "builtin_interfaces",
        "geometry_msgs",
        "nav_msgs",
        "rosgraph_msgs",
        "sensor_msgs",
        "std_msgs",
    ];
    let standard = include_str!("../../standard_modules.txt").split_whitespace();
    standard.chain(CLIENT).chain(OTHERS).chain(ROS).any(|module| module == name)
}

/// Device names on Windows, ignoring case.
fn is_reserved(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let numbered = |device: &str| {
        name.strip_prefix(device).is_some_and(|number| matches!(number.as_bytes(), [b'1'..=b'9']))
    };
    ["con", "prn", "aux", "nul"].contains(&name.as_str()) || numbered("com") || numbered("lpt")
}
