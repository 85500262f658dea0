//! `pydslrep replay`: a recorded run, drawn over its plan or alone.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use pydslrep_bag::RobotTopics;
use pydslrep_config::{Config, Edition};
use pydslrep_kinematics::{Drive, TimedPose};
use pydslrep_output::check_outputs;
use pydslrep_picture::{Picture, Route};
use pydslrep_scene::defaults;
use pydslrep_trace::{Map, Track};

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::{Inputs, program};
use crate::options::edition_parser;
use crate::report::numbers::{fixed, heading};
use crate::report::output;
use crate::run::driven::{self, Driven};
use crate::run::outcome::Outcome;
use crate::run::pictures::Pictures;
use crate::run::planned::PlannedEnvironment;
use crate::run::record::Record;
use crate::run::reporter::Reporter;
use crate::run::trace_file;

const HELP: Help = Help {
    examples: &[
        ("pydslrep replay driven.jsonl", "where the robots of a trace went"),
        ("pydslrep replay run.mcap patrol.pyr --picture run.svg", "over the planned path"),
        ("pydslrep replay rosbag2_2026_11_26 patrol.pyr", "a bag that a robot's computer has recorded"),
        ("pydslrep replay run.mcap --replay run.svg", "an animated SVG for a browser"),
    ],
    notes: &[
        "A record is what `pydslrep run --trace FILE` or `pydslrep sim --trace FILE` has written, an MCAP file of ROS 2, \
         or the folder that `ros2 bag record -s mcap` makes. Of a bag, odometry, poses and ranges are read; with a program, \
         its robots have the topics that its scene says.",
    ],
};

/// Show a recorded run, and compare it with the plan of a program
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A trace as JSON lines or MCAP, or the folder of a bag
    record: PathBuf,
    /// The program that was run, or `-` for standard input
    program: Option<PathBuf>,
    /// The environment that was run; required if there are several
    #[arg(long, value_name = "NAME", requires = "program")]
    environment: Option<String>,
    /// Which statements a program may have [default: that of pydslrep.toml, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser(), requires = "program")]
    edition: Option<Edition>,
    #[command(flatten)]
    pictures: Pictures,
    /// The scene that it ran in [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE", requires = "program")]
    scene: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If the record or the program cannot be read or nothing can be written.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    match &arguments.program {
        Some(program) => compare(arguments, program),
        None => show(arguments),
    }
}

fn read(arguments: &Arguments) -> Result<Record, Failure> {
    let record = Record::read(&arguments.record)?;
    if record.is_truncated {
        let shown = arguments.record.display();
        output::warning(&format!("{shown} ends in the middle of a step: the rest was not recorded"), None);
    }
    Ok(record)
}

/// Shows a record with the plan of its program.
fn compare(arguments: &Arguments, program: &Path) -> Result<ExitCode, Failure> {
    let (mut inputs, file) = Inputs::open_one(program, &Config::of_edition(arguments.edition))?;
    let id = program::environment(&inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let read_paths = inputs.read_paths();
    let read_paths: Vec<&Path> = read_paths.iter().map(AsRef::as_ref).chain([&*arguments.record]).collect();
    check_outputs(&arguments.pictures.outputs().collect::<Vec<_>>(), &read_paths)?;
    let Some(environment) = program::prepare(&inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let scene = inputs.scene(file, &environment)?;
    let mut planned = PlannedEnvironment::new(environment, scene)?;
    let driven = driven(arguments, &planned)?;
    planned.start_from(&driven)?;
    let outcome = Outcome { planned: &planned, driven: &driven, wall: None, is_complete: true };
    output::print(&outcome.figures().table())?;
    planned.draw(&arguments.pictures, "planned and driven path", &outcome.routes())?;
    arguments.pictures.report(&Reporter::for_people());
    Ok(ExitCode::SUCCESS)
}

/// Returns the paths that the robots of a program drove, from a record.
fn driven(arguments: &Arguments, planned: &PlannedEnvironment) -> Result<Driven, Failure> {
    let record = read(arguments)?;
    let recorded = record.robots();
    let mut topics: Vec<RobotTopics> = planned.scene.robots.iter().map(trace_file::topics).collect();
    let mut driven = Driven::new(&planned.scene.robots, Vec::new());
    driven.extend(&record.steps(&mut topics));
    let missing = planned.scene.robots.iter().zip(driven.tracks()).filter(|(_, track)| track.end().is_none());
    let missing: Vec<String> = missing.map(|(robot, _)| format!("`{}`", robot.name)).collect();
    let (shown, recorded) = (arguments.record.display(), recorded.join(", "));
    if missing.len() == planned.scene.robots.len() {
        let environment = &planned.environment.name;
        return Err(Failure::new(format!("{shown} has no robot of `{environment}`, but these: {recorded}")).help(
            "topics are those of [robots.NAME.ros2] in the scene; without a program, all robots are shown",
        ));
    }
    if !missing.is_empty() {
        output::warning(
            &format!("{shown} does not have {}, but these: {recorded}", missing.join(", ")),
            None,
        );
    }
    Ok(driven)
}

/// Shows a record of robots of which nothing else is known.
fn show(arguments: &Arguments) -> Result<ExitCode, Failure> {
    check_outputs(&arguments.pictures.outputs().collect::<Vec<_>>(), &[&arguments.record])?;
    let (names, steps) = read(arguments)?.all_steps();
    let mut table =
        output::table(["robot", "from x m", "y m", "heading °", "to x m", "y m", "heading °", "way m"]);
    let mut routes = Vec::new();
    let mut seconds: f64 = 0.0;
    for name in names {
        let mut track = Track::new(driven::FINENESS);
        for step in steps.iter().filter(|step| step.robot == name) {
            seconds = seconds.max(step.t);
            track.add(step.timed_pose());
        }
        let poses = track.poses();
        if let (Some(from), Some(to)) = (track.start(), track.end()) {
            let [from, to] = [from, to].map(|pose| [fixed(pose.x, 3), fixed(pose.y, 3), heading(pose.theta)]);
            table.add_row([std::slice::from_ref(&name), &from[..], &to, &[fixed(way(&poses), 3)]].concat());
        }
        routes.push(route(name, poses));
    }
    output::align_right(&mut table, &[1, 2, 3, 4, 5, 6, 7]);
    output::print(&format!("{}\n\n{} s recorded\n", table.trim_fmt(), fixed(seconds, 1)))?;
    let title = arguments.record.file_name().unwrap_or_default().to_string_lossy();
    let picture = Picture { title: &title, routes: &routes, obstacles: &[], collisions: &[] };
    arguments.pictures.draw(&picture)?;
    arguments.pictures.report(&Reporter::for_people());
    Ok(ExitCode::SUCCESS)
}

/// The length of a path, metres.
fn way(poses: &[TimedPose]) -> f64 {
    poses.windows(2).map(|pair| pair[0].pose.distance(&pair[1].pose)).sum()
}

/// A route without a plan; the robot is drawn as large as one is by default.
fn route(name: String, driven: Vec<TimedPose>) -> Route {
    Route {
        name,
        body: defaults::body(Drive::TwoWheel),
        planned: Vec::new(),
        unknown_after: false,
        possible: Vec::new(),
        driven,
        seen: Vec::new(),
        map: Map::default(),
    }
}
