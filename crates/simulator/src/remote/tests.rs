//! The remote API from a client's point of view: CBOR in, CBOR out.

use std::time::Duration;

use ciborium::{Value, cbor};
use proptest::prelude::*;
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Obstacle, Robot, Scene, SensorKind, Wheel};

use super::*;
use crate::{Server, World};

const SECOND: Duration = Duration::from_secs(1);

/// A session with its open requests and its answers.
struct Lab {
    session: Session,
    now: Duration,
    last_ticket: u64,
    answers: Vec<(u64, Value)>,
}

impl Lab {
    /// Robots `robot_1`, `robot_2`, …, each with wheels `wheelL`, `wheelR` and a sensor `fSensor`.
    fn new(robots: usize) -> Self {
        Self::among(robots, vec![])
    }

    fn among(robots: usize, obstacles: Vec<Obstacle>) -> Self {
        let robot = |number| {
            let wheels = vec![Wheel::new("wheelL", 0.035), Wheel::new("wheelR", 0.035)];
            let sensors = vec![("fSensor".to_owned(), SensorKind::Distance)];
            Robot::new(format!("robot_{number}"), Drive::TwoWheel, wheels, sensors)
        };
        let scene = Scene { obstacles, ..Scene::empty_floor((1..=robots).map(robot).collect()) };
        let mut session = Session::new(World::new(scene).unwrap());
        session.record();
        Self { session, now: Duration::ZERO, last_ticket: 0, answers: vec![] }
    }

    fn take(&mut self, answers: Vec<Answer>) {
        for Answer { ticket, bytes } in answers {
            self.answers.push((ticket, ciborium::from_reader(bytes.as_slice()).unwrap()));
        }
    }

    fn send(&mut self, client: &str, request: &Value) -> u64 {
        let mut bytes = Vec::new();
        ciborium::into_writer(request, &mut bytes).unwrap();
        self.last_ticket += 1;
        // The tests' clients have one connection each, numbered by their names.
        let connection = u64::from(client.as_bytes()[0]);
        let answers = self.session.request(connection, self.last_ticket, self.now, &bytes);
        self.take(answers);
        self.last_ticket
    }

    /// Sends a request and returns its ticket.
    #[allow(clippy::needless_pass_by_value)] // callers build the arguments on the spot
    fn ask(&mut self, client: &str, function: &str, arguments: Value) -> u64 {
        let length = arguments.as_array().map_or(0, Vec::len);
        let request =
            cbor!({ "func" => function, "args" => arguments, "argsL" => length, "uuid" => client }).unwrap();
        self.send(client, &request)
    }

    fn answered(&mut self, ticket: u64) -> Option<Value> {
        let place = self.answers.iter().position(|(answered, _)| *answered == ticket)?;
        Some(self.answers.remove(place).1)
    }

    /// Calls and returns the reply, which must be immediate.
    fn reply(&mut self, client: &str, function: &str, arguments: Value) -> Value {
        let ticket = self.ask(client, function, arguments);
        self.answered(ticket).expect("an immediate answer")
    }

    /// Calls and returns the values.
    fn call(&mut self, client: &str, function: &str, arguments: Value) -> Vec<Value> {
        let reply = self.reply(client, function, arguments);
        match get(&reply, "ret").unwrap_or_else(|| panic!("{function}: {reply:?}")) {
            Value::Array(values) => values,
            Value::Map(values) if values.is_empty() => vec![],
            other => panic!("{other:?}"),
        }
    }

    fn number(&mut self, client: &str, function: &str, arguments: Value) -> f64 {
        let values = self.call(client, function, arguments);
        assert_eq!(values.len(), 1, "{function}: {values:?}");
        float(&values[0])
    }

    fn numbers(&mut self, client: &str, function: &str, arguments: Value) -> Vec<f64> {
        let values = self.call(client, function, arguments);
        values[0].as_array().unwrap().iter().map(float).collect()
    }

    fn error(&mut self, function: &str, arguments: Value) -> String {
        let reply = self.reply("a", function, arguments);
        get(&reply, "err").and_then(|text| text.into_text().ok()).unwrap_or_else(|| panic!("{reply:?}"))
    }

    fn object(&mut self, path: &str) -> i64 {
        let handle = self.call("a", "sim.getObject", cbor!([path]).unwrap());
        i64::try_from(handle[0].as_integer().unwrap()).unwrap()
    }

    fn time(&mut self) -> f64 {
        self.number("z", "sim.getSimulationTime", none())
    }

    fn join(&mut self, client: &str) {
        self.call(client, "sim.setStepping", cbor!([true]).unwrap());
    }

