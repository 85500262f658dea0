//! A world as a node of ROS 2: a Python process (`pydslrep_runtime.ros2_world`) that steps the embedded simulator or `MuJoCo`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::Duration;

use pydslrep_output::TemporaryFolder;
use pydslrep_scene::{Robot, Scene};
use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncReadExt, BufReader};
use tokio::process::{Child, Command};
use tokio::time::timeout;

use crate::failure::Failure;
use crate::run::interrupt::interrupt_process;
use crate::run::mujoco;
use crate::run::python;
use crate::run::scene_description;
use crate::run::script::{BOOT, TOKEN};

/// The script of the process.
const SCRIPT: &str = "from pydslrep_runtime.ros2_world import main\n\nmain()\n";

/// The node leaves within this time.
const STOP_LIMIT: Duration = Duration::from_secs(5);

/// At most this much of what it says is read, bytes.
const MAX_STDERR: u64 = 1 << 16;

/// Options of the node.
#[derive(Debug, Clone)]
pub(crate) struct Choice<'a> {
    /// The Python that can import rclpy.
    pub(crate) python: Option<&'a Path>,
    /// Simulated seconds per second.
    pub(crate) speed: f64,
    /// True if a script steps the world.
    pub(crate) lockstep: bool,
}

/// The engine that moves the robots of a node.
#[derive(Debug, Clone, Copy)]
pub(crate) enum World<'a> {
    /// The embedded simulator, with a port for each robot, and what it knows the node by.
    Embedded {
        /// The ports, in the order of the robots.
        ports: &'a [u16],
        /// The token of the simulator.
        token: &'a str,
    },
    /// `MuJoCo`, in the process of the node.
    MuJoCo(&'a Scene),
}

/// A node that runs.
pub(crate) struct Node {
    child: Child,
    _folder: TemporaryFolder,
}

impl Node {
    /// Starts the node for robots of a world, and waits until it is ready.
    ///
    /// # Errors
    /// If its Python cannot be started, or cannot import what it needs.
    pub(crate) async fn start(
        choice: &Choice<'_>,
        robots: &[Robot],
        world: World<'_>,
    ) -> Result<Self, Failure> {
        let python = python::interpreter(choice.python).await?;
        let folder = TemporaryFolder::new("run-").map_err(|error| unstarted(&error))?;
        let runtime = python::runtime(folder.path())?;
        let ports = match world {
            World::Embedded { ports, .. } => ports,
            World::MuJoCo(_) => &[],
        };
        let ports = ports.iter().copied().chain(std::iter::repeat(0));
        let described: Vec<Value> =
            robots.iter().zip(ports).map(|(robot, port)| with_port(robot, port)).collect();
        let script = write(folder.path().join("world.py"), SCRIPT)?;
        let robots = write(folder.path().join("robots.json"), &Value::from(described).to_string())?;
        let mut command = Command::new(&python);
        command.args(["-X", "utf8", "-c", BOOT]).arg(&runtime).arg("").arg(script).arg(robots);
        command.arg("--speed").arg(choice.speed.to_string());
        command.args(choice.lockstep.then_some("--lockstep"));
        match world {
            World::Embedded { token, .. } => {
                command.env(TOKEN, token);
            }
            World::MuJoCo(scene) => {
                command.args(mujoco::World::write(scene, &[], folder.path(), None, false)?.arguments());
            }
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).kill_on_drop(true);
        // Ctrl-C reaches it once: from this process.
        #[cfg(unix)]
        command.process_group(0);
        let child = command.spawn().map_err(|error| unstarted(&error))?;
        let mut node = Self { child, _folder: folder };
        node.await_ready().await?;
        Ok(node)
    }

    /// Resolves when the node has ended by itself, with the reason.
    pub(crate) async fn ended(&mut self) -> Failure {
        let mut bytes = Vec::new();
        if let Some(stderr) = &mut self.child.stderr {
            let _ = stderr.take(MAX_STDERR).read_to_end(&mut bytes).await;
        }
        let text = String::from_utf8_lossy(&bytes);
        // A traceback ends with what went wrong.
        let reason = text.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("the node has ended");
        Failure::new(reason.strip_prefix("error: ").unwrap_or(reason))
    }

    /// Ends the node.
    pub(crate) async fn stop(mut self) {
        interrupt_process(self.child.id());
        let _ = timeout(STOP_LIMIT, self.child.wait()).await;
    }

    async fn await_ready(&mut self) -> Result<(), Failure> {
        if let Some(stdout) = self.child.stdout.take() {
            let line = BufReader::new(stdout).lines().next_line().await;
            if line.ok().flatten().is_some() {
                return Ok(());
            }
        }
        Err(self.ended().await)
    }
}

fn write(path: PathBuf, text: &str) -> Result<PathBuf, Failure> {
    fs::write(&path, text).map_err(|error| Failure::unwritten(&path, &error))?;
    Ok(path)
}

fn with_port(robot: &Robot, port: u16) -> Value {
    let mut described = scene_description::ros2_robot(robot);
    described["port"] = json!(port);
    described
}

fn unstarted(error: &dyn std::fmt::Display) -> Failure {
    Failure::new(format!("cannot start the node: {error}"))
}
