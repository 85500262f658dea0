//! `pydslrep plan`: planned poses and times, without a simulator.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use comfy_table::{ColumnConstraint, ContentArrangement};
use pydslrep_analysis::environment::Environment;
use pydslrep_config::{Config, Edition};
use pydslrep_kinematics::{ActionIndex, Leg, Place, Pose, RobotPath};
use pydslrep_output::{Kind, check_outputs, write_output};
use pydslrep_scene::{Collision, Scene, SceneObject, collisions, mjcf};
use serde::Serialize;

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::Inputs;
use crate::inputs::program;
use crate::options::edition_parser;
use crate::report::numbers::{fixed, heading};
use crate::report::output;
use crate::run::pictures::Pictures;
use crate::run::planned::PlannedEnvironment;
use crate::run::reporter::Reporter;

const HELP: Help = Help {
    examples: &[
        ("pydslrep plan patrol.pyr", ""),
        ("pydslrep plan patrol.pyr --json", ""),
        ("pydslrep plan patrol.pyr --picture patrol.svg", ""),
        ("pydslrep plan patrol.pyr --replay patrol.svg", "an animated SVG for a browser"),
        (
            "pydslrep plan patrol.pyr --mjcf yard.xml",
            "the world for MuJoCo, and for scripts that you start yourself",
        ),
    ],
    notes: &[],
};

/// Show the planned path of each robot: poses, times and wheel rates
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input
    program: PathBuf,
    /// Only the environment of this name
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Which statements a program may have [default: that of pydslrep.toml, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser())]
    edition: Option<Edition>,
    #[command(flatten)]
    pictures: Pictures,
    /// Write the world for MuJoCo, as MJCF
    #[arg(long, value_name = "FILE")]
    mjcf: Option<PathBuf>,
    /// The scene to plan in [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
}

impl Arguments {
    /// The files to write.
    fn outputs(&self) -> impl Iterator<Item = (&Path, Kind)> {
        self.pictures.outputs().chain(self.mjcf.iter().map(|path| (path.as_path(), Kind::World)))
    }
}

/// Runs the command.
///
/// # Errors
/// If the program cannot be read or nothing can be written.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (mut inputs, file) = Inputs::open_one(&arguments.program, &Config::of_edition(arguments.edition))?;
    let ids = program::environments(&inputs, file, arguments.environment.as_deref());
    if ids.is_empty() || arguments.outputs().next().is_some() || arguments.scene.is_some() {
        // A picture or a world is of one environment, as a scene is; and where there is none, this says which there are.
        program::environment(&inputs, file, arguments.environment.as_deref())?;
    }
    if let (Some(scene), [id, ..]) = (&arguments.scene, ids.as_slice()) {
        inputs.use_scene(file, *id, scene)?;
    }
    check_outputs(&arguments.outputs().collect::<Vec<_>>(), &inputs.read_paths())?;
    let prepared = program::prepare(&inputs, file, &ids);
    let planned = |environment: Environment| {
        let scene = inputs.scene(file, &environment)?;
        PlannedEnvironment::new(environment, scene)
    };
    let plans: Vec<PlannedEnvironment> =
        prepared.environments.into_iter().map(planned).collect::<Result<_, _>>()?;
    output::print(&if arguments.json { json(&plans)? } else { plans.iter().map(table).collect() })?;
    if let Some(planned) = plans.first() {
        planned.draw(&arguments.pictures, "planned path", &planned.routes())?;
        arguments.pictures.report(&Reporter::for_people());
        if let Some(path) = &arguments.mjcf {
            write_output(path, Kind::World, mjcf(&planned.scene, &planned.plan.robots).as_bytes())?;
            output::say(&format!("world: {}\n", path.display()));
        }
    }
    Ok(ExitCode::from(u8::from(prepared.has_errors)))
}

/// The cells of a row: an action, when it ends, the pose at its end, and the wheel rates.
type Row = [String; 6];

