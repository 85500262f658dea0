//! The legacy remote API on real ports, with the bytes of V-REP's client, next to ZeroMQ clients and invalid connections.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;

use ciborium::cbor;
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Robot, Scene, Wheel};
use pydslrep_simulator::{Options, Simulator};

use super::client::{self, LIMIT};

/// The client's request for the handle of `/robot_1`, as message number 0.
const ASK_HANDLE: &[u8] = b"\x01\x00\x35\x00\x00\x00\
    \x00\x00\x0b\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\
    \x23\x00\x00\x00\x23\x00\x00\x00\x09\x00\x00\x00\x00\x00\x01\x30\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\
    /robot_1\0";

fn start() -> Simulator {
    let wheels = vec![Wheel::new("wheelL", 0.05), Wheel::new("wheelR", 0.05)];
    let scene = Scene::empty_floor(vec![Robot::new("robot_1", Drive::TwoWheel, wheels, vec![])]);
    Simulator::start(scene, &Options::default()).unwrap()
}

struct Client {
    stream: TcpStream,
    last_id: i32,
}

impl Client {
    fn connect(simulator: &Simulator) -> Self {
        let stream = TcpStream::connect(("127.0.0.1", simulator.ports()[0])).unwrap();
        stream.set_read_timeout(Some(LIMIT)).unwrap();
        Self { stream, last_id: -1 }
    }

