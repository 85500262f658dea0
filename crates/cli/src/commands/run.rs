//! `pydslrep run`: generates the script of a program, simulates it, and plots the result.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use pydslrep_analysis::environment::Robot;
use pydslrep_config::{Config, Edition, Target};
use pydslrep_output::{Kind, TemporaryFolder, check_outputs, write_output};
use pydslrep_scene::Scene;
use pydslrep_script::{file_name, generate};
use pydslrep_simulator::{Options, Simulator};
use pydslrep_trace::{FailureClass, FileKind, Map, RunEvent, RunFailure};

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::{Inputs, paths, program};
use crate::options::{Engine, above_zero, edition_parser, target_parser};
use crate::report::output;
use crate::run::driven::{self, Driven};
use crate::run::interrupt::{self, Interrupts};
use crate::run::mujoco::World;
use crate::run::outcome::Outcome;
use crate::run::own_robots::{self, OwnRobot};
use crate::run::pictures::Pictures;
use crate::run::planned::PlannedEnvironment;
use crate::run::progress::Progress;
use crate::run::python::{self, Packages, Watcher};
use crate::run::reporter::{self, Reporter, is_standard_output};
use crate::run::script::{Listener, Script, drive};
use crate::run::trace_file::{self, TraceFile};
use crate::run::{exploring, script, strikes, vrep_client};

const HELP: Help = Help {
    examples: &[
        ("pydslrep run patrol.pyr", "in the embedded simulator"),
        ("pydslrep run patrol.pyr --picture patrol.svg", "and draw planned and driven path"),
        ("pydslrep run patrol.pyr --replay driven.svg", "and draw an animated SVG for a browser"),
        ("pydslrep run patrol.pyr --scene hall.scene.toml", "with the obstacles of a hall"),
        ("pydslrep run patrol.pyr --engine mujoco", "in the physics engine MuJoCo"),
        ("pydslrep run patrol.pyr --host 127.0.0.1 --port 23000", "in a CoppeliaSim that is running there"),
        ("pydslrep run patrol.pyr --target vrep", "with V-REP's legacy remote API"),
        ("pydslrep run patrol.pyr --target ros2", "with the drivers of robots that are there in ROS 2"),
        ("pydslrep run patrol.pyr --events -", "and tell a program what happens"),
        (
            "pydslrep run patrol.pyr --robot my_robot:Rover",
            "with a robot of your own: the class Rover in my_robot.py, next to the program",
        ),
    ],
    notes: &["The first run creates a Python virtual environment in your cache folder and installs the \
         CoppeliaSim client library into it, which needs Python 3.11 or later and network access. The first \
         run with --odometry does the same with NumPy and SciPy, and the first one with --engine mujoco with MuJoCo. With --target vrep, your own Python runs \
         the script with V-REP's client (sim.py or vrep.py and its library) from the program's folder or \
         from Python's path. With --target ros2, no simulator is started, and your own Python runs the script: \
         one that can import rclpy. If all robots are your own, your own Python runs the script without a \
         simulator."],
};