const HEAD: [&str; 6] = ["action", "at s", "x m", "y m", "heading °", "wheels rad/s"];

/// Between two columns.
const GAP: usize = 2;

/// A narrower column is hard to read.
const MIN_COLUMNS: usize = 16;

/// Actions that begin within this many seconds of each other begin together.
const AT_ONCE: f64 = 0.005;

fn table(planned: &PlannedEnvironment) -> String {
    let duration = match planned.plan.duration {
        Some(seconds) => format!("{} s", fixed(seconds, 2)),
        None => "duration unknown until it runs: values marked ? depend on sensors".to_owned(),
    };
    let title = output::wrapped(&format!("{}: {duration}", planned.environment.name));
    let robots = planned.scene.robots.iter().zip(&planned.plan.robots);
    let rows: Vec<Row> = robots.flat_map(|(robot, path)| rows(planned, &robot.name, path)).collect();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([HEAD[column].chars().count()]).max().unwrap_or(0) + GAP
    };
    let others: usize = (1..HEAD.len()).map(width).sum();
    let last = HEAD.len() - 1;
    let left = |others: usize| output::columns().saturating_sub(others + 1);
    // On a narrow terminal, wheel rates are below their action.
    let is_narrow = left(others) < MIN_COLUMNS;
    let columns = if is_narrow { left(others - width(last)) } else { left(others) }.max(MIN_COLUMNS);
    let mut table = output::table(HEAD);
    table.set_content_arrangement(ContentArrangement::Disabled);
    for [what, at, x, y, heading, rates] in rows {
        let mut action = indented(&what, columns);
        if is_narrow && !rates.is_empty() {
            let rates: Vec<&str> = rates.split_whitespace().collect();
            action += &format!("\n{}", indented(&format!("      {} rad/s", rates.join(" ")), columns));
        }
        table.add_row([action, at, x, y, heading, rates]);
    }
    output::align_right(&mut table, &[1, 2, 3, 4]);
    if let Some(wheels) = table.column_mut(last).filter(|_| is_narrow) {
        wheels.set_constraint(ColumnConstraint::Hidden);
    }
    let contacts: String = collisions(&planned.scene, &planned.plan)
        .iter()
        .map(|collision| output::wrapped(&meeting(planned, collision)) + "\n")
        .collect();
    let contacts = if contacts.is_empty() { contacts } else { contacts + "\n" };
    format!("{title}\n\n{}\n\n{contacts}", table.trim_fmt())
}

/// Text wrapped to a width; continuation lines keep its indentation and two columns more.
fn indented(text: &str, columns: usize) -> String {
    let words = text.trim_start();
    let indentation = " ".repeat(text.len() - words.len());
    let later = format!("{indentation}  ");
    let options = textwrap::Options::new(columns).initial_indent(&indentation).subsequent_indent(&later);
    textwrap::fill(words, options)
}

/// The rows of a robot: its start, its movements, and the actions of each.
fn rows(planned: &PlannedEnvironment, robot: &str, path: &RobotPath) -> Vec<Row> {
    let row = |what: String, at: String, pose: Pose, rates: String| {
        [what, at, fixed(pose.x, 3), fixed(pose.y, 3), heading(pose.theta), rates]
    };
    let title =
        |what: String| [what, String::new(), String::new(), String::new(), String::new(), String::new()];
    let mut rows = vec![row(robot.to_owned(), fixed(0.0, 2), path.start, String::new())];
    let mut run = None;
    let mut begin = |rows: &mut Vec<Row>, index: ActionIndex, place: &Place| {
        let (movement, action) = planned.words(index, place);
        if run.replace((index.group, index.run)) != Some((index.group, index.run)) {
            rows.push(title(format!("  {movement}")));
        }
        action
    };
    let mut ended = Some(0.0);
    for leg in &path.legs {
        if let (Some(start), Some(end)) = (leg.start, ended)
            && start - end > AT_ONCE
        {
            rows.push(row("  (waits for others)".to_owned(), fixed(start, 2), leg.from, String::new()));
        }
        ended = leg.end();
        let action = begin(&mut rows, leg.index, &leg.place);
        let rates: Vec<String> = leg.rates.iter().map(|rate| format!("{:>5}", fixed(*rate, 2))).collect();
        rows.push(row(format!("    {action}"), time(leg.end()), leg.to, rates.join(" ")));
    }
    if let Some(index) = path.unknown_after {
        let action = begin(&mut rows, index, &path.unknown_place);
        let [at, x, y, heading] = ["?"; 4].map(str::to_owned);
        rows.push([format!("    {action}"), at, x, y, heading, String::new()]);
    }
    rows
}