    fn start(&mut self) {
        self.call("z", "sim.startSimulation", none());
    }
}

fn none() -> Value {
    Value::Array(vec![])
}

fn get(map: &Value, key: &str) -> Option<Value> {
    let map = map.as_map()?;
    map.iter().find(|(name, _)| name.as_text() == Some(key)).map(|(_, value)| value.clone())
}

#[allow(clippy::cast_precision_loss)]
fn float(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|whole| i128::from(whole) as f64)).unwrap()
}

fn assert_near(found: &[f64], wanted: &[f64]) {
    let near = found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near, "{found:?}, wanted {wanted:?}");
}

#[test]
fn the_first_messages_of_the_real_client() {
    let mut lab = Lab::new(1);
    let first = cbor!({
        "func" => "zmqRemoteApi.require", "args" => ["sim"], "argsL" => 1, "uuid" => "a",
        "ver" => 2, "lang" => "python", "timeout" => 600,
    });
    let ticket = lab.send("a", &first.unwrap());
    assert_eq!(lab.answered(ticket), Some(cbor!({ "ret" => {} }).unwrap()));
    let info = lab.call("a", "zmqRemoteApi.info", cbor!(["sim"]).unwrap());
    let info = info[0].as_map().unwrap();
    assert!(info.iter().all(|(_, entry)| entry.as_map().is_some_and(|entry| entry.len() == 1)));
    let running = info.iter().find(|(name, _)| name.as_text() == Some("simulation_advancing_running"));
    assert_eq!(running.map(|(_, value)| value.clone()), Some(cbor!({ "const" => 17 }).unwrap()));
    assert!(lab.error("zmqRemoteApi.require", cbor!(["simIK"]).unwrap()).contains("simIK"));
}

#[test]
fn every_function_of_the_info_map_is_supported() {
    for function in info::FUNCTIONS {
        let mut lab = Lab::new(1);
        let reply = lab.reply("a", &format!("sim.{function}"), none());
        let error = get(&reply, "err").and_then(|text| text.into_text().ok()).unwrap_or_default();
        assert!(!error.contains("No such function"), "{error}");
    }
    assert_eq!(Lab::new(1).error("sim.nothere", none()), "No such function: sim.nothere");
}

#[test]
fn errors_match_the_engines_messages() {
    let mut lab = Lab::new(1);
    let (robot, joint, sensor) =
        (lab.object("/robot_1"), lab.object("/robot_1/wheelL"), lab.object("/robot_1/fSensor"));
    let mut check = |function: &str, arguments: Result<Value, _>, want: &str| {
        assert_eq!(lab.error(function, arguments.unwrap()), want);
    };
    let unknown = "1308: in sim._getObject: object does not exist, or alias/path is ill formatted.";
    check("sim.getObject", cbor!(["/x"]), unknown);
    check("sim.getObject", cbor!(["x"]), unknown);
    let type_error = "1308: in sim._getObject: one of the function's argument type is not correct.";
    check("sim.getObject", cbor!([]), type_error);
    check("sim.getObject", cbor!([3]), type_error);
    check("sim.getObjectPosition", cbor!([99]), "316: in sim.getObjectPosition: object does not exist.");
    check("sim.getObjectPose", cbor!([robot, 99]), "316: in sim.getObjectPose: object does not exist.");
    let no_joint = "316: in sim.setJointTargetVelocity: object is not a joint.";
    check("sim.setJointTargetVelocity", cbor!([robot, 1]), no_joint);
    let missing = "316: in sim.setJointTargetVelocity: the function requires more arguments.";
    check("sim.setJointTargetVelocity", cbor!([joint]), missing);
    let wrong = "316: in sim.setJointTargetVelocity: one of the function's argument type is not correct.";
    check("sim.setJointTargetVelocity", cbor!([joint, f64::NAN]), wrong);
    check("sim.setJointTargetVelocity", cbor!([joint, f64::INFINITY]), wrong);
    let explicit = "316: in sim.handleProximitySensor: object not tagged for explicit handling.";
    check("sim.handleProximitySensor", cbor!([sensor]), explicit);
    let no_sensor = "316: in sim.readProximitySensor: object is not a proximity sensor.";
    check("sim.readProximitySensor", cbor!([joint]), no_sensor);
}