/// Run a program: check it, generate its script, and run that in the embedded simulator
#[expect(clippy::struct_excessive_bools, reason = "each is an option of the command line")]
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program, or `-` for standard input
    program: PathBuf,
    /// The environment to run; required if there are several
    #[arg(long, value_name = "NAME")]
    environment: Option<String>,
    /// The scene to run in [default: ENVIRONMENT.scene.toml next to the program, if it exists]
    #[arg(long, value_name = "FILE", conflicts_with = "host")]
    scene: Option<PathBuf>,
    /// The seed of the scene's noise: the same seed gives the same run
    #[arg(long, value_name = "N", conflicts_with = "host")]
    seed: Option<u64>,
    /// What moves the robots
    #[arg(long, value_name = "ENGINE", default_value = "embedded", conflicts_with = "host")]
    engine: Engine,
    /// Watch the robots in MuJoCo's window, in real time unless --speed says otherwise
    #[arg(long, conflicts_with = "host")]
    view: bool,
    /// The simulator that the script is for [default: that of pydslrep.toml, else coppeliasim]
    #[arg(long, value_name = "TARGET", value_parser = target_parser())]
    target: Option<Target>,
    /// Which statements a program may have [default: that of pydslrep.toml, else current]
    #[arg(long, value_name = "EDITION", value_parser = edition_parser())]
    edition: Option<Edition>,
    #[command(flatten)]
    pictures: Pictures,
    /// Write every step to a file: as JSON lines or, where its name ends in .mcap, as messages of ROS 2
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Write the map of robots that explore to a file, as JSON [default: `ENVIRONMENT_map.json`]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Write the result to a file, as JSON: times, and where each robot ends
    #[arg(long, value_name = "FILE")]
    figures: Option<PathBuf>,
    /// Write what happens to a file, as JSON lines for programs; `-` is standard output, in place of the table
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// With the target ros2: time is that of the topic /clock, as a simulation publishes it
    #[arg(long, conflicts_with = "host")]
    sim_time: bool,
    /// Explore by wheel odometry, without poses from the simulator
    #[arg(long)]
    odometry: bool,
    /// How far from its start a robot explores an area at most, in metres [default: 20]
    #[arg(long, value_name = "METRES", value_parser = above_zero)]
    extent: Option<f64>,
    /// Simulated seconds per second, to watch the run [default: as fast as possible]
    #[arg(long, value_name = "X", value_parser = above_zero, conflicts_with = "host")]
    speed: Option<f64>,
    /// Hide progress
    #[arg(long)]
    no_progress: bool,
    /// Drive with a class of your own instead of a simulator, all robots or one; may be repeated
    #[arg(long, value_name = "[ROBOT=]MODULE:CLASS", value_parser = OwnRobot::parse)]
    robot: Vec<OwnRobot>,
    /// Use the CoppeliaSim on this machine instead of the embedded simulator
    #[arg(long, value_name = "ADDRESS")]
    host: Option<String>,
    /// Port of that CoppeliaSim, for all robots or for one; may be repeated
    #[arg(long, value_name = "[ROBOT=]PORT", requires = "host")]
    port: Vec<String>,
    /// Stop a simulation that runs there already, which puts everything back, and start it again
    #[arg(long, requires = "host")]
    restart: bool,
    /// End as after Ctrl-C when standard input ends: for a parent process that may be killed
    #[arg(long, hide = true)]
    until_input_ends: bool,
    /// The Python to run the script with [default: python3]
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
}

impl Arguments {
    /// The files to write.
    fn outputs<'a>(&'a self, map: Option<&'a Path>) -> Vec<(&'a Path, Kind)> {
        let others = [
            (self.trace.as_deref(), self.trace.as_deref().map_or(Kind::Trace, trace_file::kind)),
            (map, Kind::Map),
            (self.figures.as_deref(), Kind::Figures),
            (self.events.as_deref().filter(|path| !is_standard_output(path)), Kind::Events),
        ];
        let others = others.into_iter().filter_map(|(path, kind)| Some((path?, kind)));
        self.pictures.outputs().chain(others).collect()
    }
}

/// Runs the command.
///
/// # Errors
/// If anything outside of the program fails.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let mut reporter = Reporter::for_people();
    let outcome = perform(arguments, &mut reporter);
    if let Err(failure) = &outcome {
        reporter.fail(failure);
    }
    outcome
}

