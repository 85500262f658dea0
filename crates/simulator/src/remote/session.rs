//! Clients, their requests, and who may let time pass.

use std::collections::BTreeMap;
use std::time::Duration;

use ciborium::Value;
use pydslrep_record::TraceRecord;

use super::arguments::{Arguments, Failure, Outcome};
use super::calls::{self, Bench, Drivers};
use super::info;
use super::legacy::client::Client as LegacyClient;
use super::message::{Request, encode, outcome_map};
use super::objects::Objects;
use crate::{Sightings, World};

/// How many clients one connection may speak for; real ones speak for one.
const CLIENTS_PER_CONNECTION: usize = 16;

/// A client that asked for a step is told to keep waiting after this long, so that it can see we are alive.
const WAIT_ROUND: Duration = Duration::from_secs(1);

/// How long a silent client is remembered unless it says otherwise.
const DEFAULT_TIMEOUT: Duration = Duration::from_secs(600);

/// A reply and the request that it answers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// The number given with the request.
    pub ticket: u64,
    /// One CBOR map.
    pub bytes: Vec<u8>,
}

/// The remote API of one world: requests in, replies out, for any number of clients.
///
/// Every request gets exactly one answer, from the same call or from a later one: a client that asks for a step
/// is answered when the step was taken, and it is taken when every client in stepping mode has asked for it.
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
    /// Steps that clients may still have taken; `None` is any number.
    allowance: Option<u32>,
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
    /// Above 0: no step is taken before this client has asked for it.
    level: u32,
    /// The step it asked for, until it was told that it was taken.
    wanted: Option<Wanted>,
}

#[derive(Debug, Clone)]
struct Wanted {
    /// Satisfied when this many steps were taken.
    steps: u64,
    /// The request to answer, and when it came; `None` while the client is in a wait round.
    open: Option<(u64, Duration)>,
}

/// What becomes of a request.
enum Reply {
    Now(Outcome),
    Map(Vec<(Value, Value)>),
    Later,
    /// Later, and the earlier request with this ticket will not be answered any more.
    LaterInsteadOf(u64),
}