#[test]
fn objects_by_path_option_and_alias() {
    let mut lab = Lab::new(2);
    let second = lab.object("/robot_2");
    let joint = lab.object("/robot_2/wheelR");
    let below = cbor!(["./wheelR", { "proxy" => second }]).unwrap();
    assert_near(&[lab.number("a", "sim.getObject", below)], &[float(&joint.into())]);
    let indexed = cbor!(["/wheelR", { "index" => 1 }]).unwrap();
    assert_near(&[lab.number("a", "sim.getObject", indexed)], &[float(&joint.into())]);
    let missing = cbor!(["/no", { "noError" => true }]).unwrap();
    assert_near(&[lab.number("a", "sim.getObject", missing)], &[-1.0]);
    for (option, want) in [(-1, "wheelR"), (1, "/robot_2/wheelR"), (2, "/robot_2/wheelR")] {
        let alias = lab.call("a", "sim.getObjectAlias", cbor!([joint, option]).unwrap());
        assert_eq!(alias, [Value::from(want)]);
    }
    assert_eq!(lab.call("a", "sim.getObjectAlias", cbor!([second]).unwrap()), [Value::from("robot_2")]);
    assert_near(&[lab.number("a", "sim.getObjectParent", cbor!([joint]).unwrap())], &[float(&second.into())]);
    assert_near(&[lab.number("a", "sim.getObjectType", cbor!([joint]).unwrap())], &[1.0]);
    let mode = cbor!([joint, 2039]).unwrap();
    assert_near(&[lab.number("a", "sim.getObjectInt32Param", mode.clone())], &[4.0]);
    lab.call("a", "sim.setObjectInt32Param", cbor!([joint, 2039, 0]).unwrap());
    assert_near(&[lab.number("a", "sim.getObjectInt32Param", mode)], &[0.0]);
}

#[test]
fn a_wheel_and_a_sensor_of_one_name_differ_in_type() {
    let mut scene = Lab::new(1).session.world().scene().clone();
    scene.robots[0].sensors[0].name = "wheelL".to_owned();
    let mut lab = Lab::new(1);
    lab.session = Session::new(World::new(scene).unwrap());
    let mut types = vec![];
    for index in 0..3 {
        let arguments = cbor!(["/robot_1/wheelL", { "noError" => true, "index" => index }]).unwrap();
        let handle = lab.call("a", "sim.getObject", arguments).remove(0);
        if handle != Value::from(-1) {
            types.push(lab.number("a", "sim.getObjectType", Value::Array(vec![handle])));
        }
    }
    assert_near(&types, &[1.0, 5.0]);
}