/// A collision in a sentence.
fn meeting(planned: &PlannedEnvironment, collision: &Collision) -> String {
    let (movement, action) = planned.words(collision.action, &collision.place);
    let time = collision.time.map_or_else(String::new, |time| format!(" after {} s", fixed(time, 2)));
    let (x, y) = (fixed(collision.pose.x, 3), fixed(collision.pose.y, 3));
    let doing = collision.other_action.map_or_else(String::new, |index| {
        let (movement, action) = planned.words(index, &collision.other_place);
        format!(" (`{action}` of `{movement}`)")
    });
    format!(
        "{} runs into `{}`{doing}{time}: `{action}` of `{movement}`, at x {x} m, y {y} m",
        object_name(&planned.scene, SceneObject::Robot(collision.robot)),
        object_name(&planned.scene, collision.with),
    )
}

/// The name of an obstacle or a robot.
fn object_name(scene: &Scene, object: SceneObject) -> &str {
    match object {
        SceneObject::Obstacle(index) => scene.obstacles.get(index).map_or("", |obstacle| &obstacle.name),
        SceneObject::Robot(index) => scene.robots.get(index).map_or("", |robot| &robot.name),
    }
}

fn time(seconds: Option<f64>) -> String {
    seconds.map_or_else(|| "?".to_owned(), |seconds| fixed(seconds, 2))
}

#[derive(Serialize)]
struct JsonPlan<'a> {
    environment: &'a str,
    robots: Vec<JsonRobot<'a>>,
    /// Seconds.
    duration: Option<f64>,
    collisions: Vec<JsonCollision<'a>>,
}

/// A collision: seconds, metres, radians.
#[derive(Serialize)]
struct JsonCollision<'a> {
    robot: &'a str,
    #[serde(flatten)]
    pose: JsonPose<'a>,
    with: JsonCollisionTarget<'a>,
}

/// The obstacle or robot that a robot collides with.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum JsonCollisionTarget<'a> {
    Obstacle(&'a str),
    Robot(&'a str),
}

#[derive(Serialize)]
struct JsonRobot<'a> {
    name: &'a str,
    poses: Vec<JsonPose<'a>>,
    unknown_after: Option<JsonAction<'a>>,
    /// The ways that it may take from there, as far as they have a bound: ends of actions, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    possible: Vec<Vec<JsonPose<'a>>>,
    /// True if more actions are planned than are listed.
    #[serde(skip_serializing_if = "is_false")]
    truncated: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_false(value: &bool) -> bool {
    !value
}

/// Where an action is.
#[derive(Serialize)]
struct JsonAction<'a> {
    movement: &'a str,
    /// Among all movements that the environment runs, from 1, in the order it lists them.
    run: usize,
    /// The number of its statement in its movement, from 1: the listed one, or the last that is done.
    action: usize,
    /// In the file of that movement, from 1.
    line: u32,
    /// Of the repetitions that it is in, from 1, the outermost first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rounds: Vec<u32>,
    /// The statements that lead to it by `do`, the outermost first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    calls: Vec<JsonCall<'a>>,
}

/// A statement that does another movement.
#[derive(Serialize)]
struct JsonCall<'a> {
    movement: &'a str,
    action: usize,
}

