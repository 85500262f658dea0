//! `pydslrep sim`: the embedded simulator alone, for scripts that you start yourself.

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;
use pydslrep_analysis::environment::Environment;
use pydslrep_config::Config;
use pydslrep_output::check_outputs;
use pydslrep_scene::{Robot, Scene, defaults};
use pydslrep_script::file_name;
use pydslrep_simulator::{Options, Server, Simulator};
use tokio::time::{MissedTickBehavior, interval};

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::Inputs;
use crate::inputs::program;
use crate::options::{Engine, above_zero, server_parser};
use crate::report::output;
use crate::run::interrupt;
use crate::run::ros2_world::{self, Node, World};
use crate::run::trace_file::{self, TraceFile};

const HELP: Help = Help {
    examples: &[
        ("pydslrep sim patrol.pyr", "serves the port of each robot, until Ctrl+C"),
        ("python3 yard.py", "in another terminal: the script of the program"),
        ("pydslrep sim patrol.pyr --trace driven.jsonl", "also write the poses of the robots"),
        ("pydslrep sim patrol.pyr --ros2", "as a node of ROS 2: for `pydslrep run patrol.pyr --target ros2`"),
        ("pydslrep sim patrol.pyr --ros2 --engine mujoco", "the same with physics: wheels roll by friction"),
        ("pydslrep sim --empty", "as CoppeliaSim starts: for `pydslrep scene push`"),
    ],
    notes: &[
        "Scripts of both targets can connect at the same time: the first message of a client tells which \
         remote API it uses. Scripts step the simulation; while none does, it runs by itself. The wheels of \
         a script that disconnects stop.",
        "With --ros2 it is a node of ROS 2 instead: it takes cmd_vel and publishes odom, range and /clock. Its Python \
         needs rclpy, and the CoppeliaSim client library (coppeliasim-zmqremoteapi-client) or, with --engine mujoco, MuJoCo.",
    ],
};

/// The interval at which the trace is written.
const WRITE_PERIOD: Duration = Duration::from_millis(50);

/// Start the embedded simulator alone, for scripts of your own
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input
    #[arg(required_unless_present = "empty")]
    program: Option<PathBuf>,
    /// Start with an empty floor instead of a program; clients such as `pydslrep scene push` create robots and obstacles
    #[arg(long, conflicts_with_all = ["program", "environment", "scene"])]
    empty: bool,
    /// The port of an empty floor; 0 is any free one
    #[arg(long, value_name = "PORT", default_value_t = 23000, requires = "empty")]
    port: u16,
    /// The environment to simulate; required if there are several
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// The scene to simulate [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// The seed of the scene's noise: the same seed gives the same run
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// What moves the robots; MuJoCo needs --ros2
    #[arg(long, value_name = "ENGINE", default_value = "embedded")]
    engine: Engine,
    /// The server to imitate, to test scripts for it: how it treats clients while paused, and those that are lost
    #[arg(long, value_name = "SERVER", default_value = "embedded", value_parser = server_parser(), conflicts_with = "ros2")]
    server: Server,
    /// The address to listen on; the default accepts connections from this machine only
    #[arg(long, value_name = "ADDRESS", default_value_t = Ipv4Addr::LOCALHOST.into())]
    listen: IpAddr,
    /// Simulated seconds per second while no script steps the simulation
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = above_zero)]
    speed: f64,
    /// Write every step to a file: as JSON lines or, where its name ends in .mcap, as messages of ROS 2; it is called FILE.partial until the simulator stops
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Be a node of ROS 2, with the topics of the scene, in place of the ports
    #[arg(long, conflicts_with_all = ["empty", "listen"])]
    ros2: bool,
    /// With --ros2: a script that runs with --sim-time takes the steps, so that runs do not depend on the machine
    #[arg(long, requires = "ros2")]
    lockstep: bool,
    /// The Python of the node, which can import rclpy [default: python3]
    #[arg(long, value_name = "PATH", requires = "ros2")]
    python: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If anything outside of the program fails.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.engine == Engine::MuJoCo {
        check_mujoco(arguments)?;
    }
    match &arguments.program {
        Some(program) => simulate(arguments, program),
        None => simulate_empty_floor(arguments),
    }
}