fn perform(arguments: &Arguments, reporter: &mut Reporter) -> Result<ExitCode, Failure> {
    let events = arguments.events.as_deref();
    if events.is_some_and(is_standard_output) {
        *reporter = Reporter::open(events)?;
    }
    let options = Config::of_target(arguments.target).merged_over(Config::of_edition(arguments.edition));
    let (mut inputs, file) = Inputs::open_one(&arguments.program, &options)?;
    if let Some(path) = events.filter(|path| !is_standard_output(path)) {
        check_outputs(&[(path, Kind::Events)], &inputs.read_paths())?;
        *reporter = Reporter::open(events)?;
    }
    let target = target(arguments, inputs.settings(file).target);
    check_options(arguments, target)?;
    let id = program::environment(&inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let Some(environment) = program::prepare(&inputs, file, &[id]).environments.pop() else {
        reporter.refuse("the program has errors");
        return Ok(ExitCode::FAILURE);
    };
    let name = file_name(&environment);
    let text = match generate(&environment, target, &inputs.file_name(file)) {
        Ok(text) => text,
        Err(error) => {
            output::error(&error.to_string(), None);
            reporter.refuse(&error.to_string());
            return Ok(ExitCode::FAILURE);
        }
    };
    let mut scene = inputs.scene(file, &environment)?;
    scene.seed = arguments.seed.unwrap_or(scene.seed);
    let map =
        exploring::explores(&environment).then(|| exploring::file(arguments.map.as_deref(), &environment));
    let outputs = arguments.outputs(map.as_deref());
    check_outputs(&outputs, &inputs.read_paths())?;
    let home = inputs.place(file).and_then(Path::parent).unwrap_or(Path::new(".")).to_owned();
    let mut simulated = own_robots::simulated(&arguments.robot, &environment)?;
    if target == Target::Ros2 {
        simulated.clear();
    }
    let planned = PlannedEnvironment::new(environment, scene)?;
    let run = Run { arguments, reporter, target, home, simulated, map, planned };
    let code = interrupt::run("start a run", async |interrupts| run.drive(&name, &text, interrupts).await)?;
    Ok(ExitCode::from(code))
}

/// The simulator that the script is for, of that of the settings. It makes no difference to a script that drives in `MuJoCo`.
fn target(arguments: &Arguments, chosen: Target) -> Target {
    if arguments.engine == Engine::MuJoCo { Target::CoppeliaSim } else { chosen }
}

/// Refuses options that are for other runs than this one.
fn check_options(arguments: &Arguments, target: Target) -> Result<(), Failure> {
    let in_mujoco = arguments.engine == Engine::MuJoCo;
    let in_ros2 = target == Target::Ros2;
    let for_another = arguments.target.is_some_and(|target| target != Target::CoppeliaSim);
    let for_simulators = |option| {
        Failure::new(format!("{option} is for simulators, and the target ros2 starts none"))
            .help("`pydslrep sim --ros2` starts a robot to try it with")
    };
    let refusals = [
        (
            arguments.view && !in_mujoco,
            Failure::new("--view is for --engine mujoco").help("draw an animated SVG with --replay"),
        ),
        (
            for_another && in_mujoco,
            Failure::new("--target is for another simulator than --engine mujoco: leave one of them out"),
        ),
        (
            arguments.restart && target == Target::VRep,
            Failure::new("--restart is for CoppeliaSim: V-REP may listen only while its simulation runs"),
        ),
        (arguments.host.is_some() && in_ros2, for_simulators("--host")),
        (arguments.speed.is_some() && in_ros2, for_simulators("--speed")),
        (arguments.seed.is_some() && in_ros2, for_simulators("--seed")),
        (arguments.odometry && in_ros2, for_simulators("--odometry")),
        (arguments.sim_time && !in_ros2, Failure::new("--sim-time is for the target ros2")),
    ];
    match refusals.into_iter().find(|(is_wrong, _)| *is_wrong) {
        Some((_, refusal)) => Err(refusal),
        None => Ok(()),
    }
}

/// Returns the token of this run's clients: the name of its folder is unique.
fn token(folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    format!("{}-{name}", std::process::id())
}

struct Run<'a> {
    arguments: &'a Arguments,
    reporter: &'a Reporter,
    target: Target,
    /// The program's folder.
    home: PathBuf,
    /// The indices of the robots that a simulator drives.
    simulated: Vec<usize>,
    /// The destination of the map, if a robot explores.
    map: Option<PathBuf>,
    planned: PlannedEnvironment,
}

