//! `pydslrep run`: generates the script of a program, simulates it, and plots the result.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use pydslrep_config::{Config, Target};
use pydslrep_script::{file_name, generate};
use pydslrep_simulator::{Options, Simulator};
use pydslrep_trace::Map;
use tempfile::TempDir;

use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::inputs::program;
use crate::options::{above_zero, target_parser};
use crate::report::output;
use crate::run::driven::Driven;
use crate::run::interrupt::{self, Interrupts};
use crate::run::outcome::Outcome;
use crate::run::pictures::Pictures;
use crate::run::planned::Planned;
use crate::run::progress::Progress;
use crate::run::script::{Ending, Script, drive};
use crate::run::{exploring, python, vrep_client};

const EXAMPLES: &str = "\
Examples:
  pydslrep run patrol.pyr                          in the embedded simulator
  pydslrep run patrol.pyr --picture patrol.svg     and draw planned and driven path
  pydslrep run patrol.pyr --replay driven.svg      and draw an animated SVG for a browser
  pydslrep run patrol.pyr --scene hall.scene.toml  with the obstacles of a hall
  pydslrep run patrol.pyr --host 127.0.0.1 --port 23000
                                                   in a CoppeliaSim that is running there
  pydslrep run patrol.pyr --target vrep            with V-REP's legacy remote API

The first run creates a Python virtual environment in your cache folder and installs the
CoppeliaSim client library into it, which needs Python 3.11 or later and network access.
With --target vrep, your own Python runs the script with V-REP's client (sim.py or vrep.py and
its library) from the program's folder or from Python's path.";

/// Run a program: check it, generate its script, and run that in the embedded simulator
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
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
    /// The simulator that the script is for [default: that of pydslrep.toml, else coppeliasim]
    #[arg(long, value_name = "TARGET", value_parser = target_parser())]
    target: Option<Target>,
    #[command(flatten)]
    pictures: Pictures,
    /// Write every step to a file, as JSON lines
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Write the map of robots that explore to a file, as JSON [default: `ENVIRONMENT_map.json`]
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Write the result to a file, as JSON: times, and where each robot ends
    #[arg(long, value_name = "FILE")]
    figures: Option<PathBuf>,
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
    /// Use the CoppeliaSim on this machine instead of the embedded simulator
    #[arg(long, value_name = "ADDRESS")]
    host: Option<String>,
    /// Port of that CoppeliaSim, for all robots or for one; may be repeated
    #[arg(long, value_name = "[ROBOT=]PORT", requires = "host")]
    port: Vec<String>,
    /// End as after Ctrl-C when standard input ends: for a parent process that may be killed
    #[arg(long, hide = true)]
    until_input_ends: bool,
    /// The Python to run the script with [default: python3]
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If anything outside of the program fails.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let (mut inputs, file) = Inputs::open_one(&arguments.program, &Config::of_target(arguments.target))?;
    let target = inputs.settings(file).target;
    let id = program::environment(&inputs, file, arguments.environment.as_deref())?;
    if let Some(scene) = &arguments.scene {
        inputs.use_scene(file, id, scene)?;
    }
    let Some(environment) = program::prepare(&inputs, file, &[id]).environments.pop() else {
        return Ok(ExitCode::FAILURE);
    };
    let name = file_name(&environment);
    let text = match generate(&environment, target) {
        Ok(text) => text,
        Err(error) => {
            output::error(&error.to_string(), None);
            return Ok(ExitCode::FAILURE);
        }
    };
    let mut scene = inputs.scene(file, &environment)?;
    scene.seed = arguments.seed.unwrap_or(scene.seed);
    let home = inputs.place(file).and_then(Path::parent).unwrap_or(Path::new("")).to_owned();
    let run = Run { arguments, target, home, planned: Planned::new(environment, scene)? };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let code = runtime.map_err(|error| unstarted(&error))?.block_on(run.drive(&name, &text))?;
    Ok(ExitCode::from(code))
}