#[test]
fn poses_in_every_form() {
    let mut lab = Lab::new(2);
    let (robot, joint) = (lab.object("/robot_2"), lab.object("/robot_2/wheelL"));
    assert_near(&lab.numbers("a", "sim.getObjectPosition", cbor!([robot]).unwrap()), &[0.0, -1.0, 0.035]);
    let world = cbor!([robot, -1]).unwrap();
    assert_near(&lab.numbers("a", "sim.getObjectPose", world), &[0.0, -1.0, 0.035, 0.0, 0.0, 0.0, 1.0]);
    for base in [cbor!([joint, robot]).unwrap(), cbor!([joint, -11]).unwrap()] {
        assert_near(&lab.numbers("a", "sim.getObjectPosition", base), &[0.0, 0.15, 0.0]);
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_near(
        &lab.numbers("a", "sim.getObjectOrientation", cbor!([joint]).unwrap()),
        &[-quarter, 0.0, 0.0],
    );
    let matrix = lab.numbers("a", "sim.getObjectMatrix", cbor!([joint, "_*NIL*_"]).unwrap());
    // The third column is the joint's axis, the fourth its position.
    assert_near(&matrix, &[1., 0., 0., 0., 0., 0., 1., -0.85, 0., -1., 0., 0.035]);
}

#[test]
fn one_client_steps_and_reads_what_happened() {
    let mut lab = Lab::new(1);
    let (robot, left, right) =
        (lab.object("/robot_1"), lab.object("/robot_1/wheelL"), lab.object("/robot_1/wheelR"));
    let sensor = lab.object("/robot_1/fSensor");
    let state = |lab: &mut Lab| lab.number("a", "sim.getSimulationState", none());
    let read = |lab: &mut Lab| lab.call("a", "sim.readProximitySensor", cbor!([sensor]).unwrap());
    assert_near(&[lab.number("a", "sim.setStepping", cbor!([true]).unwrap())], &[0.0]);
    assert_near(&[lab.number("a", "sim.setStepping", cbor!([true]).unwrap())], &[1.0]);
    assert_near(&[lab.number("a", "sim.setStepping", cbor!([false]).unwrap())], &[2.0]);
    assert!(lab.call("a", "sim.step", none()).is_empty(), "a stopped simulation does not step");
    assert_near(&[state(&mut lab)], &[0.0]);
    lab.call("a", "sim.startSimulation", none());
    assert_near(&[state(&mut lab), lab.time()], &[16.0, 0.0]);
    assert_eq!(read(&mut lab)[0], Value::from(-1));
    assert_near(&[lab.number("a", "sim.setJointTargetVelocity", cbor!([left, 2]).unwrap())], &[1.0]);
    lab.call("a", "sim.setJointTargetVelocity", cbor!([right, 2.0]).unwrap());
    for _ in 0..20 {
        assert!(lab.call("a", "sim.step", cbor!([true]).unwrap()).is_empty());
    }
    assert_near(&[state(&mut lab), lab.time()], &[17.0, 1.0]);
    let nothing = cbor!([0.0, 0.0, 0.0]).unwrap();
    let want = [Value::from(0), Value::from(0.0), nothing.clone(), Value::from(-1), nothing];
    assert_eq!(read(&mut lab), want);
    // 0.07 m/s after a ramp of 0.07 s at 1 m/s²
    let x = 0.07 * (1.0 - 0.035);
    assert_near(&lab.numbers("a", "sim.getObjectPosition", cbor!([robot]).unwrap()), &[x, 0.0, 0.035]);
    assert_near(&[lab.number("a", "sim.getJointPosition", cbor!([left]).unwrap())], &[x / 0.035]);
    let trace = lab.session.take_trace();
    assert_eq!(trace.len(), 21);
    assert!(trace[0].t == 0.0 && (trace[20].x - x).abs() < 1e-9 && (trace[20].wheels[1] - 2.0).abs() < 1e-9);
    lab.call("a", "sim.stopSimulation", none());
    assert_near(&[state(&mut lab), lab.time()], &[0.0, 1.0]);
    assert_near(&[lab.number("a", "sim.setStepping", cbor!([true]).unwrap())], &[0.0]);
    assert_eq!(read(&mut lab)[0], Value::from(-1));
    assert_near(&lab.numbers("a", "sim.getObjectPosition", cbor!([robot]).unwrap()), &[0.0, 0.0, 0.035]);
}

#[test]
fn a_paced_session_steps_no_faster_than_it_is_allowed() {
    let mut lab = Lab::new(1);
    lab.session.pace();
    lab.join("a");
    lab.start();
    assert!(lab.session.is_timed());
    let first = lab.ask("a", "sim.step", none());
    assert_eq!(lab.answered(first), None, "nothing is allowed yet");
    let answers = lab.session.allow(2);
    lab.take(answers);
    assert!(lab.answered(first).is_some());
    let second = lab.ask("a", "sim.step", none());
    let third = lab.ask("a", "sim.step", none());
    assert!(lab.answered(second).is_some() && lab.answered(third).is_none());
    // All but one of the unused steps expire.
    let answers = [lab.session.allow(5), lab.session.allow(0)].concat();
    lab.take(answers);
    assert!(lab.answered(third).is_some());
    let fourth = lab.ask("a", "sim.step", none());
    let fifth = lab.ask("a", "sim.step", none());
    assert!(lab.answered(fourth).is_some() && lab.answered(fifth).is_none());
}

#[test]
fn a_mirrored_joint_turns_the_other_way_for_the_same_motion() {
    let mut scene = Lab::new(1).session.world().scene().clone();
    scene.robots[0].wheels[0].mirrored = true;
    let mut lab = Lab::new(1);
    lab.session = Session::new(World::new(scene).unwrap());
    let (left, right) = (lab.object("/wheelL"), lab.object("/wheelR"));
    let axis = |lab: &mut Lab, joint| {
        lab.numbers("a", "sim.getObjectMatrix", cbor!([joint, -11]).unwrap())[6] // y of the third column
    };
    assert_near(&[axis(&mut lab, left), axis(&mut lab, right)], &[-1.0, 1.0]);
    lab.join("a");
    lab.start();
    lab.call("a", "sim.setJointTargetVelocity", cbor!([left, -1]).unwrap());
    lab.call("a", "sim.setJointTargetVelocity", cbor!([right, 1]).unwrap());
    lab.call("a", "sim.step", none());
    lab.call("a", "sim.step", none());
    let pose = lab.session.world().pose(0);
    assert!(pose.x > 0.0 && pose.theta.abs() < 1e-12, "{pose:?}");
    assert_near(&[lab.number("a", "sim.getJointVelocity", cbor!([left]).unwrap())], &[-1.0]);
    assert_near(&[lab.number("a", "sim.getJointTargetVelocity", cbor!([left]).unwrap())], &[-1.0]);
    let angle = pose.x / 0.035;
    assert_near(&[lab.number("a", "sim.getJointPosition", cbor!([left]).unwrap())], &[-angle]);
    assert_near(&[lab.number("a", "sim.getJointPosition", cbor!([right]).unwrap())], &[angle]);
}

#[test]
fn clients_advance_in_lockstep() {
    let mut lab = Lab::new(2);
    lab.join("a");
    lab.join("b");
    lab.start();
    let first = lab.ask("a", "sim.step", none());
    assert_eq!(lab.answered(first), None);
    assert_near(&[lab.time()], &[0.0]);
    let second = lab.ask("b", "sim.step", none());
    let done = Some(cbor!({ "ret" => {} }).unwrap());
    assert_eq!((lab.answered(first), lab.answered(second)), (done.clone(), done.clone()));
    assert_near(&[lab.time()], &[0.05]);
    // Clients that leave are no longer waited for, and others may read in between.
    let third = lab.ask("a", "sim.step", none());
    lab.number("b", "sim.getSimulationTime", none());
    assert_eq!(lab.answered(third), None);
    lab.call("b", "sim.setStepping", cbor!([false]).unwrap());
    assert_eq!(lab.answered(third), done);
    assert_near(&[lab.time()], &[0.1]);
}

#[test]
fn a_disconnected_client_blocks_nobody() {
    let mut lab = Lab::new(2);
    lab.join("a");
    lab.join("b");
    lab.start();
    let step = lab.ask("a", "sim.step", none());
    let answers = lab.session.disconnect(u64::from(b'b'));
    lab.take(answers);
    assert!(lab.answered(step).is_some());
    // A client that disconnects during its own step is removed with it.
    lab.join("b");
    lab.ask("a", "sim.step", none());
    let answers = lab.session.disconnect(u64::from(b'a'));
    lab.take(answers);
    let step = lab.ask("b", "sim.step", none());
    assert!(lab.answered(step).is_some());
}

#[test]
fn a_silent_client_expires_after_its_timeout() {
    let mut lab = Lab::new(2);
    let hello = cbor!({ "func" => "sim.setStepping", "args" => [true], "uuid" => "a", "timeout" => 5 });
    lab.send("a", &hello.unwrap());
    lab.join("b");
    lab.start();
    lab.ask("b", "sim.step", none());
    lab.now = 5 * SECOND;
    let answers = lab.session.expire_clients(lab.now);
    lab.take(answers);
    // b gets a keep-alive reply and confirms it; a has not expired yet.
    let step = lab.ask("b", "_*executed*_", none());
    assert_near(&[lab.time()], &[0.0]);
    lab.now += Duration::from_millis(1);
    let answers = lab.session.expire_clients(lab.now);
    lab.take(answers);
    assert!(lab.answered(step).is_some_and(|reply| get(&reply, "ret").is_some()));
    assert_near(&[lab.time()], &[0.05]);
}

#[test]
fn a_client_that_waited_long_for_a_step_still_holds_the_time_after_it() {
    let mut lab = Lab::new(2);
    let hello = cbor!({ "func" => "sim.setStepping", "args" => [true], "uuid" => "a", "timeout" => 5 });
    lab.send("a", &hello.unwrap());
    lab.join("b");
    lab.start();
    let mut step = lab.ask("a", "sim.step", none());
    for _ in 0..60 {
        lab.now += SECOND;
        let answers = lab.session.expire_clients(lab.now);
        lab.take(answers);
        assert!(lab.answered(step).is_some_and(|reply| get(&reply, "func").is_some()), "a keep-alive reply");
        step = lab.ask("a", "_*executed*_", none());
    }
    lab.ask("b", "sim.step", none());
    assert!(lab.answered(step).is_some_and(|reply| get(&reply, "ret").is_some()));
    // From here on it is silent: it holds the time for five seconds, and no longer.
    let next = lab.ask("b", "sim.step", none());
    for (after, holds) in [(5 * SECOND, true), (Duration::from_millis(1), false)] {
        lab.now += after;
        let answers = lab.session.expire_clients(lab.now);
        lab.take(answers);
        assert_near(&[lab.time()], &[if holds { 0.05 } else { 0.1 }]);
        if holds {
            assert!(lab.answered(next).is_some_and(|reply| get(&reply, "func").is_some()));
            lab.ask("b", "_*executed*_", none());
        }
    }
}

#[test]
fn a_client_has_its_timeout_to_handle_a_keep_alive_reply() {
    let mut lab = Lab::new(2);
    let hello = cbor!({ "func" => "sim.setStepping", "args" => [true], "uuid" => "a", "timeout" => 5 });
    lab.send("a", &hello.unwrap());
    lab.join("b");
    lab.start();
    lab.ask("a", "sim.step", none());
    for (seconds, clients) in [(4, 3), (9, 3), (10, 2)] {
        lab.now = seconds * SECOND;
        let answers = lab.session.expire_clients(lab.now);
        lab.take(answers);
        assert_eq!(lab.session.client_count(), clients, "after {seconds} s");
    }
}

#[test]
fn a_waiting_client_gets_a_keep_alive_reply() {
    let mut lab = Lab::new(2);
    lab.join("a");
    lab.join("b");
    lab.start();
    let step = lab.ask("a", "sim.step", none());
    lab.now = 2 * SECOND;
    let answers = lab.session.expire_clients(lab.now);
    lab.take(answers);
    let wait = cbor!({ "func" => "_*wait*_", "args" => [] }).unwrap();
    assert_eq!(lab.answered(step), Some(wait));
    // The step is taken before the client confirms: its next request is answered at once.
    let other = lab.ask("b", "sim.step", none());
    assert!(lab.answered(other).is_some());
    assert!(lab.call("a", "_*executed*_", none()).is_empty());
    assert_near(&[lab.time()], &[0.05]);
    assert!(lab.call("a", "_*executed*_", none()).is_empty(), "no request is open");
}

#[test]
fn a_stop_answers_all_clients_and_the_next_run_starts_anew() {
    let mut lab = Lab::new(2);
    lab.join("a");
    lab.join("b");
    lab.start();
    let step = lab.ask("a", "sim.step", none());
    lab.call("b", "sim.stopSimulation", none());
    assert!(lab.answered(step).is_some());
    lab.join("a");
    lab.start();
    assert!(lab.call("a", "sim.step", none()).is_empty(), "b has not joined again");
    assert_near(&[lab.time()], &[0.05]);
}

#[test]
fn every_repeated_request_is_answered() {
    let mut lab = Lab::new(2);
    lab.join("a");
    lab.join("b");
    lab.start();
    let first = lab.ask("a", "sim.step", none());
    let again = lab.ask("a", "sim.step", none());
    assert!(lab.answered(first).is_some_and(|reply| get(&reply, "err").is_some()));
    lab.ask("b", "sim.step", none());
    assert!(lab.answered(again).is_some_and(|reply| get(&reply, "ret").is_some()));
    assert_near(&[lab.time()], &[0.05]);
}

#[test]
fn the_clock_runs_freely_only_when_no_client_steps() {
    let mut lab = Lab::new(1);
    lab.session.tick();
    assert_near(&[lab.time()], &[0.0]);
    lab.start();
    assert!(lab.session.is_free_running());
    let step = lab.ask("a", "sim.step", none());
    let answers = lab.session.tick();
    lab.take(answers);
    assert!(lab.answered(step).is_some(), "clients outside stepping mode wait for the clock");
    lab.join("a");
    lab.session.tick();
    assert_near(&[lab.time()], &[0.05]);
    lab.call("a", "sim.setStepping", cbor!([false]).unwrap());
    lab.call("a", "sim.pauseSimulation", none());
    lab.session.tick();
    assert_near(&[lab.time(), lab.number("a", "sim.getSimulationState", none())], &[0.05, 8.0]);
}

#[test]
fn invalid_requests_are_refused() {
    let mut lab = Lab::new(1);
    let complaint = |reply: Option<Value>| {
        let reply = reply.unwrap();
        assert_eq!(get(&reply, "success"), Some(Value::from(false)));
        get(&reply, "error").unwrap().into_text().unwrap()
    };
    let ticket = lab.send("a", &cbor!({ "func" => "sim.step" }).unwrap());
    assert!(complaint(lab.answered(ticket)).contains("version does not match"));
    let ticket = lab.send("a", &cbor!([1, 2]).unwrap());
    assert!(complaint(lab.answered(ticket)).contains("not a CBOR map"));
    let ticket = lab.send("a", &cbor!({ "eval" => "return 1", "uuid" => "a" }).unwrap());
    assert!(complaint(lab.answered(ticket)).contains("names no function"));
    let mut deep = vec![0x81; 100_000];
    deep.push(0);
    for bytes in [vec![], vec![0xff; 50], deep, vec![0x9b, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]] {
        let answers = lab.session.request(1, 99, Duration::ZERO, &bytes);
        lab.take(answers);
        assert!(complaint(lab.answered(99)).contains("not valid CBOR"));
    }
    assert_eq!(lab.session.client_count(), 0);
    assert_eq!(lab.reply("a", "_*end*_", none()), cbor!({}).unwrap());
}

#[test]
fn the_number_of_clients_per_connection_is_limited() {
    let mut lab = Lab::new(1);
    for number in 0..1000 {
        lab.ask(&format!("a{number}"), "sim.getSimulationTime", none());
    }
    assert!(lab.session.client_count() <= 16);
}

fn values() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        any::<i64>().prop_map(Value::from),
        (-3i64..12).prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        any::<bool>().prop_map(Value::from),
        Just(Value::Null),
        "[/.a-z0-9\\[\\]]{0,12}".prop_map(Value::from),
        Just(Value::from("/robot_1/wheelL")),
        prop::collection::vec(any::<u8>(), 0..9).prop_map(Value::Bytes),
    ];
    leaf.prop_recursive(2, 12, 4, |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..4).prop_map(Value::Array),
            prop::collection::vec(("[a-zA-Z]{0,8}".prop_map(Value::from), inner), 0..3).prop_map(Value::Map),
        ]
    })
}

