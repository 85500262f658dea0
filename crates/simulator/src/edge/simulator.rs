//! A whole simulator to embed: started on a thread of its own, watched while it runs, stopped at the end.

use std::fmt;
use std::io;
use std::net::{IpAddr, Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use pydslrep_kinematics::{Pose, motion};
use pydslrep_scene::Scene;
use tokio::sync::oneshot;
use tokio::time::sleep;

use super::connection::listen;
use super::exchange::Exchange;
use pydslrep_record::TraceRecord;

use crate::{Session, Sightings, World, WorldError};

/// How often the clock looks at the time, whether it runs by itself or somebody steps it.
const CLOCK_PERIOD: Duration = Duration::from_millis(2);
const IDLE_PERIOD: Duration = Duration::from_millis(20);

/// How often silent clients are looked for.
const HOUSEKEEPING_PERIOD: Duration = Duration::from_millis(200);

/// The clock never catches up more than this at once; what is beyond is lost instead of blocking the clients.
const MOST_STEPS_AT_ONCE: u32 = 500;

/// How a simulator is to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Where it listens; by default for programs on this machine only.
    pub address: IpAddr,
    /// One listener for each, 0 is any free port. Ports listed more than once share a listener.
    pub ports: Vec<u16>,
    /// Take any free port where the wished one is taken, instead of failing.
    pub any_port_if_taken: bool,
    /// Length of a simulation step, seconds.
    pub step: f64,
    /// Simulated seconds per second while no client steps the clock.
    pub speed: f64,
    /// Keep to that speed also when clients step the clock, instead of stepping as fast as they ask.
    pub paced: bool,
    /// Record a trace. It stays in memory until taken.
    pub trace: bool,
}

impl Default for Options {
    /// One free port on loopback, real time, with trace.
    fn default() -> Self {
        Self {
            address: Ipv4Addr::LOCALHOST.into(),
            ports: vec![0],
            any_port_if_taken: false,
            step: motion::STEP,
            speed: 1.0,
            paced: false,
            trace: true,
        }
    }
}

/// Why a simulator did not start.
#[derive(Debug)]
pub enum StartError {
    /// The scene cannot move.
    World(WorldError),
    /// The speed is not above zero.
    Speed(f64),
    /// A port cannot be listened on.
    Port {
        /// Where.
        address: IpAddr,
        /// Which one.
        port: u16,
        /// Why.
        error: io::Error,
    },
    /// The machine gave no thread or timer.
    Runtime(io::Error),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::World(error) => error.fmt(f),
            Self::Speed(speed) => write!(f, "the simulator's speed must be above zero, it is {speed}"),
            Self::Port { address, port, error } => {
                write!(f, "cannot listen on {address} port {port}: {error}; is another simulator running?")
            }
            Self::Runtime(error) => write!(f, "cannot start the simulator: {error}"),
        }
    }
}

impl std::error::Error for StartError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::World(error) => Some(error),
            Self::Speed(_) => None,
            Self::Port { error, .. } | Self::Runtime(error) => Some(error),
        }
    }
}