impl Run<'_> {
    async fn drive(mut self, name: &str, text: &str, mut interrupts: Interrupts) -> Result<u8, Failure> {
        if self.arguments.until_input_ends {
            interrupts = interrupts.with_end_of_input();
        }
        let python = tokio::select! {
            python = self.python() => python?,
            () = interrupts.next() => {
                self.reporter.write(&RunEvent::Failed(script::interrupted()));
                return Ok(interrupt::EXIT_CODE);
            }
        };
        let folder = TemporaryFolder::new("run-")
            .map_err(|error| Failure::new(format!("cannot start a run: {error}")))?;
        if self.target == Target::VRep && self.needs_simulator() {
            vrep_client::prepare(&python, &self.home, folder.path()).await?;
        }
        let runtime = python::runtime(folder.path())?;
        let is_embedded = self.arguments.host.is_none() && self.needs_simulator() && !self.is_in_mujoco();
        let token = token(folder.path());
        let simulator = if is_embedded { Some(self.simulator(&token)?) } else { None };
        let world = if self.is_in_mujoco() { Some(self.world(folder.path())?) } else { None };
        let path = folder.path().join(name);
        fs::write(&path, text).map_err(|error| Failure::unwritten(&path, &error))?;
        let trace = self.trace(folder.path());
        let map = folder.path().join("map.json");
        let script = Script {
            python,
            isolated: self.target == Target::CoppeliaSim && !self.has_own_robots(),
            runtime,
            modules: if self.has_own_robots() { Some(paths::absolute(&self.home)?) } else { None },
            token: is_embedded.then_some(token),
            arguments: self.script_arguments(
                &path,
                &map,
                trace.as_deref(),
                simulator.as_ref(),
                world.as_ref(),
            ),
        };
        let in_scene = if is_embedded { self.simulated.clone() } else { Vec::new() };
        let mut driven = Driven::new(&self.planned.scene.robots, in_scene);
        let mut progress = Progress::new(&self.planned, self.arguments.no_progress);
        let begin = Instant::now();
        let listener = Listener::new(simulator.as_ref(), &mut driven, &mut progress, self.reporter);
        let ending = drive(&script, listener, &mut interrupts).await;
        let wall = begin.elapsed();
        progress.clear();
        let refused = simulator.as_ref().map_or(0, Simulator::refused_connections);
        if refused > 0 {
            let others = output::count(refused, "connection");
            let refused = format!("{others} of other programs to the simulator of this run refused");
            self.reporter.warn(&refused, None);
        }
        if let Some(simulator) = &simulator {
            strikes::report(self.reporter, &self.simulated_scene(), &simulator.strikes());
        }
        drop(simulator);
        if let (Some(trace), true) = (&trace, self.needs_trace()) {
            // Without a trace, nothing was driven.
            let _ = driven.read(trace);
            self.planned.start_from(&driven)?;
        }
        self.keep_bag(trace.as_deref())?;
        driven.maps = self.keep_map(&map)?;
        self.report(ending?, &driven, wall)
    }

    /// Returns whether any robot is simulated rather than the user's own.
    fn needs_simulator(&self) -> bool {
        !self.simulated.is_empty()
    }

    fn has_own_robots(&self) -> bool {
        !self.arguments.robot.is_empty()
    }

    /// Returns whether there are robots that drive in `MuJoCo`.
    fn is_in_mujoco(&self) -> bool {
        self.arguments.engine == Engine::MuJoCo && self.needs_simulator()
    }

    fn world(&self, folder: &Path) -> Result<World, Failure> {
        let Self { arguments, planned, .. } = self;
        World::write(&self.simulated_scene(), &planned.plan.robots, folder, arguments.speed, arguments.view)
    }

    /// Returns whether only the script knows some of the paths.
    fn needs_trace(&self) -> bool {
        let arguments = self.arguments;
        arguments.host.is_some()
            || self.has_own_robots()
            || self.is_in_mujoco()
            || self.target == Target::Ros2
    }

    async fn python(&self) -> Result<PathBuf, Failure> {
        let chosen = self.arguments.python.as_deref();
        if self.target == Target::CoppeliaSim && self.needs_simulator() {
            let watcher = Watcher { reporter: self.reporter, quiet: self.arguments.no_progress };
            python::prepare(chosen, self.packages(), watcher).await
        } else {
            python::interpreter(chosen).await
        }
    }

    fn packages(&self) -> Packages {
        let odometry = self.arguments.odometry && exploring::explores(&self.planned.environment);
        match (self.is_in_mujoco(), odometry) {
            (false, false) => Packages::CLIENT,
            (false, true) => Packages::CLIENT_AND_ODOMETRY,
            (true, false) => Packages::MUJOCO,
            (true, true) => Packages::MUJOCO_AND_ODOMETRY,
        }
    }

    /// The robots that a simulator drives.
    fn simulated_robots(&self) -> impl Iterator<Item = &Robot> {
        self.simulated.iter().map(|index| &self.planned.environment.robots[*index])
    }

    /// The scene with the robots that a simulator drives: of others it does not know where they are.
    fn simulated_scene(&self) -> Scene {
        let scene = &self.planned.scene;
        let robots = self.simulated.iter().map(|index| scene.robots[*index].clone()).collect();
        Scene { robots, ..scene.clone() }
    }

    /// A simulator for this run alone, on ports of its own: a script of an earlier run may still look for its simulator, and
    /// other programs may know the ports of the program.
    fn simulator(&self, token: &str) -> Result<Simulator, Failure> {
        let options = Options {
            ports: self.simulated_robots().map(|_| 0).collect(),
            token: Some(token.to_owned()),
            speed: self.arguments.speed.unwrap_or(1.0),
            paced: self.arguments.speed.is_some(),
            ..Options::default()
        };
        Simulator::start(self.simulated_scene(), &options).map_err(|error| Failure::new(error.to_string()))
    }

    /// Where the script writes its trace: where the user wants it, or a temporary file if it is to be a bag, or if the path is
    /// known from nothing else.
    fn trace(&self, folder: &Path) -> Option<PathBuf> {
        let lines = self.arguments.trace.as_ref().filter(|path| !trace_file::is_bag(path));
        let needs_one = self.arguments.trace.is_some() || self.needs_trace();
        lines.cloned().or_else(|| needs_one.then(|| folder.join("trace.jsonl")))
    }

    /// Makes the bag that is wanted of the script's trace. Without steps, nothing replaces an older one.
    fn keep_bag(&self, trace: Option<&Path>) -> Result<(), Failure> {
        let Some(path) = self.arguments.trace.as_deref().filter(|path| trace_file::is_bag(path)) else {
            return Ok(());
        };
        let records = trace.map(driven::records).transpose();
        let mut records = records.ok().flatten().into_iter().flatten().peekable();
        if records.peek().is_none() {
            return Ok(());
        }
        let mut bag = TraceFile::begin(path, &self.planned.scene.robots)?;
        bag.plan(&self.planned);
        for record in records {
            bag.add(&[record.map_err(|error| Failure::unwritten(path, &error))?])?;
        }
        bag.finish()
    }

    fn script_arguments(
        &self,
        path: &Path,
        map: &Path,
        trace: Option<&Path>,
        simulator: Option<&Simulator>,
        world: Option<&World>,
    ) -> Vec<OsString> {
        let mut all: Vec<OsString> = vec![path.into()];
        if self.target != Target::Ros2 {
            let host = self.arguments.host.as_deref().unwrap_or("127.0.0.1");
            all.extend(["--host".into(), host.into()]);
        }
        all.extend(["--events".into(), reporter::STANDARD_OUTPUT.into()]);
        all.extend(self.arguments.sim_time.then(|| "--sim-time".into()));
        all.extend(own_robots::arguments(&self.arguments.robot));
        let ports: Vec<String> = match simulator {
            Some(simulator) => self
                .simulated_robots()
                .zip(simulator.ports())
                .map(|(robot, port)| format!("{}={port}", robot.name))
                .collect(),
            None => self.arguments.port.clone(),
        };
        for port in ports {
            all.extend(["--port".into(), port.into()]);
        }
        all.extend(world.map(World::arguments).unwrap_or_default());
        all.extend(self.arguments.restart.then(|| "--restart".into()));
        if let Some(trace) = trace {
            all.extend(["--trace".into(), trace.into()]);
        }
        if exploring::explores(&self.planned.environment) {
            all.extend(["--map".into(), map.into()]);
            all.extend(self.arguments.odometry.then(|| "--odometry".into()));
            if let Some(extent) = self.arguments.extent {
                all.extend(["--extent".into(), extent.to_string().into()]);
            }
            if simulator.is_some() || world.is_some() {
                all.extend(exploring::arguments(&self.simulated_scene()));
            }
        }
        all
    }

    /// Copies the script's map, if there is one, to its destination, and reads it.
    fn keep_map(&self, map: &Path) -> Result<Vec<Map>, Failure> {
        let Some(file) = self.map.as_deref().filter(|_| map.exists()) else { return Ok(Vec::new()) };
        let copy = |from: &Path, to: &Path, kind| -> Result<(), Failure> {
            let content = fs::read(from).map_err(|error| Failure::unwritten(to, &error))?;
            Ok(write_output(to, kind, &content)?)
        };
        copy(map, file, Kind::Map)?;
        let picture = map.with_extension("png");
        if picture.exists() {
            // The map is what counts.
            let place = file.with_extension("png");
            match copy(&picture, &place, Kind::Picture) {
                Ok(()) => self
                    .reporter
                    .write(&RunEvent::File { kind: FileKind::MapPicture, path: place.display().to_string() }),
                Err(error) => output::fail(&error),
            }
        }
        let robots = &self.planned.environment.robots;
        robots.iter().map(|robot| exploring::read(map, &robot.name)).collect()
    }

    fn report(
        &self,
        ending: Option<RunFailure>,
        driven: &Driven,
        wall: std::time::Duration,
    ) -> Result<u8, Failure> {
        let is_complete = ending.is_none();
        let outcome = Outcome { planned: &self.planned, driven, wall: Some(wall), is_complete };
        if let Some(failure) = &ending {
            self.reporter.report_failure(failure);
        }
        let code = match ending.map(|failure| failure.class) {
            None => 0,
            Some(FailureClass::Action) => 1,
            Some(FailureClass::Interrupted) => interrupt::EXIT_CODE,
            // The driven path then says nothing about the program.
            Some(_) => return Ok(Failure::EXIT_CODE),
        };
        let figures = outcome.figures();
        self.reporter.report_figures(&figures)?;
        if let Some(path) = &self.arguments.figures {
            let json = serde_json::to_vec(&figures).map_err(|error| Failure::unwritten(path, &error))?;
            write_output(path, Kind::Figures, &json)?;
        }
        self.planned.draw(&self.arguments.pictures, "planned and driven path", &outcome.routes())?;
        self.arguments.pictures.report(self.reporter);
        let map = self.map.as_ref().filter(|_| !driven.maps.is_empty());
        let (trace, figures) = (self.arguments.trace.as_ref(), self.arguments.figures.as_ref());
        for (kind, path) in [(FileKind::Trace, trace), (FileKind::Map, map), (FileKind::Figures, figures)] {
            if let Some(path) = path {
                self.reporter.report_file(kind, path);
            }
        }
        Ok(code)
    }
}