#[test]
fn a_sensor_reports_detections_in_its_own_frame() {
    // The wall's surface is 0.5 m ahead of the first robot, which faces along x, and slightly rotated to the left.
    let wall = Obstacle::wall("wall_7", (0.72, -0.4), (0.68, 0.4), 0.01);
    let mut lab = Lab::among(2, vec![wall]);
    let (sensor, wall) = (lab.object("/robot_1/fSensor"), lab.object("/wall_7"));
    lab.join("a");
    lab.start();
    let read = |lab: &mut Lab| lab.call("a", "sim.readProximitySensor", cbor!([sensor]).unwrap());
    assert_eq!(read(&mut lab)[0], Value::from(-1), "not evaluated yet");
    lab.call("a", "sim.step", none());
    let seen = read(&mut lab);
    let vector = |value: &Value| value.as_array().unwrap().iter().map(float).collect::<Vec<_>>();
    let (distance, point, normal) = (float(&seen[1]), vector(&seen[2]), vector(&seen[4]));
    assert_eq!((&seen[0], &seen[3]), (&Value::from(1), &Value::from(wall)));
    let lean = (0.04_f64 / 0.8).atan();
    assert!((distance - (0.55 * lean.cos() - 0.005)).abs() < 1e-9, "{distance}");
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    // The sensor's z axis points ahead, its y axis to the left.
    assert!(
        near(point[0], 0.0) && near(point[1], distance * lean.sin()) && near(point[2], distance * lean.cos())
    );
    assert!(near(normal[1], -lean.sin()) && near(normal[2], -lean.cos()), "{normal:?}");
    assert_eq!(lab.call("a", "sim.getObjectType", cbor!([wall]).unwrap()), [Value::from(0)]);
    let still = lab.call("a", "sim.getObjectVelocity", cbor!([wall]).unwrap());
    assert_eq!(vector(&still[0]), [0.0; 3]);
    let range = cbor!([sensor, "volume_range"]).unwrap();
    assert_near(&[lab.number("a", "sim.getFloatProperty", range)], &[1.0]);
    let angles = lab.call("a", "sim.getFloatArrayProperty", cbor!([sensor, "volume_angle"]).unwrap());
    assert_near(&vector(&angles[0]), &[20f64.to_radians(), 0.0]);
    let other = lab.object("/robot_2/fSensor");
    let seen = lab.call("a", "sim.readProximitySensor", cbor!([other]).unwrap());
    assert_eq!((&seen[0], &seen[3]), (&Value::from(0), &Value::from(-1)), "the other robot looks past it");
}

