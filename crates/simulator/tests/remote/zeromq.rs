//! The ZeroMQ remote API, driven by clients and disturbed by invalid connections.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;

use ciborium::{Value, cbor};
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Robot, Scene, Wheel};
use pydslrep_simulator::{Options, Simulator, StartError};
use pydslrep_trace::TraceRecord;

use super::client::{Client, LIMIT, introduction};

fn scene(robots: usize) -> Scene {
    let robot = |number| {
        let wheels = vec![Wheel::new("wheelL", 0.035), Wheel::new("wheelR", 0.035)];
        Robot::new(format!("robot_{number}"), Drive::TwoWheel, wheels, vec![])
    };
    Scene::empty_floor((1..=robots).map(robot).collect())
}

fn start(robots: usize) -> Simulator {
    let options = Options { ports: vec![0; robots], ..Options::default() };
    Simulator::start(scene(robots), &options).unwrap()
}

impl Client {
    async fn time(&mut self) -> f64 {
        self.call("sim.getSimulationTime", Value::Array(vec![])).await.as_float().unwrap()
    }

    /// Joins, drives its robot for `steps` steps, and leaves.
    async fn drive(&mut self, robot: usize, steps: usize) {
        for (wheel, rate) in [("wheelL", 1.0), ("wheelR", 2.0)] {
            let path = format!("/robot_{robot}/{wheel}");
            let joint = self.call("sim.getObject", cbor!([path]).unwrap()).await;
            self.call("sim.setJointTargetVelocity", cbor!([joint, rate]).unwrap()).await;
        }
        for _ in 0..steps {
            self.call("sim.step", Value::Array(vec![])).await;
        }
        self.call("sim.setStepping", cbor!([false]).unwrap()).await;
    }
}

/// The trace of two robots with one client and port each.
async fn drive_two(steps: usize) -> Vec<TraceRecord> {
    let simulator = start(2);
    let mut first = Client::connect(simulator.ports()[0], "first").await;
    let mut second = Client::connect(simulator.ports()[1], "second").await;
    first.call("sim.setStepping", cbor!([true]).unwrap()).await;
    second.call("sim.setStepping", cbor!([true]).unwrap()).await;
    first.call("sim.startSimulation", Value::Array(vec![])).await;
    tokio::join!(first.drive(1, steps), second.drive(2, steps));
    first.call("sim.stopSimulation", Value::Array(vec![])).await;
    simulator.stop()
}

#[tokio::test]
async fn two_clients_on_two_ports_advance_in_lockstep_and_always_alike() {
    let trace = drive_two(100).await;
    // After one client leaves, the clock may run freely until the stop.
    let last = 2 * 101;
    assert!(trace.len() >= last, "{}", trace.len());
    assert_eq!(trace[0].t.to_bits(), 0.0_f64.to_bits());
    let (first, second) = (&trace[last - 2], &trace[last - 1]);
    assert!((first.t - 5.0).abs() < 1e-9 && first.robot == "robot_1" && second.robot == "robot_2");
    assert!(first.x > 0.1 && (first.x - second.x).abs() < 1e-12 && (first.y - second.y - 1.0).abs() < 1e-12);
    assert_eq!(drive_two(100).await[..last], trace[..last]);
}

#[tokio::test]
async fn a_client_that_hangs_up_in_the_middle_of_a_step_holds_nobody_up() {
    let simulator = start(2);
    let mut stays = Client::connect(simulator.ports()[0], "stays").await;
    let mut leaves = Client::connect(simulator.ports()[1], "leaves").await;
    for client in [&mut stays, &mut leaves] {
        client.call("sim.setStepping", cbor!([true]).unwrap()).await;
    }
    stays.call("sim.startSimulation", Value::Array(vec![])).await;
    let both = async {
        stays.call("sim.step", Value::Array(vec![])).await;
        stays.call("sim.step", Value::Array(vec![])).await;
    };
    let one = async {
        leaves.call("sim.step", Value::Array(vec![])).await;
        drop(leaves);
    };
    tokio::join!(both, one);
    assert!((stays.time().await - 0.1).abs() < 1e-9);
}

/// Sends bytes and returns whether the simulator closes the connection.
fn is_refused(port: u16, bytes: &[u8]) -> bool {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(LIMIT)).unwrap();
    // The connection may close before everything is sent.
    let _ = stream.write_all(bytes);
    loop {
        match stream.read(&mut [0; 1024]) {
            Ok(0) => return true,
            Ok(_) => {}
            Err(error) => return error.kind() == ErrorKind::ConnectionReset,
        }
    }
}