    /// Sends a blocking command without waiting.
    fn send(&mut self, kind: u16, key: &[i32], payload: &[u8]) {
        self.last_id += 1;
        let key: Vec<u8> = key.iter().flat_map(|number| number.to_le_bytes()).collect();
        let mut message = vec![0, 0, 11];
        message.extend_from_slice(&self.last_id.to_le_bytes());
        message.resize(18, 0);
        let size = u8::try_from(26 + key.len() + payload.len()).unwrap();
        message.extend_from_slice(&[
            size,
            0,
            0,
            0,
            size,
            0,
            0,
            0,
            u8::try_from(key.len()).unwrap(),
            0,
            0,
            0,
            0,
            0,
        ]);
        message.extend_from_slice(&kind.to_le_bytes());
        message.extend_from_slice(&[1, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        message.extend(key.iter().chain(payload));
        let packet = [&[1, 0, u8::try_from(message.len()).unwrap(), 0, 0, 0], message.as_slice()].concat();
        self.stream.write_all(&packet).unwrap();
    }

    /// The reply to the last command: its simulation time in ms and its payload.
    fn receive(&mut self) -> (i32, Vec<u8>) {
        let mut header = [0; 6];
        self.stream.read_exact(&mut header).unwrap();
        let mut message = vec![0; usize::from(u16::from_le_bytes([header[2], header[3]]))];
        self.stream.read_exact(&mut message).unwrap();
        assert_eq!((&header[..2], &header[4..]), (&[1, 0][..], &[0, 0][..]));
        let number = |at: usize| i32::from_le_bytes(message[at..at + 4].try_into().unwrap());
        assert_eq!((number(3), message[18 + 24]), (self.last_id, 0));
        let key = usize::from(message[18 + 8]);
        (number(18 + 20), message[18 + 26 + key..].to_vec())
    }

    fn ask(&mut self, kind: u16, key: &[i32], payload: &[u8]) -> (i32, Vec<u8>) {
        self.send(kind, key, payload);
        self.receive()
    }

    fn time(&mut self) -> i32 {
        self.ask(0x1021, &[1], &[]).0
    }

    /// Returns whether the simulator closes the connection.
    fn is_refused(&mut self) -> bool {
        loop {
            match self.stream.read(&mut [0; 1024]) {
                Ok(0) => return true,
                Ok(_) => {}
                Err(error) => return error.kind() == ErrorKind::ConnectionReset,
            }
        }
    }
}

#[test]
fn a_handle_byte_by_byte_however_it_is_cut() {
    let simulator = start();
    for cut in [1, 7, 59] {
        let mut client = Client::connect(&simulator);
        client.stream.set_nodelay(true).unwrap();
        for part in ASK_HANDLE.chunks(cut) {
            client.stream.write_all(part).unwrap();
        }
        let mut reply = [0; 63];
        client.stream.read_exact(&mut reply).unwrap();
        assert_eq!(reply[..13], *b"\x01\x00\x39\x00\x00\x00\x00\x00\x0b\x00\x00\x00\x00");
        assert_eq!(reply[21..24], [0, 0, 4], "no scene number, stopped");
        let command = b"\x27\x00\x00\x00\x27\x00\x00\x00\x09\x00\x00\x00\x00\x00\x01\x30\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00";
        assert_eq!(reply[24..50], *command);
        assert_eq!(reply[50..], *b"/robot_1\0\x01\x00\x00\x00");
    }
}

#[test]
fn a_long_reply_comes_in_packets() {
    let wheels = |robot: usize| (0..4).map(|wheel| Wheel::new(format!("w{robot}_{wheel}"), 0.05)).collect();
    let robots =
        (0..100).map(|robot| Robot::new(format!("r{robot}"), Drive::FourWheel, wheels(robot), vec![]));
    let simulator = Simulator::start(Scene::empty_floor(robots.collect()), &Options::default()).unwrap();
    let mut client = Client::connect(&simulator);
    client.send(0x102a, &[1], &[]);
    let mut bytes = vec![0; 6 + 1294 + 6 + (18 + 30 + 4 + 1600 - 1294)];
    client.stream.read_exact(&mut bytes).unwrap();
    assert_eq!((&bytes[..6], &bytes[1300..1306]), (&[1, 0, 0x0e, 5, 1, 0][..], &[1, 0, 0x66, 1, 0, 0][..]));
    assert!(client.time() == 0, "and no more than that");
}

#[test]
fn a_port_serves_one_client_and_then_the_next() {
    let simulator = start();
    let mut first = Client::connect(&simulator);
    first.time();
    let mut second = Client::connect(&simulator);
    second.send(0x1021, &[1], &[]);
    let mut gone = Client::connect(&simulator);
    gone.send(0x1021, &[1], &[]);
    drop(gone);
    for _ in 0..20 {
        first.time();
    }
    second.stream.set_nonblocking(true).unwrap();
    assert_eq!(second.stream.read(&mut [0; 1]).unwrap_err().kind(), ErrorKind::WouldBlock);
    second.stream.set_nonblocking(false).unwrap();
    // The end command of the client library.
    first.ask(0x000a, &[0], &[]);
    assert!(first.is_refused());
    second.receive();
    assert_eq!(second.time(), 0);
}

#[test]
fn strangers_and_garbage_disturb_nobody() {
    let simulator = start();
    let mut friend = Client::connect(&simulator);
    friend.ask(0x0001, &[], &[]);
    friend.ask(0x1007, &[0], &[]);
    let version = [&ASK_HANDLE[..8], b"\x0a", &ASK_HANDLE[9..]].concat();
    let size = [&ASK_HANDLE[..24], b"\xff\xff\xff\x7f", &ASK_HANDLE[28..]].concat();
    for garbage in [
        &b"GET / HTTP/1.1\r\n\r\n"[..],
        b"\0",
        b"\x01\x01",
        b"\x01\x00\xff\xff\x00\x00",
        &[1, 0, 0, 0, 255, 255],
    ] {
        let mut stranger = Client::connect(&simulator);
        stranger.stream.write_all(garbage).unwrap();
        assert!(stranger.is_refused(), "{garbage:?}");
    }
    // Half a packet, and an empty connection, wait for more.
    let mut half = Client::connect(&simulator);
    half.stream.write_all(&ASK_HANDLE[..30]).unwrap();
    let _silent = Client::connect(&simulator);
    friend.ask(0x0003, &[], &[]);
    assert_eq!(friend.time(), 50);
    drop(half);
    drop(friend);
    // These are only parsed when it is their turn.
    for garbage in [&version, &size, &b"\x01\x00\x00\x00\x00\x00".to_vec()] {
        let mut stranger = Client::connect(&simulator);
        stranger.stream.write_all(garbage).unwrap();
        assert!(stranger.is_refused());
    }
    let mut next = Client::connect(&simulator);
    next.ask(0x0001, &[], &[]);
    assert!(next.time() >= 50);
}

#[test]
fn a_client_that_vanishes_stops_its_wheels_and_holds_nobody_up() {
    let simulator = start();
    let mut client = Client::connect(&simulator);
    client.ask(0x0001, &[], &[]);
    client.ask(0x1007, &[0], &[]);
    for joint in [2, 3] {
        client.ask(0x1008, &[joint], &2.0_f32.to_le_bytes());
    }
    client.ask(0x0003, &[], &[]);
    drop(client);
    let mut next = Client::connect(&simulator);
    next.ask(0x0001, &[], &[]);
    let rate = |client: &mut Client| {
        client.ask(0x0003, &[], &[]);
        f32::from_le_bytes(client.ask(0x2007, &[2, 2012], &[]).1.try_into().unwrap())
    };
    let rates: Vec<f32> = (0..5).map(|_| rate(&mut next)).collect();
    assert!(rates[4] == 0.0, "{rates:?}");
}

/// A client of each protocol, on one port and in one world.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn clients_of_both_protocols_advance_in_lockstep() {
    let simulator = start();
    let mut modern = client::Client::connect(simulator.ports()[0], "modern").await;
    let mut legacy = Client::connect(&simulator);
    legacy.ask(0x0001, &[], &[]);
    modern.call("sim.setStepping", cbor!([true]).unwrap()).await;
    legacy.ask(0x1007, &[0], &[]);
    for step in 1..=50 {
        legacy.ask(0x0003, &[], &[]);
        assert_eq!(legacy.time(), (step - 1) * 50, "the other one has not stepped");
        modern.call("sim.step", cbor!([]).unwrap()).await;
        assert_eq!(legacy.time(), step * 50);
    }
    drop(legacy);
    modern.call("sim.step", cbor!([]).unwrap()).await;
    let time = modern.call("sim.getSimulationTime", cbor!([]).unwrap()).await;
    assert!((time.as_float().unwrap() - 2.55).abs() < 1e-9, "{time:?}");
}