proptest! {
    #[test]
    fn arbitrary_bytes_get_one_answer(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
        let mut lab = Lab::new(1);
        let answers = lab.session.request(1, 7, Duration::ZERO, &bytes);
        prop_assert_eq!(answers.iter().map(|answer| answer.ticket).collect::<Vec<_>>(), [7]);
    }

    #[test]
    fn arbitrary_calls_get_one_answer_each_and_the_session_survives(
        calls in prop::collection::vec(
            (0..3usize, prop::sample::select(info::FUNCTIONS), prop::collection::vec(values(), 0..4)), 1..40),
    ) {
        let mut lab = Lab::new(2);
        for (client, function, arguments) in calls {
            lab.ask(["a", "b", "c"][client], &format!("sim.{function}"), Value::Array(arguments));
        }
        for client in *b"abc" {
            let answers = lab.session.disconnect(u64::from(client));
            lab.take(answers);
        }
        let mut tickets: Vec<u64> = lab.answers.iter().map(|(ticket, _)| *ticket).collect();
        let answered = tickets.len();
        tickets.sort_unstable();
        tickets.dedup();
        prop_assert_eq!(tickets.len(), answered);
        // Only the last request of a disconnected client may stay open.
        prop_assert!(lab.last_ticket - answered as u64 <= 3);
        lab.call("d", "sim.stopSimulation", none());
        lab.join("d");
        lab.call("d", "sim.startSimulation", none());
        lab.call("d", "sim.step", none());
        prop_assert!((lab.time() - 0.05).abs() < 1e-12);
        prop_assert!(lab.session.world().pose(0).x.is_finite());
    }
}

