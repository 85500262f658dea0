//! The embeddable simulator: runs on its own thread and can be observed and stopped.

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
use super::shared_session::SharedSession;
use pydslrep_trace::TraceRecord;

use crate::{Server, Session, Sightings, Strike, World, WorldError};

/// The period of the clock while it runs in real time, and while it does not.
const CLOCK_PERIOD: Duration = Duration::from_millis(2);
const IDLE_PERIOD: Duration = Duration::from_millis(20);

/// The interval at which silent clients are expired.
const EXPIRY_PERIOD: Duration = Duration::from_millis(200);

/// The maximum number of steps that the clock catches up at once; more are dropped rather than block the clients.
const MAX_STEPS_AT_ONCE: u32 = 500;

/// The options of a simulator.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The address to listen on; the default accepts only local programs.
    pub address: IpAddr,
    /// One listener per port; 0 is any free port. Repeated ports share a listener.
    pub ports: Vec<u16>,
    /// Use any free port if a requested one is taken, instead of failing.
    pub any_port_if_taken: bool,
    /// The simulation step, seconds.
    pub step: f64,
    /// Simulated seconds per second while no client steps the clock.
    pub speed: f64,
    /// Keep that speed even if clients step the clock, instead of stepping as fast as they request.
    pub paced: bool,
    /// Record a trace. It stays in memory until it is taken.
    pub trace: bool,
    /// Serve only clients whose id begins with this. Clients of the legacy remote API have none.
    pub token: Option<String>,
    /// The server to imitate.
    pub server: Server,
}

impl Default for Options {
    /// A free loopback port, in real time, with a trace.
    fn default() -> Self {
        Self {
            address: Ipv4Addr::LOCALHOST.into(),
            ports: vec![0],
            any_port_if_taken: false,
            step: motion::STEP,
            speed: 1.0,
            paced: false,
            trace: true,
            token: None,
            server: Server::default(),
        }
    }
}

/// Why a simulator did not start.
#[derive(Debug)]
pub enum StartError {
    /// The scene cannot be simulated.
    World(WorldError),
    /// The speed is not positive.
    Speed(f64),
    /// The simulator cannot listen on a port.
    Port {
        /// The address.
        address: IpAddr,
        /// The port.
        port: u16,
        /// The cause.
        error: io::Error,
    },
    /// The thread or runtime could not be created.
    Runtime(io::Error),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::World(error) => error.fmt(f),
            Self::Speed(speed) => write!(f, "the simulator's speed must be positive, but it is {speed}"),
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
    session: Arc<SharedSession>,
    ports: Vec<u16>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Simulator {
    /// Starts a simulator of `scene`. When this returns, its ports accept connections.
    ///
    /// # Errors
    /// If the scene cannot be simulated, a port is taken, or no thread can be created.
    pub fn start(scene: Scene, options: &Options) -> Result<Self, StartError> {
        if !(options.speed.is_finite() && options.speed > 0.0) {
            return Err(StartError::Speed(options.speed));
        }
        let world = World::with_step(scene, options.step).map_err(StartError::World)?;
        let mut session = Session::new(world);
        session.imitate(options.server);
        if options.trace {
            session.record();
        }
        if options.paced {
            session.pace();
        }
        if let Some(token) = &options.token {
            session.serve_only(token);
        }
        let (listeners, ports) = bind(options)?;
        let session = Arc::new(SharedSession::new(session));
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
        let (shared, pace) = (Arc::clone(&session), options.speed / options.step);
        let thread = std::thread::Builder::new()
            .name("simulator".to_owned())
            .spawn(move || {
                runtime.block_on(async {
                    for listener in listeners {
                        tokio::spawn(listen(listener, Arc::clone(&shared)));
                    }
                    tokio::spawn(keep_time(Arc::clone(&shared), pace));
                    // An error means that the owner was dropped, which also stops the simulator.
                    let _ = stopped.await;
                });
            })
            .map_err(StartError::Runtime)?;
        Ok(Self { session, ports, stop: Some(stop), thread: Some(thread) })
    }

    /// The ports it listens on, one for each of [`Options::ports`] in order.
    pub fn ports(&self) -> &[u16] {
        &self.ports
    }

    /// Simulation time, seconds.
    pub fn time(&self) -> f64 {
        self.session.with(|session| session.world().time())
    }

    /// Returns the number of connections refused because their client's id does not begin with [`Options::token`].
    pub fn refused_connections(&self) -> usize {
        self.session.with(|session| session.refused_connections())
    }

    /// The poses of the robots in the scene's order.
    pub fn poses(&self) -> Vec<Pose> {
        self.session.with(|session| {
            let world = session.world();
            (0..world.scene().robots.len()).map(|robot| world.pose(robot)).collect()
        })
    }

    /// The points that sensor readings have detected since the start.
    pub fn sightings(&self) -> Sightings {
        self.session.with(|session| session.sightings().clone())
    }

    /// The robots that moving obstacles have run into since the start of the simulation, in the order of time; by their
    /// indices in the scene.
    pub fn strikes(&self) -> Vec<Strike> {
        self.session.with(|session| session.world().strikes().to_vec())
    }

    /// The trace since the start or the last call: every robot at the start of a simulation and after each step, in
    /// chronological order.
    pub fn take_trace(&self) -> Vec<TraceRecord> {
        self.session.with(Session::take_trace)
    }

    /// Closes all connections and returns the remaining trace.
    pub fn stop(mut self) -> Vec<TraceRecord> {
        self.end();
        self.take_trace()
    }

    fn end(&mut self) {
        self.stop.take();
        if let Some(thread) = self.thread.take() {
            // Closing the channel ends the thread; a panic in it no longer matters.
            let _ = thread.join();
        }
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        self.end();
    }
}

/// The listeners, and the port for each requested one.
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

/// Runs the clock at `pace` steps per second while no client steps it, and expires silent clients.
async fn keep_time(session: Arc<SharedSession>, pace: f64) {
    let mut last = Instant::now();
    let mut last_expiry = last;
    let mut owed = 0.0;
    let mut running = false;
    loop {
        sleep(if running { CLOCK_PERIOD } else { IDLE_PERIOD }).await;
        let now = Instant::now();
        owed = if running { owed + (now - last).as_secs_f64() * pace } else { 0.0 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped to what fits
        let steps = owed.floor().clamp(0.0, f64::from(MAX_STEPS_AT_ONCE)) as u32;
        owed = (owed - f64::from(steps)).min(1.0);
        last = now;
        running = session.advance(steps);
        if now - last_expiry >= EXPIRY_PERIOD {
            session.expire_clients();
            last_expiry = now;
        }
    }
}