/// Refuses options that `MuJoCo` does not have: it has no ports, and is in the process of the node.
fn check_mujoco(arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.ros2 {
        return Err(Failure::new("--engine mujoco has no ports for scripts: it needs --ros2")
            .help("`pydslrep run --engine mujoco` drives in it without `pydslrep sim`"));
    }
    if arguments.trace.is_some() {
        return Err(Failure::new("--trace is of the embedded simulator, not of MuJoCo")
            .help("`pydslrep run --trace FILE` writes what the script sees"));
    }
    Ok(())
}

/// Serves a floor that clients build something on.
fn simulate_empty_floor(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.trace.as_deref().is_some_and(trace_file::is_bag) {
        return Err(Failure::new("a trace in MCAP needs to know the robots, and there is no program")
            .help("use a name that does not end in .mcap"));
    }
    let trace = trace(arguments, &[] as &[&Path], &[])?;
    let scene = Scene { seed: arguments.seed.unwrap_or(defaults::SEED), ..Scene::default() };
    serve(arguments, scene, vec![arguments.port], trace, None, |ports| {
        let port = ports.first().copied().unwrap_or(arguments.port);
        format!("Ready at {}:{port}. Press Ctrl+C to stop.\n", arguments.listen)
    })
}

fn simulate(arguments: &Arguments, program: &Path) -> Result<ExitCode, Failure> {
    let (mut inputs, file) = Inputs::open_one(program, &Config::default())?;
    let id = program::environment(&inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let Some(environment) = program::prepare(&inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let script = inputs.script_folder(file).map(|folder| folder.join(file_name(&environment)));
    let mut scene = inputs.scene(file, &environment)?;
    scene.seed = arguments.seed.unwrap_or(scene.seed);
    let trace = trace(arguments, &inputs.read_paths(), &scene.robots)?;
    if arguments.ros2 {
        let choice = ros2_world::Choice {
            python: arguments.python.as_deref(),
            speed: arguments.speed,
            lockstep: arguments.lockstep,
        };
        if arguments.engine == Engine::MuJoCo {
            return run_node(&choice, &scene, &ros2_steps(arguments, program));
        }
        let ports = vec![0; environment.robots.len()];
        return serve(arguments, scene, ports, trace, Some(choice), |_| ros2_steps(arguments, program));
    }
    let ports = environment.robots.iter().map(|robot| robot.port).collect();
    serve(arguments, scene, ports, trace, None, |_| {
        let mut places = output::table(["robot", "address", "port"]);
        for robot in &environment.robots {
            places.add_row([robot.name.clone(), arguments.listen.to_string(), robot.port.to_string()]);
        }
        let next = next_steps(arguments, program, &environment, script.as_deref());
        format!("{}\n\n{next}", places.trim_fmt())
    })
}

/// The trace to write, if any.
fn trace(
    arguments: &Arguments,
    inputs: &[impl AsRef<Path>],
    robots: &[Robot],
) -> Result<Option<TraceFile>, Failure> {
    let Some(path) = &arguments.trace else { return Ok(None) };
    check_outputs(&[(path, trace_file::kind(path))], inputs)?;
    TraceFile::begin(path, robots).map(Some)
}

/// Runs the simulator until an interrupt, as a node of ROS 2 if that is chosen; `greeting` gets its ports.
fn serve(
    arguments: &Arguments,
    scene: Scene,
    ports: Vec<u16>,
    mut trace: Option<TraceFile>,
    node: Option<ros2_world::Choice<'_>>,
    greeting: impl FnOnce(&[u16]) -> String,
) -> Result<ExitCode, Failure> {
    let robots = scene.robots.clone();
    let token = node.as_ref().map(|_| format!("{}-ros2", std::process::id()));
    let options = Options {
        token: token.clone(),
        address: arguments.listen,
        ports,
        speed: arguments.speed,
        trace: trace.is_some(),
        server: arguments.server,
        ..Options::default()
    };
    interrupt::run("start the simulator", async |mut interrupts| {
        let simulator = Simulator::start(scene, &options).map_err(|error| Failure::new(error.to_string()))?;
        let mut node = match node.zip(token) {
            Some((choice, token)) => tokio::select! {
                node = Node::start(&choice, &robots, World::Embedded { ports: simulator.ports(), token: &token }) => Some(node?),
                () = interrupts.next() => return Ok(()),
            },
            None => None,
        };
        output::print(&greeting(simulator.ports()))?;
        let mut writes = interval(WRITE_PERIOD);
        writes.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = interrupts.next() => break,
                failure = ended(&mut node) => return Err(failure),
                _ = writes.tick(), if trace.is_some() => if let Some(trace) = &mut trace {
                    trace.add(&simulator.take_trace())?;
                },
            }
        }
        if let Some(node) = node {
            node.stop().await;
        }
        let rest = simulator.stop();
        let Some(mut trace) = trace else { return Ok(()) };
        trace.add(&rest)?;
        trace.finish()
    })?;
    Ok(ExitCode::from(interrupt::EXIT_CODE))
}