fn unstarted(error: &dyn std::fmt::Display) -> Failure {
    Failure::new(format!("cannot start a run: {error}"))
}

struct Run<'a> {
    arguments: &'a Arguments,
    target: Target,
    /// The program's folder.
    home: PathBuf,
    planned: Planned,
}

impl Run<'_> {
    async fn drive(mut self, name: &str, text: &str) -> Result<u8, Failure> {
        let mut interrupts = Interrupts::listen().map_err(|error| unstarted(&error))?;
        if self.arguments.until_input_ends {
            interrupts = interrupts.with_end_of_input();
        }
        let python = tokio::select! {
            python = self.python() => python?,
            () = interrupts.next() => return Ok(interrupt::EXIT_CODE),
        };
        let folder =
            tempfile::Builder::new().prefix("pydslrep-").tempdir().map_err(|error| unstarted(&error))?;
        if self.target == Target::VRep {
            vrep_client::prepare(&python, &self.home, folder.path()).await?;
        }
        let simulator = if self.arguments.host.is_none() { Some(self.simulator()?) } else { None };
        let path = folder.path().join(name);
        fs::write(&path, text).map_err(|error| Failure::unwritten(&path, &error))?;
        let trace = self.trace(&folder)?;
        let map = folder.path().join("map.json");
        let script = Script {
            python,
            isolated: self.target == Target::CoppeliaSim,
            arguments: self.script_arguments(&path, &map, trace.as_deref(), simulator.as_ref()),
        };
        let mut driven = Driven::new(self.planned.environment.robots.iter().map(|robot| robot.name.as_str()));
        let mut progress = Progress::new(&self.planned, self.arguments.no_progress);
        let begin = Instant::now();
        let ending = drive(&script, simulator.as_ref(), &mut driven, &mut progress, &mut interrupts).await;
        let wall = begin.elapsed();
        progress.clear();
        drop(simulator);
        if let (Some(trace), true) = (&trace, self.arguments.host.is_some()) {
            // Without a trace, nothing was driven.
            let _ = driven.read(trace);
            self.planned.start_from(&driven)?;
        }
        driven.maps = self.keep_map(&map)?;
        self.report(ending?, &driven, wall)
    }

    async fn python(&self) -> Result<PathBuf, Failure> {
        let chosen = self.arguments.python.as_deref();
        match self.target {
            Target::CoppeliaSim => python::prepare(chosen, self.arguments.no_progress).await,
            Target::VRep => python::interpreter(chosen).await,
        }
    }

    /// The port of each robot. V-REP needs a different one for each: a robot with the port of an earlier one gets a free one.
    fn ports(&self) -> Vec<u16> {
        let robots = &self.planned.environment.robots;
        let is_taken = |index: usize, port| robots[..index].iter().any(|robot| robot.port == port);
        let ports = robots.iter().enumerate().map(|(index, robot)| match self.target {
            Target::VRep if is_taken(index, robot.port) => 0,
            _ => robot.port,
        });
        ports.collect()
    }

    fn simulator(&self) -> Result<Simulator, Failure> {
        let options = Options {
            ports: self.ports(),
            any_port_if_taken: true,
            speed: self.arguments.speed.unwrap_or(1.0),
            paced: self.arguments.speed.is_some(),
            ..Options::default()
        };
        Simulator::start(self.planned.scene.clone(), &options)
            .map_err(|error| Failure::new(error.to_string()))
    }

    /// Where the script writes its trace: where the user wants it, or a temporary file if the path is known from nothing else.
    fn trace(&self, folder: &TempDir) -> Result<Option<PathBuf>, Failure> {
        match (&self.arguments.trace, &self.arguments.host) {
            (Some(path), _) => {
                // The script would report it too, but only after the simulator has started.
                fs::File::create(path).map_err(|error| Failure::unwritten(path, &error))?;
                Ok(Some(path.clone()))
            }
            (None, Some(_)) => Ok(Some(folder.path().join("trace.jsonl"))),
            (None, None) => Ok(None),
        }
    }

    fn script_arguments(
        &self,
        path: &Path,
        map: &Path,
        trace: Option<&Path>,
        simulator: Option<&Simulator>,
    ) -> Vec<OsString> {
        let mut all: Vec<OsString> = vec![path.into()];
        let host = self.arguments.host.as_deref().unwrap_or("127.0.0.1");
        all.extend(["--host".into(), host.into()]);
        let robots = &self.planned.environment.robots;
        let ports: Vec<String> = match simulator {
            Some(simulator) => robots
                .iter()
                .zip(simulator.ports())
                .map(|(robot, port)| format!("{}={port}", robot.name))
                .collect(),
            None => self.arguments.port.clone(),
        };
        for port in ports {
            all.extend(["--port".into(), port.into()]);
        }
        if let Some(trace) = trace {
            all.extend(["--trace".into(), trace.into()]);
        }
        if exploring::explores(&self.planned.environment) {
            all.extend(["--map".into(), map.into()]);
            all.extend(self.arguments.odometry.then(|| "--odometry".into()));
            if let Some(extent) = self.arguments.extent {
                all.extend(["--extent".into(), extent.to_string().into()]);
            }
            if simulator.is_some() {
                all.extend(exploring::arguments(&self.planned.scene));
            }
        }
        all
    }

    /// The destination of the map of robots that explore.
    fn map_file(&self) -> PathBuf {
        let default = || exploring::default_file(&self.planned.environment);
        self.arguments.map.clone().unwrap_or_else(default)
    }

    /// Copies the script's map, if there is one, to its destination, and reads it.
    fn keep_map(&self, map: &Path) -> Result<Vec<Map>, Failure> {
        if !map.exists() {
            return Ok(Vec::new());
        }
        let file = self.map_file();
        fs::copy(map, &file).map_err(|error| Failure::unwritten(&file, &error))?;
        let picture = map.with_extension("png");
        if picture.exists() {
            let file = file.with_extension("png");
            fs::copy(&picture, &file).map_err(|error| Failure::unwritten(&file, &error))?;
        }
        let robots = &self.planned.environment.robots;
        robots.iter().map(|robot| exploring::read(map, &robot.name)).collect()
    }

    fn report(&self, ending: Ending, driven: &Driven, wall: std::time::Duration) -> Result<u8, Failure> {
        let is_complete = matches!(ending, Ending::Done);
        let outcome = Outcome { planned: &self.planned, driven, wall, is_complete };
        let code = match ending {
            Ending::Done => 0,
            Ending::Failed(message) => {
                report_error(&message);
                1
            }
            Ending::Broken(message) => {
                report_error(&message);
                return Ok(Failure::EXIT_CODE);
            }
            Ending::Interrupted => {
                output::say("interrupted\n");
                interrupt::EXIT_CODE
            }
        };
        let figures = outcome.figures();
        output::print(&figures.table())?;
        if let Some(path) = &self.arguments.figures {
            let json = serde_json::to_vec(&figures).map_err(io::Error::from);
            json.and_then(|json| fs::write(path, json)).map_err(|error| Failure::unwritten(path, &error))?;
        }
        self.planned.draw(&self.arguments.pictures, "planned and driven path", &outcome.routes())?;
        self.arguments.pictures.report();
        let map = (!driven.maps.is_empty()).then(|| self.map_file());
        let written = [("trace", &self.arguments.trace), ("map", &map), ("figures", &self.arguments.figures)];
        for (what, path) in written {
            if let Some(path) = path {
                output::say(&format!("{what}: {}\n", path.display()));
            }
        }
        Ok(code)
    }
}

/// Reports a script's message in the style of this command.
fn report_error(message: &str) {
    match message.strip_prefix("error: ") {
        Some(message) if !message.contains('\n') => output::error(message, None),
        _ => output::say(&format!("{message}\n")),
    }
}
