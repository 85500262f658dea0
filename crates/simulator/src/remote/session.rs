//! Sessions: clients, their requests, and the coordination of simulation steps.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use ciborium::Value;
use pydslrep_scene::Scene;
use pydslrep_trace::TraceRecord;

use super::arguments::{Arguments, Failure, Outcome};
use super::building;
use super::calls::{self, CallContext, Drivers};
use super::info;
use super::legacy::client::Client as LegacyClient;
use super::message::{Request, encode, outcome_map};
use super::objects::Objects;
use super::recognition;
use crate::{Server, Sightings, World, WorldError};

/// The step of the physics engine in a new scene, seconds.
const PHYSICS_STEP: f64 = 0.005;

/// The maximum number of clients per connection; real connections have one.
const MAX_CLIENTS_PER_CONNECTION: usize = 16;

/// A client that waits longer than this for a step gets a keep-alive reply.
const KEEP_ALIVE_PERIOD: Duration = Duration::from_secs(1);

/// The maximum number of requests that wait for the end of a pause.
const MAX_HELD_REQUESTS: usize = 4096;

/// The default timeout after which a silent client is expired.
const DEFAULT_TIMEOUT: Duration = Duration::from_secs(600);

/// The reply to a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The ticket of the request.
    pub ticket: u64,
    /// One CBOR map.
    pub bytes: Vec<u8>,
}

/// The remote API of one world: requests in, replies out, for any number of clients.
///
/// Every request gets exactly one answer, immediately or later: a step request is answered after the step, and a step is
/// taken once every client in stepping mode has requested it.
#[derive(Debug, Clone)]
pub struct Session {
    pub(super) world: World,
    pub(super) objects: Objects,
    pub(super) state: State,
    clients: BTreeMap<String, Client>,
    /// Clients of the legacy remote API, by connection.
    pub(super) legacy: BTreeMap<u64, LegacyClient>,
    pub(super) drivers: Drivers,
    trace: Option<Vec<TraceRecord>>,
    seen: Sightings,
    /// The number of steps that clients may still take; `None` is unlimited.
    allowance: Option<u32>,
    /// The prefix that every client's id must have.
    token: Option<String>,
    /// The connections whose clients were refused.
    refused_connections: BTreeSet<u64>,
    server: Server,
    /// The text of the main script, if there is one.
    main_script: Option<String>,
    /// The step of the physics engine, seconds; the simulation itself has one step.
    physics_step: f64,
    /// The requests that wait for the end of a pause.
    held: Vec<HeldRequest>,
}

/// A request during a pause in which the server is silent.
#[derive(Debug, Clone)]
struct HeldRequest {
    connection: u64,
    ticket: u64,
    bytes: Vec<u8>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    Stopped,
    Paused,
    Running,
}

#[derive(Debug, Clone)]
struct Client {
    connection: u64,
    last_seen: Duration,
    timeout: Duration,
    /// Positive in stepping mode: steps wait for a request of this client.
    level: u32,
    /// Its unanswered step request.
    step_request: Option<StepRequest>,
}

#[derive(Debug, Clone)]
struct StepRequest {
    /// The request is fulfilled after this many steps.
    steps: u64,
    /// The ticket to answer, and its time; `None` while the client handles a keep-alive reply.
    open: Option<(u64, Duration)>,
}

/// The kind of reply to a request.
enum Reply {
    Now(Outcome),
    Map(Vec<(Value, Value)>),
    Later,
    /// Later; the earlier request with this ticket is answered with an error.
    LaterInsteadOf(u64),
}

impl Session {
    /// A session with a stopped simulation.
    pub fn new(world: World) -> Self {
        let objects = Objects::of(world.scene());
        Self {
            world,
            objects,
            state: State::Stopped,
            clients: BTreeMap::new(),
            legacy: BTreeMap::new(),
            drivers: Drivers::new(),
            trace: None,
            seen: Sightings::default(),
            allowance: None,
            token: None,
            refused_connections: BTreeSet::new(),
            server: Server::default(),
            main_script: Some(building::DEFAULT_MAIN_SCRIPT.to_owned()),
            physics_step: PHYSICS_STEP,
            held: Vec::new(),
        }
    }