/// A session as that of a server of `CoppeliaSim`, with the simulation running.
fn lab_like(server: Server) -> Lab {
    let mut lab = Lab::new(1);
    lab.session.imitate(server);
    lab.start();
    lab
}

#[test]
fn a_paused_4_6_answers_nothing_until_it_goes_on() {
    let mut lab = lab_like(Server::CoppeliaSim46);
    lab.join("a");
    let left = lab.object("/robot_1/wheelL");
    lab.call("b", "sim.pauseSimulation", none());
    let set = lab.ask("a", "sim.setJointTargetVelocity", cbor!([left, 2.0]).unwrap());
    let step = lab.ask("a", "sim.step", none());
    lab.now += 3 * SECOND;
    let answers = lab.session.expire_clients(lab.now);
    lab.take(answers);
    assert_eq!((lab.answered(set), lab.answered(step)), (None, None));
    lab.session.start();
    let answers = lab.session.answer_held_requests(lab.now);
    lab.take(answers);
    assert!(lab.answered(set).is_some() && lab.answered(step).is_some());
    assert!((lab.time() - 0.05).abs() < 1e-12);
}

#[test]
fn requests_during_a_pause_are_bounded() {
    let mut lab = lab_like(Server::CoppeliaSim46);
    lab.call("b", "sim.pauseSimulation", none());
    let answered = (0..5000).filter(|_| {
        let ticket = lab.ask("a", "sim.getSimulationTime", none());
        lab.answered(ticket).is_some()
    });
    assert_eq!(answered.count(), 5000 - 4096);
}