/// Runs a node with `MuJoCo` in it until an interrupt.
fn run_node(choice: &ros2_world::Choice<'_>, scene: &Scene, greeting: &str) -> Result<ExitCode, Failure> {
    interrupt::run("start the simulator", async |mut interrupts| {
        let mut node = tokio::select! {
            node = Node::start(choice, &scene.robots, World::MuJoCo(scene)) => node?,
            () = interrupts.next() => return Ok(()),
        };
        output::print(greeting)?;
        tokio::select! {
            () = interrupts.next() => {}
            failure = node.ended() => return Err(failure),
        }
        node.stop().await;
        Ok(())
    })?;
    Ok(ExitCode::from(interrupt::EXIT_CODE))
}

/// Resolves when there is a node that has ended by itself.
async fn ended(node: &mut Option<Node>) -> Failure {
    match node {
        Some(node) => node.ended().await,
        None => std::future::pending().await,
    }
}

/// Returns the hints for stopping the node and for running a script that drives in it.
fn ros2_steps(arguments: &Arguments, program: &Path) -> String {
    let option = |name: &str, value: Option<&Path>| {
        value.map(|value| format!(" {name} {}", quoted(value))).unwrap_or_default()
    };
    let options =
        [option("--python", arguments.python.as_deref()), option("--scene", arguments.scene.as_deref())];
    format!(
        "Ready. Press Ctrl+C to stop.\nTo drive in it, run this in another terminal:\n\n    pydslrep run {} --target ros2 --sim-time{}\n",
        quoted(program),
        options.concat(),
    )
}

/// Returns the hints for stopping the simulator and for running the script: `script` is where `build` writes it.
fn next_steps(
    arguments: &Arguments,
    program: &Path,
    environment: &Environment,
    script: Option<&Path>,
) -> String {
    let ready = "Ready. Press Ctrl+C to stop.\n";
    let Some(script) = script else { return ready.to_owned() };
    let at = match arguments.listen {
        any if any.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        address => address,
    };
    // The script's own place for the simulator, unless the program names another one.
    let usual: IpAddr = environment.host.unwrap_or(Ipv4Addr::LOCALHOST).into();
    let host = if at == usual { String::new() } else { format!(" --host {at}") };
    format!(
        "{ready}To drive in it, run this in another terminal:\n\n    pydslrep build {}\n    python3 {}{host}\n",
        quoted(program),
        quoted(script),
    )
}

/// A path, quoted for a shell.
fn quoted(path: &Path) -> String {
    let path = path.display().to_string();
    if path.contains(char::is_whitespace) { format!("\"{path}\"") } else { path }
}
