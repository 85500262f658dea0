//! `pydslrep doctor`: checks the scene of a running `CoppeliaSim`, or robots in ROS 2, against a program.

mod ros2;

use std::path::PathBuf;
use std::process::ExitCode;

use annotate_snippets::{Group, Level};
use clap::Args;
use pydslrep_analysis::FileId;
use pydslrep_analysis::environment::{Environment, Objects, SensorKind};
use pydslrep_config::{Config, Target};
use pydslrep_script::used_sensors;
use serde::{Deserialize, Serialize, Serializer};

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::{Inputs, program};
use crate::options::{Port, target_parser};
use crate::report::output;
use crate::run::interrupt;
use crate::run::scene_tasks::{Interpreter, carry_out};

const HELP: Help = Help {
    examples: &[
        ("pydslrep doctor patrol.pyr", "the CoppeliaSim on this machine"),
        ("pydslrep doctor patrol.pyr --host 192.168.0.7", "one on another machine"),
        ("pydslrep doctor patrol.pyr --port 23000", "on another port than the program says"),
        (
            "pydslrep doctor patrol.pyr --target ros2",
            "the drivers of the robots in ROS 2: topics, types, rates",
        ),
        (
            "pydslrep doctor patrol.pyr --target ros2 --drive",
            "and turn each robot in place, to measure its track",
        ),
        ("pydslrep doctor --target ros2", "the topics that are there"),
    ],
    notes: &[
        "It changes nothing, and may run beside a script that drives; only --drive moves robots. Exit codes: 0 nothing \
         is wrong, 1 findings, 2 it cannot connect. With --target ros2, your own Python looks: one that can import rclpy.",
    ],
};

/// Check the scene of a running CoppeliaSim, or robots in ROS 2, against a program: what is wrong, and what to do
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input; with --target ros2, all topics are listed without one
    #[arg(required_unless_present = "target")]
    program: Option<PathBuf>,
    /// The environment to check; required if there are several
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// What the robots are in [default: that of pydslrep.toml, else coppeliasim]
    #[arg(long, value_name = "TARGET", value_parser = target_parser())]
    target: Option<Target>,
    /// With the target ros2: the scene that says what the robots are like [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// With the target ros2: turn each robot by about 120 degrees to the left, in place, to measure its track
    #[arg(long)]
    drive: bool,
    /// Where CoppeliaSim runs [default: where the program says, else this machine]
    #[arg(long, value_name = "ADDRESS")]
    host: Option<String>,
    /// Port of its ZeroMQ remote API, for all robots or for one; may be repeated [default: those of the program]
    #[arg(long, value_name = "[ROBOT=]PORT", value_parser = Port::parse)]
    port: Vec<Port>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Hide progress
    #[arg(long)]
    no_progress: bool,
    /// The Python to connect with [default: python3]
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
}

#[derive(Debug, Serialize)]
struct Request<'a> {
    task: &'a str,
    robots: Vec<Robot<'a>>,
}

#[derive(Debug, Deserialize)]
struct Answer {
    /// True if the simulator replied.
    reached: bool,
    findings: Vec<Finding>,
}

/// A robot as scripts declare it: `RobotSpec` of the package that they import.
#[derive(Debug, Serialize)]
struct Robot<'a> {
    name: &'a str,
    host: &'a str,
    port: u16,
    /// Their radii in metres by name, in the order of the drive.
    #[serde(serialize_with = "as_map")]
    wheels: Vec<(&'a str, f64)>,
    sensors: Vec<&'a str>,
    bumpers: Vec<&'a str>,
    /// Paths in the scene, by name.
    objects: &'a Objects,
}

/// A problem of a scene.
#[derive(Debug, Serialize, Deserialize)]
struct Finding {
    code: String,
    severity: Severity,
    robot: Option<String>,
    message: String,
    help: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Severity {
    Error,
    Warning,
    Hint,
}

/// Runs the command.
///
/// # Errors
/// If the program cannot be read or Python cannot be started.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let Some(program) = &arguments.program else {
        return match arguments.target {
            Some(Target::Ros2) => ros2::list(arguments),
            _ => Err(Failure::new("there is no program to check against")
                .help("name one: `pydslrep doctor PROGRAM`")),
        };
    };
    let (mut inputs, file) = Inputs::open_one(program, &Config::of_target(arguments.target))?;
    match inputs.settings(file).target {
        Target::Ros2 => ros2::check_program(arguments, &mut inputs, file),
        target => check_scene(arguments, &inputs, file, target),
    }
}