    /// A session in a scene, with the usual step.
    ///
    /// # Errors
    /// If the scene cannot be simulated.
    pub fn of_scene(scene: Scene) -> Result<Self, WorldError> {
        Ok(Self::new(World::new(scene)?))
    }

    /// From now on clients are treated as by this server.
    pub fn imitate(&mut self, server: Server) {
        self.server = server;
    }

    /// Starts recording all robots at the start of the simulation and after every step.
    pub fn record(&mut self) {
        self.trace.get_or_insert_default();
    }

    /// From now on only clients are served whose id begins with this: those of one run. Clients of the legacy remote API have
    /// no id.
    pub fn serve_only(&mut self, token: &str) {
        self.token = Some(token.to_owned());
    }

    /// Returns the number of connections whose clients were refused.
    pub fn refused_connections(&self) -> usize {
        self.refused_connections.len()
    }

    /// From now on clients can only take steps that [`Session::allow`] permits.
    pub fn pace(&mut self) {
        self.allowance.get_or_insert(0);
    }

    /// Permits more steps in a paced session. All but one of the unused steps expire, so that a slow client does not catch
    /// up in a burst.
    pub fn allow(&mut self, steps: u32) -> Vec<Answer> {
        let Some(left) = &mut self.allowance else { return Vec::new() };
        *left = (*left).min(1).saturating_add(steps);
        self.step_if_ready()
    }

    /// Returns whether real time decides when steps are taken: no client steps, or steps are paced.
    pub fn is_timed(&self) -> bool {
        self.state == State::Running && (self.allowance.is_some() || self.is_free_running())
    }