/// Where a robot is at the end of an action, or during it: seconds, metres, radians.
#[derive(Serialize)]
struct JsonPose<'a> {
    #[serde(flatten)]
    action: JsonAction<'a>,
    t: Option<f64>,
    x: f64,
    y: f64,
    theta: f64,
}

fn json(plans: &[PlannedEnvironment]) -> Result<String, Failure> {
    let plans: Vec<JsonPlan> = plans.iter().map(json_plan).collect();
    output::json(&plans)
}

fn json_plan(planned: &PlannedEnvironment) -> JsonPlan<'_> {
    let robots = planned.environment.robots.iter().zip(&planned.plan.robots);
    let poses = |legs: &[Leg]| legs.iter().map(|leg| json_pose(planned, leg)).collect();
    let robots = robots.map(|(robot, path)| JsonRobot {
        name: &robot.name,
        poses: poses(&path.legs),
        unknown_after: path.unknown_after.map(|index| json_action(planned, index, &path.unknown_place)),
        possible: path.possible.iter().map(|way| poses(way)).collect(),
        truncated: path.truncated,
    });
    JsonPlan {
        environment: &planned.environment.name,
        robots: robots.collect(),
        duration: planned.plan.duration,
        collisions: collisions(&planned.scene, &planned.plan)
            .iter()
            .map(|collision| json_collision(planned, collision))
            .collect(),
    }
}

fn json_collision<'a>(planned: &'a PlannedEnvironment, collision: &Collision) -> JsonCollision<'a> {
    let name = object_name(&planned.scene, collision.with);
    let with = match collision.with {
        SceneObject::Obstacle(_) => JsonCollisionTarget::Obstacle(name),
        SceneObject::Robot(_) => JsonCollisionTarget::Robot(name),
    };
    let Pose { x, y, theta } = collision.pose;
    let action = json_action(planned, collision.action, &collision.place);
    let robot = object_name(&planned.scene, SceneObject::Robot(collision.robot));
    JsonCollision { robot, pose: JsonPose { action, t: collision.time, x, y, theta }, with }
}

fn json_pose<'a>(planned: &'a PlannedEnvironment, leg: &Leg) -> JsonPose<'a> {
    let action = json_action(planned, leg.index, &leg.place);
    JsonPose { action, t: leg.end(), x: leg.to.x, y: leg.to.y, theta: leg.to.theta }
}

fn json_action<'a>(planned: &'a PlannedEnvironment, index: ActionIndex, place: &Place) -> JsonAction<'a> {
    let before = planned.environment.schedule.iter().take(index.group).map(Vec::len).sum::<usize>();
    let found = planned.environment.place(index, place);
    let calls = found.iter().flat_map(|found| &found.calls);
    JsonAction {
        movement: found.as_ref().map_or("", |found| found.movement),
        run: before + index.run + 1,
        action: index.action + 1,
        line: found.as_ref().map_or(0, |found| found.source.line),
        calls: calls.map(|call| JsonCall { movement: call.movement, action: call.number }).collect(),
        rounds: found.map(|found| found.rounds).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_analysis::{Database, scene};
    use serde_json::Value;

    use super::*;

    #[test]
    fn a_list_that_ends_early_says_so() {
        let program = "wheel a with radius 4 wheel b with radius 4 robot r type tw with port 1 has { a b } wheels\n\
            movement m of r { move 1 meters } environment e has { r } robots with { m } moves";
        let mut database = Database::new();
        let file = database.open("x.pyr", program);
        let environment = database.environment(database.environments(file)[0].0).unwrap();
        let scene = scene(&environment);
        let Ok(mut planned) = PlannedEnvironment::new(environment, scene) else {
            panic!("it can be planned")
        };
        for truncated in [None, Some(Value::Bool(true))] {
            planned.plan.robots[0].truncated = truncated.is_some();
            let Ok(text) = json(std::slice::from_ref(&planned)) else { panic!("it can be written") };
            let plans: Value = serde_json::from_str(&text).unwrap();
            assert_eq!(plans[0]["robots"][0].get("truncated"), truncated.as_ref());
        }
    }
}