/// Checks the scene of a simulator.
fn check_scene(
    arguments: &Arguments,
    inputs: &Inputs,
    file: FileId,
    target: Target,
) -> Result<ExitCode, Failure> {
    if arguments.drive || arguments.scene.is_some() {
        return Err(Failure::new("--drive and --scene are for the target ros2")
            .help("`--target ros2` checks robots in ROS 2"));
    }
    if target == Target::VRep && arguments.target.is_some() {
        return Err(Failure::new("the legacy remote API of V-REP cannot be asked about a scene")
            .help("open the scene in CoppeliaSim, and leave --target out"));
    }
    let id = program::environment(inputs, file, arguments.environment.as_deref())?;
    let Some(environment) = program::prepare(inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let host = environment.host.map_or_else(|| "127.0.0.1".to_owned(), |host| host.to_string());
    let host = arguments.host.as_deref().unwrap_or(&host);
    let ports = Port::of_robots(&arguments.port, &environment)?;
    let robots = robots(&environment, host, &ports);
    let interpreter = Interpreter { chosen: arguments.python.as_deref(), quiet: arguments.no_progress };
    let Some(answer) = carry_out::<Answer>(interpreter, &Request { task: "doctor", robots })? else {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    print(arguments, &answer.findings, "the scene fits the program")?;
    Ok(exit_code(answer.reached, &answer.findings))
}

/// Prints findings for people or programs; `all_well` if there is none.
fn print(arguments: &Arguments, findings: &[Finding], all_well: &str) -> Result<(), Failure> {
    output::print(&if arguments.json { output::json(findings)? } else { report(findings, all_well) })
}

fn exit_code(reached: bool, findings: &[Finding]) -> ExitCode {
    let is_wrong = findings.iter().any(|finding| finding.severity != Severity::Hint);
    ExitCode::from(if reached { u8::from(is_wrong) } else { Failure::EXIT_CODE })
}

fn as_map<S: Serializer>(pairs: &[(&str, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().copied())
}

fn robots<'a>(environment: &'a Environment, host: &'a str, ports: &[u16]) -> Vec<Robot<'a>> {
    let used = used_sensors(environment);
    let robots = environment.robots.iter().zip(ports).zip(used);
    let robots = robots.map(|((robot, &port), used)| {
        let names = |kind: SensorKind| {
            let used = used.iter().map(|&sensor| &robot.sensors[sensor]);
            used.filter(|sensor| sensor.kind == kind).map(|sensor| sensor.name.as_str()).collect()
        };
        Robot {
            name: &robot.name,
            host,
            port,
            wheels: robot.wheels.iter().map(|wheel| (wheel.name.as_str(), wheel.radius)).collect(),
            sensors: names(SensorKind::Distance),
            bumpers: names(SensorKind::Bumper),
            objects: &robot.objects,
        }
    });
    robots.collect()
}

fn report(findings: &[Finding], all_well: &str) -> String {
    if findings.is_empty() {
        return format!("{all_well}\n");
    }
    let mut text = String::new();
    for Finding { code, severity, robot, message, help } in findings {
        let level = match severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Hint => Level::NOTE.with_name("hint"),
        };
        let title = match robot {
            Some(robot) => format!("robot {robot}: {message}"),
            None => message.clone(),
        };
        let group = Group::with_title(level.primary_title(&title).id(code));
        let group = group.element(Level::HELP.message(help));
        text += &format!("{}\n\n", output::renderer().render(&[group]));
    }
    let count = |severity: Severity, noun: &str| {
        let number = findings.iter().filter(|finding| finding.severity == severity).count();
        (number > 0).then(|| output::count(number, noun))
    };
    let counts =
        [count(Severity::Error, "error"), count(Severity::Warning, "warning"), count(Severity::Hint, "hint")];
    let counts: Vec<String> = counts.into_iter().flatten().collect();
    format!("{text}{}\n", counts.join(", "))
}