    /// The trace since the last call.
    pub fn take_trace(&mut self) -> Vec<TraceRecord> {
        self.trace.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// The points that sensor readings have detected.
    pub fn sightings(&self) -> &Sightings {
        &self.seen
    }

    /// The current world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The number of known clients.
    pub fn client_count(&self) -> usize {
        self.clients.len() + self.legacy.len()
    }

    /// Returns whether the simulation runs freely: no client steps it.
    pub fn is_free_running(&self) -> bool {
        let nobody_steps = self.clients.values().all(|client| client.level == 0)
            && !self.legacy.values().any(|client| client.synchronous);
        self.state == State::Running && nobody_steps
    }

    /// Handles a request, which is one CBOR map.
    ///
    /// The answer repeats `ticket`; `connection` is the origin of the request and `now` the time since any fixed moment. The
    /// answers may belong to this request, to earlier ones, or both.
    pub fn request(&mut self, connection: u64, ticket: u64, now: Duration, bytes: &[u8]) -> Vec<Answer> {
        if self.is_silent() {
            if self.held.len() < MAX_HELD_REQUESTS {
                self.held.push(HeldRequest { connection, ticket, bytes: bytes.to_vec() });
                return Vec::new();
            }
            let failure = Err(Failure("too many requests while the simulation is paused".to_owned()));
            return vec![Answer { ticket, bytes: encode(outcome_map(failure)) }];
        }
        let reply = match Request::decode(bytes) {
            Ok(request) => self.answer(connection, ticket, now, &request),
            Err(complaint) => {
                Reply::Map(vec![("success".into(), false.into()), ("error".into(), complaint.into())])
            }
        };
        let mut answers = Vec::new();
        match reply {
            Reply::Now(outcome) => answers.push(Answer { ticket, bytes: encode(outcome_map(outcome)) }),
            Reply::Map(map) => answers.push(Answer { ticket, bytes: encode(map) }),
            Reply::Later => {}
            Reply::LaterInsteadOf(ticket) => {
                let lost = Err(Failure("sim.step: requested again before the step was taken".to_owned()));
                answers.push(Answer { ticket, bytes: encode(outcome_map(lost)) });
            }
        }
        answers.extend(self.step_if_ready());
        answers
    }

    /// Returns whether the server answers nothing at the moment.
    fn is_silent(&self) -> bool {
        self.state == State::Paused && self.server.is_silent_while_paused()
    }

    /// After a pause, handles the requests that have waited for its end.
    pub(super) fn answer_held_requests(&mut self, now: Duration) -> Vec<Answer> {
        if self.held.is_empty() || self.is_silent() {
            return Vec::new();
        }
        // Clients expire first, as in the real server.
        let mut answers = self.expire_clients(now);
        for held in std::mem::take(&mut self.held) {
            answers.extend(self.request(held.connection, held.ticket, now, &held.bytes));
        }
        answers
    }

    /// The connections that have a client.
    pub fn busy_connections(&self) -> BTreeSet<u64> {
        let clients = self.clients.values().map(|client| client.connection);
        clients.chain(self.legacy.keys().copied()).collect()
    }

    /// Removes a connection and its clients: nobody waits for them any more, and the wheels that they drove stop. Real
    /// servers do not notice, and keep the clients until their timeout.
    pub fn disconnect(&mut self, connection: u64) -> Vec<Answer> {
        if self.server.keeps_lost_clients() {
            for client in self.clients.values_mut().filter(|client| client.connection == connection) {
                if let Some(step_request) = &mut client.step_request {
                    step_request.open = None;
                }
            }
            self.legacy.remove(&connection);
            return self.step_if_ready();
        }
        self.clients.retain(|_, client| client.connection != connection);
        self.legacy.remove(&connection);
        self.drivers.retain(|&(robot, wheel), driver| {
            let stays = *driver != connection;
            if !stays {
                self.world.set_target(robot, wheel, 0.0);
            }
            stays
        });
        self.step_if_ready()
    }

    /// Expires clients that were silent for longer than their timeout, and sends keep-alive replies to those that wait for a
    /// step. To be called periodically.
    pub fn expire_clients(&mut self, now: Duration) -> Vec<Answer> {
        if self.is_silent() {
            return Vec::new();
        }
        self.clients.retain(|_, client| {
            let waits = client.step_request.as_ref().is_some_and(|step_request| step_request.open.is_some());
            waits || now.saturating_sub(client.last_seen) <= client.timeout
        });
        let mut answers = self.step_if_ready();
        for client in self.clients.values_mut() {
            let Some(step_request) = &mut client.step_request else { continue };
            if step_request.open.is_some_and(|(_, since)| now.saturating_sub(since) >= KEEP_ALIVE_PERIOD) {
                let wait = vec![("func".into(), "_*wait*_".into()), ("args".into(), Value::Array(vec![]))];
                answers.extend(
                    step_request.open.take().map(|(ticket, _)| Answer { ticket, bytes: encode(wait) }),
                );
                client.last_seen = now;
            }
        }
        answers
    }

    /// A step of the free-running clock; does nothing while clients step or the simulation does not run.
    pub fn tick(&mut self) -> Vec<Answer> {
        if !self.is_free_running() {
            return Vec::new();
        }
        self.take_step();
        self.step_if_ready()
    }

    fn answer(&mut self, connection: u64, ticket: u64, now: Duration, request: &Request) -> Reply {
        if self.token.as_ref().is_some_and(|token| !request.uuid.starts_with(token)) {
            self.refused_connections.insert(connection);
            let refusal = "this simulator belongs to another run; start one of your own with `pydslrep sim`";
            return Reply::Now(Err(Failure(refusal.to_owned())));
        }
        if request.function == "_*end*_" {
            self.clients.remove(&request.uuid);
            return Reply::Map(vec![]);
        }
        if let Err(failure) = self.register_client(connection, now, request) {
            return Reply::Now(Err(failure));
        }
        let arguments = Arguments::new(&request.function, &request.arguments);
        let uuid = &request.uuid;
        let outcome = match request.function.as_str() {
            "zmqRemoteApi.require" | "zmqRemoteApi.info" => namespace(&arguments),
            "_*executed*_" => return self.resume(uuid, ticket, now),
            "sim.step" => return self.request_step(uuid, ticket, now),
            "sim.setStepping" => self.set_stepping(uuid, &arguments),
            "sim.startSimulation" => {
                self.start();
                Ok(vec![])
            }
            "sim.stopSimulation" => {
                self.stop();
                Ok(vec![])
            }
            "sim.pauseSimulation" => {
                self.pause();
                Ok(vec![])
            }
            "sim.setFloatParam" => self.set_step_length(&arguments),
            "sim.getSimulationState" => Ok(vec![self.state_number().into()]),
            function => {
                if self.state == State::Stopped {
                    self.objects.settle();
                }
                let mut context = self.context(connection);
                let name = function.strip_prefix("sim.").unwrap_or_default();
                calls::call(&mut context, name, &arguments)
                    .unwrap_or_else(|| Err(Failure(format!("No such function: {function}"))))
            }
        };
        Reply::Now(outcome)
    }

    /// The context for calls of a connection.
    pub(super) fn context(&mut self, connection: u64) -> CallContext<'_> {
        CallContext {
            world: &mut self.world,
            objects: &mut self.objects,
            started: self.state != State::Stopped,
            main_script: &mut self.main_script,
            drivers: &mut self.drivers,
            connection,
            seen: &mut self.seen,
            physics_step: self.physics_step,
        }
    }