#[test]
fn a_pause_outlives_clients_with_a_short_timeout() {
    let mut lab = lab_like(Server::CoppeliaSim46);
    let hello = cbor!({ "func" => "sim.setStepping", "args" => [true], "uuid" => "a", "timeout" => 5 });
    lab.send("a", &hello.unwrap());
    lab.call("b", "sim.pauseSimulation", none());
    let again = lab.ask("a", "sim.setStepping", cbor!([true]).unwrap());
    lab.now += 60 * SECOND;
    lab.session.start();
    let answers = lab.session.answer_held_requests(lab.now);
    lab.take(answers);
    assert_eq!(lab.answered(again), Some(cbor!({ "ret" => [0] }).unwrap()), "it has been forgotten");
}

#[test]
fn a_step_of_a_paused_4_7_takes_no_time() {
    let mut lab = lab_like(Server::CoppeliaSim47);
    lab.join("a");
    lab.join("c");
    let before = lab.ask("a", "sim.step", none());
    lab.call("b", "sim.pauseSimulation", none());
    assert!(lab.call("c", "sim.step", none()).is_empty());
    assert!(lab.answered(before).is_none(), "it was requested before the pause");
    assert_eq!((lab.time(), lab.number("b", "sim.getSimulationState", none())), (0.0, 8.0));
    lab.start();
    let after = lab.ask("c", "sim.step", none());
    assert!(lab.answered(before).is_some() && lab.answered(after).is_some());
}

#[test]
fn a_lost_client_holds_the_time_until_its_timeout() {
    let mut lab = lab_like(Server::CoppeliaSim46);
    let left = lab.object("/robot_1/wheelL");
    let hello = cbor!({ "func" => "sim.setStepping", "args" => [true], "uuid" => "b", "timeout" => 5 });
    lab.send("b", &hello.unwrap());
    lab.call("b", "sim.setJointTargetVelocity", cbor!([left, 2.0]).unwrap());
    lab.ask("b", "sim.step", none());
    let answers = lab.session.disconnect(u64::from(b'b'));
    lab.take(answers);
    lab.join("a");
    let step = lab.ask("a", "sim.step", none());
    assert_eq!(lab.answered(step), None);
    assert!(lab.number("a", "sim.getJointTargetVelocity", cbor!([left]).unwrap()) > 1.9);
    lab.now += 6 * SECOND;
    let answers = lab.session.expire_clients(lab.now);
    lab.take(answers);
    let step = lab.answered(step).expect("a keep-alive reply or the step");
    assert!(get(&step, "ret").is_some(), "{step:?}");
}