#[tokio::test]
async fn strangers_and_garbage_disturb_nobody() {
    let simulator = start(1);
    let port = simulator.ports()[0];
    let mut client = Client::connect(port, "friend").await;
    client.call("sim.setStepping", cbor!([true]).unwrap()).await;
    client.call("sim.startSimulation", Value::Array(vec![])).await;
    let mut half = introduction();
    half.truncate(70);
    let mut silent = TcpStream::connect(("127.0.0.1", port)).unwrap();
    silent.write_all(&half).unwrap();
    assert!(is_refused(port, b"GET / HTTP/1.1\r\n\r\n"));
    assert!(is_refused(port, &[0; 5000]));
    let huge = [introduction(), b"\x02\x00\x00\x7f\xff\xff\xff\xff\xff".to_vec()].concat();
    assert!(is_refused(port, &huge));
    let nested = [vec![0x81; 200], vec![0]].concat();
    let answered = [introduction(), vec![1, 0, 0, 201], nested, b"\x08".to_vec()].concat();
    assert!(is_refused(port, &answered), "answered the nonsense, refused the flags after it");
    client.call("sim.step", Value::Array(vec![])).await;
    assert!((client.time().await - 0.05).abs() < 1e-9);
}

#[tokio::test]
async fn connections_without_a_client_give_way() {
    /// As many as the simulator serves at once.
    const ALL: usize = 256;
    let simulator = start(1);
    let port = simulator.ports()[0];
    let mut friend = Client::connect(port, "friend").await;
    friend.call("sim.setStepping", cbor!([true]).unwrap()).await;
    let silent = |number: usize| {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
        stream.set_read_timeout(Some(LIMIT)).unwrap();
        // Half of them do not even finish the handshake.
        let bytes = introduction();
        stream.write_all(if number.is_multiple_of(2) { &bytes } else { &bytes[..9] }).unwrap();
        // It is admitted once it is answered.
        stream.read_exact(&mut [0; 64]).unwrap();
        stream
    };
    let mut silent: Vec<TcpStream> = (1..ALL).map(silent).collect();
    let mut newcomer = Client::connect(port, "newcomer").await;
    newcomer.time().await;
    let is_closed = |stream: &mut TcpStream| {
        let mut rest = Vec::new();
        stream
            .read_to_end(&mut rest)
            .map_or_else(|error| error.kind() == ErrorKind::ConnectionReset, |_| true)
    };
    assert!(is_closed(&mut silent[0]), "the oldest gave way");
    friend.call("sim.startSimulation", Value::Array(vec![])).await;
    friend.call("sim.step", Value::Array(vec![])).await;
    assert!((friend.time().await - 0.05).abs() < 1e-9, "one with a client stays");
}

#[tokio::test]
async fn without_stepping_time_passes_by_itself() {
    let options = Options { speed: 100.0, ..Options::default() };
    let simulator = Simulator::start(scene(1), &options).unwrap();
    let mut client = Client::connect(simulator.ports()[0], "reader").await;
    client.call("sim.startSimulation", Value::Array(vec![])).await;
    // A step requested outside stepping mode is answered after the clock has taken it.
    client.call("sim.step", Value::Array(vec![])).await;
    assert!(client.time().await >= 0.05);
    assert!(simulator.time() >= 0.05 && simulator.poses().len() == 1);
}

#[test]
fn a_port_that_is_taken_is_reported_or_replaced() {
    let first = start(1);
    let taken = first.ports()[0];
    let options = Options { ports: vec![taken], ..Options::default() };
    let error = Simulator::start(scene(1), &options).err().unwrap();
    assert!(matches!(&error, StartError::Port { port, .. } if *port == taken));
    assert!(error.to_string().contains(&taken.to_string()));
    let flexible = Options { ports: vec![taken, 0, taken], any_port_if_taken: true, ..options };
    let second = Simulator::start(scene(1), &flexible).unwrap();
    let ports = second.ports();
    assert!(ports.len() == 3 && ports[0] == ports[2] && !ports[..2].contains(&taken) && ports[0] != ports[1]);
    first.stop();
    assert!(TcpStream::connect(("127.0.0.1", taken)).is_err(), "a stopped simulator releases its port");
}

#[test]
fn records_are_lines_of_the_trace_format() {
    let record = TraceRecord {
        t: 0.05,
        robot: "robot_1".to_owned(),
        x: 1.0,
        y: -1.0,
        theta: 0.5,
        wheels: vec![1.0, 2.0],
        readings: BTreeMap::new(),
        movement: None,
        action: None,
    };
    let want = r#"{"t":0.05,"robot":"robot_1","x":1.0,"y":-1.0,"theta":0.5,"wheels":[1.0,2.0],"movement":null,"action":null}"#;
    assert_eq!(serde_json::to_string(&record).unwrap(), want);
}