    fn register_client(&mut self, connection: u64, now: Duration, request: &Request) -> Result<(), Failure> {
        if !self.clients.contains_key(&request.uuid) {
            let beside = self.clients.values().filter(|client| client.connection == connection).count();
            if beside >= MAX_CLIENTS_PER_CONNECTION {
                return Err(Failure("too many clients on one connection".to_owned()));
            }
        }
        let new =
            Client { connection, last_seen: now, timeout: DEFAULT_TIMEOUT, level: 0, step_request: None };
        let client = self.clients.entry(request.uuid.clone()).or_insert(new);
        client.connection = connection;
        client.last_seen = now;
        client.timeout = request.timeout.unwrap_or(client.timeout);
        Ok(())
    }

    fn request_step(&mut self, uuid: &str, ticket: u64, now: Duration) -> Reply {
        let running = self.state == State::Running;
        let steps = self.world.steps() + 1;
        let Some(client) = self.clients.get_mut(uuid).filter(|_| running) else {
            return Reply::Now(Ok(vec![]));
        };
        // A client repeats its request after it has lost its connection.
        let before = client.step_request.replace(StepRequest { steps, open: Some((ticket, now)) });
        match before.and_then(|step_request| step_request.open) {
            Some((lost, _)) => Reply::LaterInsteadOf(lost),
            None => Reply::Later,
        }
    }

    /// The client has handled a keep-alive reply.
    fn resume(&mut self, uuid: &str, ticket: u64, now: Duration) -> Reply {
        match self.clients.get_mut(uuid).and_then(|client| client.step_request.as_mut()) {
            Some(step_request) if step_request.open.is_none() => {
                step_request.open = Some((ticket, now));
                Reply::Later
            }
            _ => Reply::Now(Ok(vec![])),
        }
    }

    fn set_stepping(&mut self, uuid: &str, arguments: &Arguments) -> Outcome {
        let enable = arguments.truth(0)?;
        let Some(client) = self.clients.get_mut(uuid) else { return Ok(vec![]) };
        let before = client.level;
        client.level = if enable { before.saturating_add(1) } else { before.saturating_sub(1) };
        Ok(vec![before.into()])
    }