/// A running simulator. Dropping it stops it.
pub struct Simulator {
    exchange: Arc<Exchange>,
    ports: Vec<u16>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Simulator {
    /// Starts a simulator of `scene`. Its ports accept connections when this returns.
    ///
    /// # Errors
    /// When the scene cannot move, a port is taken, or the machine is out of threads.
    pub fn start(scene: Scene, options: &Options) -> Result<Self, StartError> {
        if !(options.speed.is_finite() && options.speed > 0.0) {
            return Err(StartError::Speed(options.speed));
        }
        let world = World::with_step(scene, options.step).map_err(StartError::World)?;
        let mut session = Session::new(world);
        if options.trace {
            session.record();
        }
        if options.paced {
            session.pace();
        }
        let (listeners, ports) = bind(options)?;
        let exchange = Arc::new(Exchange::new(session));
        let (stop, stopped) = oneshot::channel();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()
            .map_err(StartError::Runtime)?;
        let listeners: Vec<_> = {
            let _context = runtime.enter();
            listeners.into_iter().map(tokio::net::TcpListener::from_std).collect::<Result<_, _>>()
        }
        .map_err(StartError::Runtime)?;
        let (shared, pace) = (Arc::clone(&exchange), options.speed / options.step);
        let thread = std::thread::Builder::new()
            .name("simulator".to_owned())
            .spawn(move || {
                runtime.block_on(async {
                    for listener in listeners {
                        tokio::spawn(listen(listener, Arc::clone(&shared)));
                    }
                    tokio::spawn(keep_time(Arc::clone(&shared), pace));
                    // An error means that the owner is gone, which is a stop too.
                    let _ = stopped.await;
                });
            })
            .map_err(StartError::Runtime)?;
        Ok(Self { exchange, ports, stop: Some(stop), thread: Some(thread) })
    }

    /// Where it listens: one port for each of [`Options::ports`], in their order.
    pub fn ports(&self) -> &[u16] {
        &self.ports
    }

    /// Simulation time, seconds.
    pub fn time(&self) -> f64 {
        self.exchange.with_session(|session| session.world().time())
    }

    /// Where the robots are, in the scene's order.
    pub fn poses(&self) -> Vec<Pose> {
        self.exchange.with_session(|session| {
            let world = session.world();
            (0..world.scene().robots.len()).map(|robot| world.pose(robot)).collect()
        })
    }

    /// What sensors were read to see since the start.
    pub fn sightings(&self) -> Sightings {
        self.exchange.with_session(|session| session.sightings().clone())
    }

    /// What was recorded since the start or since the last time this was called: every robot at the start of a
    /// simulation and after each step, in the order in which it happened.
    pub fn take_trace(&self) -> Vec<TraceRecord> {
        self.exchange.with_session(Session::take_trace)
    }

    /// Closes all connections and returns the rest of the trace.
    pub fn stop(mut self) -> Vec<TraceRecord> {
        self.end();
        self.take_trace()
    }

    fn end(&mut self) {
        self.stop.take();
        if let Some(thread) = self.thread.take() {
            // It ends by itself when told to; a panic in it has nothing to say to the owner any more.
            let _ = thread.join();
        }
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        self.end();
    }
}

/// The listeners, and the port of each wish.
fn bind(options: &Options) -> Result<(Vec<TcpListener>, Vec<u16>), StartError> {
    let (mut listeners, mut ports) = (Vec::new(), Vec::new());
    for (index, &port) in options.ports.iter().enumerate() {
        let twin = options.ports[..index].iter().position(|&earlier| port != 0 && earlier == port);
        if let Some(twin) = twin {
            ports.push(ports[twin]);
            continue;
        }
        let failure = |error| StartError::Port { address: options.address, port, error };
        let listener = match TcpListener::bind((options.address, port)) {
            Err(_) if options.any_port_if_taken => TcpListener::bind((options.address, 0)),
            result => result,
        }
        .map_err(failure)?;
        listener.set_nonblocking(true).map_err(failure)?;
        ports.push(listener.local_addr().map_err(failure)?.port());
        listeners.push(listener);
    }
    Ok((listeners, ports))
}

/// The clock while nobody steps it, at `pace` steps per second, and the housekeeping.
async fn keep_time(exchange: Arc<Exchange>, pace: f64) {
    let mut last = Instant::now();
    let mut last_housekeeping = last;
    let mut owed = 0.0;
    let mut running = false;
    loop {
        sleep(if running { CLOCK_PERIOD } else { IDLE_PERIOD }).await;
        let now = Instant::now();
        owed = if running { owed + (now - last).as_secs_f64() * pace } else { 0.0 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped to what fits
        let steps = owed.floor().clamp(0.0, f64::from(MOST_STEPS_AT_ONCE)) as u32;
        owed = (owed - f64::from(steps)).min(1.0);
        last = now;
        running = exchange.pass_time(steps);
        if now - last_housekeeping >= HOUSEKEEPING_PERIOD {
            exchange.keep_house();
            last_housekeeping = now;
        }
    }
}