impl Session {
    /// A session on a world at rest; the simulation is stopped.
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
        }
    }

    /// Begins to record all robots at the start of the simulation and after every step.
    pub fn record(&mut self) {
        self.trace.get_or_insert_default();
    }

    /// From now on clients have steps taken only as [`Session::allow`] lets them.
    pub fn pace(&mut self) {
        self.allowance.get_or_insert(0);
    }

    /// Lets so many more steps be taken in a session that is paced. What nobody asks for is lost but for one step, so
    /// that a client that was slow does not make up for it in a rush.
    pub fn allow(&mut self, steps: u32) -> Vec<Answer> {
        let Some(left) = &mut self.allowance else { return Vec::new() };
        *left = (*left).min(1).saturating_add(steps);
        self.settle()
    }

    /// Whether the clock of the machine decides when steps are taken: nobody steps, or steps are paced.
    pub fn is_timed(&self) -> bool {
        self.state == State::Running && (self.allowance.is_some() || self.is_free_running())
    }

    /// What was recorded since the last time this was asked.
    pub fn take_trace(&mut self) -> Vec<TraceRecord> {
        self.trace.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// What sensors were read to see.
    pub fn sightings(&self) -> &Sightings {
        &self.seen
    }

    /// The world as it is now.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// How many clients are remembered.
    pub fn client_count(&self) -> usize {
        self.clients.len() + self.legacy.len()
    }

    /// Whether time passes by itself: the simulation runs and no client steps it.
    pub fn is_free_running(&self) -> bool {
        let nobody_steps = self.clients.values().all(|client| client.level == 0)
            && !self.legacy.values().any(LegacyClient::holds_time);
        self.state == State::Running && nobody_steps
    }

    /// Takes a request of one CBOR map.
    ///
    /// `ticket` comes back with the answer, `connection` says where the request came from, and `now` is the time
    /// since any fixed moment. The answers returned may be to this request, to earlier ones, or both.
    pub fn request(&mut self, connection: u64, ticket: u64, now: Duration, bytes: &[u8]) -> Vec<Answer> {
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
                let lost = Err(Failure("sim.step: asked again before the step was taken".to_owned()));
                answers.push(Answer { ticket, bytes: encode(outcome_map(lost)) });
            }
        }
        answers.extend(self.settle());
        answers
    }

    /// A connection is gone, and with it the clients that spoke through it: nobody waits for them any more, and the
    /// wheels that they drove stop.
    pub fn disconnect(&mut self, connection: u64) -> Vec<Answer> {
        self.clients.retain(|_, client| client.connection != connection);
        self.legacy.remove(&connection);
        self.drivers.retain(|&(robot, wheel), driver| {
            let stays = *driver != connection;
            if !stays {
                self.world.set_target(robot, wheel, 0.0);
            }
            stays
        });
        self.settle()
    }

    /// Forgets clients that were silent for longer than their timeout, and gives those that have waited long for
    /// their step a sign of life. To be called every now and then.
    pub fn keep_house(&mut self, now: Duration) -> Vec<Answer> {
        self.clients.retain(|_, client| {
            let waits = client.wanted.as_ref().is_some_and(|wanted| wanted.open.is_some());
            waits || now.saturating_sub(client.last_seen) <= client.timeout
        });
        let mut answers = self.settle();
        for client in self.clients.values_mut() {
            let Some(wanted) = &mut client.wanted else { continue };
            if wanted.open.is_some_and(|(_, since)| now.saturating_sub(since) >= WAIT_ROUND) {
                let wait = vec![("func".into(), "_*wait*_".into()), ("args".into(), Value::Array(vec![]))];
                answers.extend(wanted.open.take().map(|(ticket, _)| Answer { ticket, bytes: encode(wait) }));
                client.last_seen = now;
            }
        }
        answers
    }

    /// A step of the free-running clock; does nothing while clients step or the simulation stands.
    pub fn tick(&mut self) -> Vec<Answer> {
        if !self.is_free_running() {
            return Vec::new();
        }
        self.take_step();
        self.settle()
    }

    fn answer(&mut self, connection: u64, ticket: u64, now: Duration, request: &Request) -> Reply {
        if request.function == "_*end*_" {
            self.clients.remove(&request.uuid);
            return Reply::Map(vec![]);
        }
        if let Err(failure) = self.see_client(connection, now, request) {
            return Reply::Now(Err(failure));
        }
        let arguments = Arguments::new(&request.function, &request.arguments);
        let uuid = &request.uuid;
        let outcome = match request.function.as_str() {
            "zmqRemoteApi.require" | "zmqRemoteApi.info" => namespace(&arguments),
            "_*executed*_" => return self.resume(uuid, ticket, now),
            "sim.step" => return self.ask_step(uuid, ticket, now),
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
            "sim.getSimulationState" => Ok(vec![self.state_number().into()]),
            function => {
                let mut bench = self.bench(connection);
                let name = function.strip_prefix("sim.").unwrap_or_default();
                calls::call(&mut bench, name, &arguments)
                    .unwrap_or_else(|| Err(Failure(format!("No such function: {function}"))))
            }
        };
        Reply::Now(outcome)
    }

    /// What a call of a connection works on.
    pub(super) fn bench(&mut self, connection: u64) -> Bench<'_> {
        Bench {
            world: &mut self.world,
            objects: &self.objects,
            started: self.state != State::Stopped,
            drivers: &mut self.drivers,
            connection,
            seen: &mut self.seen,
        }
    }

    fn see_client(&mut self, connection: u64, now: Duration, request: &Request) -> Result<(), Failure> {
        if !self.clients.contains_key(&request.uuid) {
            let beside = self.clients.values().filter(|client| client.connection == connection).count();
            if beside >= CLIENTS_PER_CONNECTION {
                return Err(Failure("too many clients on one connection".to_owned()));
            }
        }
        let client = self.clients.entry(request.uuid.clone()).or_insert(Client {
            connection,
            last_seen: now,
            timeout: DEFAULT_TIMEOUT,
            level: 0,
            wanted: None,
        });
        client.connection = connection;
        client.last_seen = now;
        client.timeout = request.timeout.unwrap_or(client.timeout);
        Ok(())
    }

    fn ask_step(&mut self, uuid: &str, ticket: u64, now: Duration) -> Reply {
        let running = self.state == State::Running;
        let steps = self.world.steps() + 1;
        let Some(client) = self.clients.get_mut(uuid).filter(|_| running) else {
            return Reply::Now(Ok(vec![]));
        };
        // A client asks again without an answer when it lost its connection in between.
        let before = client.wanted.replace(Wanted { steps, open: Some((ticket, now)) });
        match before.and_then(|wanted| wanted.open) {
            Some((lost, _)) => Reply::LaterInsteadOf(lost),
            None => Reply::Later,
        }
    }

    /// The client is back from a wait round.
    fn resume(&mut self, uuid: &str, ticket: u64, now: Duration) -> Reply {
        match self.clients.get_mut(uuid).and_then(|client| client.wanted.as_mut()) {
            Some(wanted) if wanted.open.is_none() => {
                wanted.open = Some((ticket, now));
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

    pub(super) fn start(&mut self) {
        if self.state == State::Stopped {
            self.world.reset();
            self.note();
        }
        self.state = State::Running;
    }

    pub(super) fn stop(&mut self) {
        if self.state != State::Stopped {
            self.state = State::Stopped;
            self.world.park();
        }
        self.legacy.values_mut().for_each(LegacyClient::release);
        for client in self.clients.values_mut() {
            client.level = 0;
            // The next run counts its steps from 0 again.
            if let Some(wanted) = &mut client.wanted {
                wanted.steps = 0;
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

    /// Takes the step that everybody waits for, if so, and answers whom it concerns.
    pub(super) fn settle(&mut self) -> Vec<Answer> {
        let steps = self.world.steps();
        let asks = |client: &Client| client.wanted.as_ref().is_some_and(|wanted| wanted.steps > steps);
        let stepping = self.clients.values().filter(|client| client.level > 0).map(asks);
        let triggering = self.legacy.values().filter(|client| client.holds_time());
        let mut joined = stepping.chain(triggering.map(LegacyClient::asks)).peekable();
        let may = self.state == State::Running && self.allowance != Some(0);
        if may && joined.peek().is_some() && joined.all(|asks| asks) {
            self.allowance = self.allowance.map(|left| left.saturating_sub(1));
            self.take_step();
        }
        let (steps, running) = (self.world.steps(), self.state == State::Running);
        let mut answers = Vec::new();
        for client in self.clients.values_mut() {
            let Some(wanted) = &client.wanted else { continue };
            let done = wanted.steps <= steps || !running;
            if let Some((ticket, since)) = wanted.open.filter(|_| done) {
                client.last_seen = client.last_seen.max(since);
                client.wanted = None;
                answers.push(Answer { ticket, bytes: encode(outcome_map(Ok(vec![]))) });
            }
        }
        answers
    }

    fn take_step(&mut self) {
        self.world.step();
        self.legacy.values_mut().for_each(LegacyClient::await_trigger);
        self.note();
    }

    fn note(&mut self) {
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