    /// `sim.setFloatParam`, which has the lengths of both steps here.
    fn set_step_length(&mut self, arguments: &Arguments) -> Outcome {
        let (parameter, step) = (arguments.integer(0)?, arguments.number(1)?);
        if ![info::PARAM_TIME_STEP, info::PARAM_PHYSICS_STEP].contains(&parameter) {
            return Err(arguments.failure(316, "invalid parameter."));
        }
        if self.state != State::Stopped {
            return Ok(vec![Value::from(0)]);
        }
        if parameter == info::PARAM_PHYSICS_STEP {
            self.physics_step = step.clamp(1e-6, 1.0);
        } else {
            self.world.set_step_length(step).map_err(|error| arguments.failure(316, &format!("{error}.")))?;
        }
        Ok(vec![Value::from(1)])
    }

    pub(super) fn start(&mut self) {
        if self.state == State::Stopped {
            self.rebuild();
            self.world.reset();
            self.record_step();
        }
        self.state = State::Running;
    }

    /// Simulates the objects that clients have created since the latest start.
    fn rebuild(&mut self) {
        let Some(scene) = self.objects.take_changes() else { return };
        // A world that cannot be simulated has no place here: its robots have wheels of a size.
        if let Ok(mut world) = World::with_step(scene, self.world.step_length()) {
            recognition::set_motors(&self.objects, &mut world);
            self.world = world;
            self.drivers.clear();
        }
    }

    pub(super) fn stop(&mut self) {
        if self.state != State::Stopped {
            self.state = State::Stopped;
            self.world.park();
        }
        self.legacy.values_mut().for_each(LegacyClient::leave_synchronous_mode);
        for client in self.clients.values_mut() {
            client.level = 0;
            // The next run counts its steps from 0.
            if let Some(step_request) = &mut client.step_request {
                step_request.steps = 0;
            }
        }
    }

    pub(super) fn pause(&mut self) {
        if self.state == State::Running {
            self.state = State::Paused;
        }
    }

    fn state_number(&self) -> i64 {
        match self.state {
            State::Stopped => 0,
            State::Paused => 8,
            State::Running if self.world.steps() == 0 => 16,
            State::Running => 17,
        }
    }

    /// Takes a step if all stepping clients have requested it, and answers the fulfilled requests.
    pub(super) fn step_if_ready(&mut self) -> Vec<Answer> {
        let steps = self.world.steps();
        let asks = |client: &Client| {
            client.step_request.as_ref().is_some_and(|step_request| step_request.steps > steps)
        };
        let stepping = self.clients.values().filter(|client| client.level > 0).map(asks);
        let triggering = self.legacy.values().filter(|client| client.synchronous);
        let mut joined = stepping.chain(triggering.map(|client| client.triggered)).peekable();
        let may = self.state == State::Running && self.allowance != Some(0);
        if may && joined.peek().is_some() && joined.all(|asks| asks) {
            self.allowance = self.allowance.map(|left| left.saturating_sub(1));
            self.take_step();
        }
        let (steps, running) = (self.world.steps(), self.state == State::Running);
        let mut answers = Vec::new();
        for client in self.clients.values_mut() {
            let Some(step_request) = &client.step_request else { continue };
            let cancelled =
                if self.server.keeps_steps_over_pauses() { self.state == State::Stopped } else { !running };
            let done = step_request.steps <= steps || cancelled;
            if let Some((ticket, _)) = step_request.open.filter(|_| done) {
                client.step_request = None;
                answers.push(Answer { ticket, bytes: encode(outcome_map(Ok(vec![]))) });
            }
        }
        answers
    }

    fn take_step(&mut self) {
        self.world.step();
        self.legacy.values_mut().for_each(LegacyClient::await_trigger);
        self.record_step();
    }

    fn record_step(&mut self) {
        if let Some(trace) = &mut self.trace {
            trace.extend(self.world.records());
        }
    }
}

/// `zmqRemoteApi.require` and `.info`: `sim` is the only namespace here.
fn namespace(arguments: &Arguments) -> Outcome {
    match (arguments.text(0)?, arguments.is("zmqRemoteApi.info")) {
        ("sim", true) => Ok(vec![info::info()]),
        ("sim", false) => Ok(vec![]),
        (other, _) => Err(Failure(format!("module '{other}' not found: this simulator offers 'sim' only"))),
    }
}
