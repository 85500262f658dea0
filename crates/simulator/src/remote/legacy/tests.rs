//! The legacy remote API from a client's point of view: messages in, messages out, byte by byte.

use std::time::Duration;

use proptest::prelude::*;
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Obstacle, Robot, Scene, SensorKind, Wheel};

use super::{LegacyResponse, Malformed};
use crate::{Session, World};

const ROBOT: i32 = 1;
const LEFT: i32 = 2;
const RIGHT: i32 = 3;
const SENSOR: i32 = 4;

const BLOCKING: i32 = 0x1_0000;
const STREAMING: i32 = 0x2_0000;
const DISCONTINUE: i32 = 0x5_0000;

/// A session with one robot `r`, its wheels `l` and `m` and its sensor `s`, and helpers for its clients.
struct Lab {
    session: Session,
    now: Duration,
    last_id: i32,
}

/// A decoded reply.
#[derive(Debug)]
struct Seen {
    id: i32,
    state: u8,
    commands: Vec<Part>,
}

#[derive(Debug, PartialEq)]
struct Part {
    command: i32,
    time: i32,
    failed: bool,
    key: Vec<u8>,
    payload: Vec<u8>,
}

impl Lab {
    fn new() -> Self {
        Self::among(vec![])
    }

    fn among(obstacles: Vec<Obstacle>) -> Self {
        let mut wheels = vec![Wheel::new("l", 0.05), Wheel::new("m", 0.05)];
        wheels[1].mirrored = true;
        let sensors = vec![("s".to_owned(), SensorKind::Distance)];
        let robots = vec![Robot::new("r", Drive::TwoWheel, wheels, sensors)];
        let scene = Scene { obstacles, ..Scene::empty_floor(robots) };
        Self { session: Session::new(World::new(scene).unwrap()), now: Duration::from_secs(3), last_id: -1 }
    }

    /// Sends commands from a client.
    fn send(&mut self, client: u64, commands: &[Vec<u8>]) -> Seen {
        self.last_id += 1;
        let message = [header(self.last_id), commands.concat()].concat();
        let response = self.session.legacy_message(client, self.now, &message).unwrap();
        assert!(response.answers.is_empty());
        let (head, mut rest) = response.reply.split_at(18);
        assert_eq!(
            (&head[..3], &head[7..17]),
            (&[0, 0, 11][..], &[0x44, 0x33, 0x22, 0x11, 0xb8, 0x0b, 0, 0, 0, 0][..])
        );
        let mut commands = Vec::new();
        while !rest.is_empty() {
            let (size, key) = (number_at(rest, 0), usize::from(u16::from_le_bytes([rest[8], rest[9]])));
            assert_eq!((number_at(rest, 4), &rest[10..14]), (size, &[0; 4][..]), "nothing comes in pieces");
            let (this, others) = rest.split_at(usize::try_from(size).unwrap());
            let (key, payload) = this[26..].split_at(key);
            let [failed, unused] = [this[24], this[25]];
            assert!(failed <= 1 && unused == 0);
            let (key, payload) = (key.to_vec(), payload.to_vec());
            commands.push(Part {
                command: number_at(this, 14),
                time: number_at(this, 20),
                failed: failed == 1,
                key,
                payload,
            });
            rest = others;
        }
        Seen { id: number_at(head, 3), state: head[17], commands }
    }

    /// Sends one command, which must succeed, and returns its result.
    fn ask(&mut self, client: u64, kind: i32, key: &[i32], payload: &[u8]) -> Vec<u8> {
        let part = self.try_ask(client, kind, key, payload);
        assert!(!part.failed, "{part:?}");
        part.payload
    }

    fn try_ask(&mut self, client: u64, kind: i32, key: &[i32], payload: &[u8]) -> Part {
        let mut seen = self.send(client, &[command(kind + BLOCKING, &keyed(key), payload)]);
        assert_eq!((seen.id, seen.commands.len()), (self.last_id, 1));
        seen.commands.remove(0)
    }

    fn position(&mut self, client: u64) -> Vec<f32> {
        floats(&self.ask(client, 0x200e, &[ROBOT, -1], &[]))
    }

    fn time(&mut self, client: u64) -> i32 {
        self.try_ask(client, 0x1021, &[1], &[]).time
    }
}

fn number_at(bytes: &[u8], at: usize) -> i32 {
    i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn header(id: i32) -> Vec<u8> {
    let mut bytes = vec![0, 0, 11];
    bytes.extend_from_slice(&id.to_le_bytes());
    bytes.extend_from_slice(&0x1122_3344_i32.to_le_bytes());
    bytes.resize(18, 0);
    bytes
}

fn keyed(key: &[i32]) -> Vec<u8> {
    key.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn named(name: &str) -> Vec<u8> {
    [name.as_bytes(), b"\0"].concat()
}

/// A command; the low half of the number is its kind, the high half its mode.
fn command(number: i32, key: &[u8], payload: &[u8]) -> Vec<u8> {
    let size = i32::try_from(26 + key.len() + payload.len()).unwrap().to_le_bytes();
    let mut bytes = [size, size].concat();
    bytes.extend_from_slice(&u16::try_from(key.len()).unwrap().to_le_bytes());
    bytes.extend_from_slice(&[0; 4]);
    bytes.extend_from_slice(&number.to_le_bytes());
    bytes.resize(26, 0);
    [&bytes, key, payload].concat()
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

#[test]
fn a_handle_byte_by_byte() {
    let mut lab = Lab::new();
    let message = b"\
        \x00\x00\x0b\x07\x00\x00\x00\x10\x20\x30\x40\x00\x00\x00\x00\x00\x00\x00\
        \x1d\x00\x00\x00\x1d\x00\x00\x00\x03\x00\x00\x00\x00\x00\x01\x30\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\
        /r\0";
    let response = lab.session.legacy_message(5, Duration::from_millis(258), message).unwrap();
    let reply = b"\
        \x00\x00\x0b\x07\x00\x00\x00\x10\x20\x30\x40\x02\x01\x00\x00\x00\x00\x04\
        \x21\x00\x00\x00\x21\x00\x00\x00\x03\x00\x00\x00\x00\x00\x01\x30\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\
        /r\0\x01\x00\x00\x00";
    assert_eq!(response, LegacyResponse { reply: reply.to_vec(), is_last: false, answers: vec![] });
}

#[test]
fn an_empty_message_executes_nothing() {
    let mut lab = Lab::new();
    let seen = lab.send(1, &[]);
    assert!((seen.id, seen.state, seen.commands.len()) == (-1, 4, 0), "{seen:?}");
}

#[test]
fn names_are_those_of_current_engines() {
    let mut lab = Lab::new();
    for (name, handle) in [
        ("r", ROBOT),
        ("/r", ROBOT),
        ("/r/l", LEFT),
        ("l", LEFT),
        ("/m", RIGHT),
        ("/r/s", SENSOR),
        ("r/l", -1),
        ("l_r", -1),
        ("l#0", -1),
        ("./l", -1),
        ("", -1),
        ("/", -1),
    ] {
        let part = lab.send(1, &[command(0x3001 + BLOCKING, &named(name), &[])]).commands.remove(0);
        assert_eq!((part.payload, part.failed), (handle.to_le_bytes().to_vec(), handle < 0), "{name}");
    }
    assert!(lab.send(1, &[command(0x3001, b"\xff\xfe\0", &[])]).commands[0].failed);
}

#[test]
fn objects_can_be_queried() {
    let mut lab = Lab::new();
    assert_eq!(floats(&lab.ask(1, 0x200e, &[LEFT, ROBOT], &[])), [0.0, 0.15, 0.0]);
    // The left joint's axis points to the left, the right one's to the right, too: it is mirrored.
    let quarter = std::f32::consts::FRAC_PI_2;
    assert_eq!(floats(&lab.ask(1, 0x200d, &[LEFT, -1], &[])), [-quarter, 0.0, 0.0]);
    assert_eq!(floats(&lab.ask(1, 0x200d, &[RIGHT, -1], &[])), [quarter, 0.0, 0.0]);
    assert_eq!(floats(&lab.ask(1, 0x2801, &[ROBOT, -1], &[])), [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(lab.ask(1, 0x102a, &[1], &[]), keyed(&[2, LEFT, RIGHT]));
    assert_eq!(lab.ask(1, 0x102a, &[5], &[]), keyed(&[1, SENSOR]));
    assert_eq!(lab.ask(1, 0x1012, &[LEFT], &[]), ROBOT.to_le_bytes());
    assert_eq!(lab.ask(1, 0x1012, &[ROBOT], &[]), (-1_i32).to_le_bytes());
    assert_eq!(lab.ask(1, 0x1021, &[1], &[]), 40600_i32.to_le_bytes());
    assert_eq!(floats(&lab.ask(1, 0x1023, &[1], &[])), [0.05]);
    assert_eq!(lab.ask(1, 0x2008, &[LEFT, 2039], &[]), 4_i32.to_le_bytes());
    assert_eq!(lab.ask(1, 0x2008, &[LEFT, 2000], &[]), 1_i32.to_le_bytes());
    assert_eq!(lab.ask(1, 0x0004, &[], &[]), [0; 4]);
    assert!(lab.ask(1, 0x1020, &[25], &[1, 0, 0, 0]).is_empty());
}

#[test]
fn only_invalid_commands_fail() {
    let mut lab = Lab::new();
    let missing = lab.try_ask(1, 0x200e, &[99, -1], &[]);
    assert_eq!((missing.failed, missing.payload), (true, vec![0; 12]));
    let nan = f32::NAN.to_le_bytes();
    let cases: [(i32, &[i32], &[u8]); 12] = [
        (0x1008, &[ROBOT], &[0; 4]),
        (0x1008, &[LEFT], &[0; 3]),
        (0x1008, &[LEFT], &nan),
        (0x1008, &[], &[0; 4]),
        (0x1001, &[SENSOR], &[]),
        (0x1009, &[LEFT], &[]),
        (0x200e, &[ROBOT], &[]),
        (0x2007, &[LEFT, 3], &[]),
        (0x2007, &[ROBOT, 2012], &[]),
        (0x1007, &[7], &[]),
        (0x1fff, &[0], &[]),
        (0x3401, &[1], &[]),
    ];
    for (kind, key, payload) in cases {
        let part = lab.try_ask(1, kind, key, payload);
        assert!(part.failed, "{kind:#x} {key:?}");
    }
    // Split commands, and modes internal to clients.
    for mode in [3, 4, 6, 7, 8, 0x7fff] {
        assert!(
            lab.send(1, &[command(0x1021 + (mode << 16), &keyed(&[1]), &[])]).commands[0].failed,
            "{mode}"
        );
    }
    assert_eq!(lab.position(1), [0.0, 0.0, 0.05]);
}

#[test]
fn wheels_turn_about_their_joints_own_axis() {
    let mut lab = Lab::new();
    let rate = |rate: f32| rate.to_le_bytes();
    lab.ask(1, 0x1007, &[0], &[]);
    lab.ask(1, 0x1008, &[LEFT], &rate(2.0));
    lab.ask(1, 0x1008, &[RIGHT], &rate(-2.0));
    for _ in 0..10 {
        lab.session.tick();
    }
    let x = lab.position(1)[0];
    // 0.5 s at 0.1 m/s, and half of the 0.1 s in which the motors get there is lost.
    assert!((x - 0.045).abs() < 1e-6, "{x}");
    assert_eq!(floats(&lab.ask(1, 0x2007, &[RIGHT, 2012], &[])), [-2.0]);
    assert_eq!(floats(&lab.ask(1, 0x2007, &[ROBOT, 11], &[])), [0.1]);
    assert_eq!(floats(&lab.ask(1, 0x1036, &[ROBOT], &[])), [0.1, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert!((floats(&lab.ask(1, 0x1001, &[LEFT], &[]))[0] - 0.9).abs() < 1e-6);
    assert!((floats(&lab.ask(1, 0x1001, &[RIGHT], &[]))[0] + 0.9).abs() < 1e-6, "it is mirrored");
    assert_eq!(lab.time(1), 500);
}

#[test]
fn sensors_are_blind_before_the_first_step() {
    let mut lab = Lab::new();
    let blind = lab.try_ask(1, 0x1009, &[SENSOR], &[]);
    assert_eq!((blind.failed, blind.payload.len(), blind.payload[0]), (true, 29, 0xff));
    lab.ask(1, 0x1007, &[0], &[]);
    lab.session.tick();
    assert_eq!(lab.ask(1, 0x1009, &[SENSOR], &[])[0], 0);
}

#[test]
fn a_sensor_reports_what_it_detects() {
    let mut lab = Lab::among(vec![Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1)]);
    lab.ask(1, 0x1007, &[0], &[]);
    lab.session.tick();
    let seen = lab.ask(1, 0x1009, &[SENSOR], &[]);
    // Minus half the body length (0.3 m) and half the wall thickness.
    let (point, normal) = (floats(&seen[1..13]), floats(&seen[17..]));
    assert!((point[2] - 0.8).abs() < 1e-6 && point[1].abs() < 1e-6 && (normal[2] + 1.0).abs() < 1e-6);
    assert_eq!((seen[0], seen.len(), &seen[13..17]), (1, 29, &(SENSOR + 1).to_le_bytes()[..]));
}

#[test]
fn streams_come_with_every_pass_until_discontinued() {
    let mut lab = Lab::new();
    let key = keyed(&[ROBOT, -1]);
    let first = lab.send(1, &[command(0x200e + STREAMING, &key, &[])]);
    assert_eq!((first.id, first.commands.len(), first.commands[0].command), (0, 1, 0x200e + STREAMING));
    let again = lab.send(1, &[]);
    assert_eq!(
        (again.id, &again.commands),
        (1, &first.commands),
        "an empty message brings streams, and its own number"
    );
    let beside = lab.send(1, &[command(0x1021 + BLOCKING, &keyed(&[1]), &[])]);
    assert_eq!(beside.commands.len(), 2);
    assert!(lab.send(2, &[]).commands.is_empty(), "another client has streams of its own");
    let end = lab.send(1, &[command(0x200e + DISCONTINUE, &key, &[])]);
    let echo =
        Part { command: 0x200e + DISCONTINUE, time: 0, failed: false, key: key.clone(), payload: vec![] };
    assert_eq!(end.commands, [echo]);
    assert!(lab.send(1, &[]).commands.is_empty());
    // Streams are identified by their keys; a blocking read ends the stream of the same key.
    lab.send(
        1,
        &[command(0x200e + STREAMING, &key, &[]), command(0x200e + STREAMING, &keyed(&[LEFT, -1]), &[])],
    );
    assert_eq!(lab.send(1, &[command(0x200e + BLOCKING, &key, &[])]).commands.len(), 2);
    assert_eq!(lab.send(1, &[]).commands[0].key, keyed(&[LEFT, -1]));
    // Repeating a stream does not add a second one.
    lab.send(1, &[command(0x200e + STREAMING, &keyed(&[LEFT, -1]), &[])]);
    assert_eq!(lab.send(1, &[]).commands.len(), 1);
}

#[test]
fn a_stream_may_have_a_period() {
    let mut lab = Lab::new();
    let mut slow = command(0x200e + STREAMING, &keyed(&[ROBOT, -1]), &[]);
    slow[18] = 100;
    let mut counts = vec![lab.send(1, &[slow]).commands.len()];
    for _ in 0..8 {
        lab.now += Duration::from_millis(40);
        // The header has the server's time, which does not matter here.
        let response = lab.session.legacy_message(1, lab.now, &header(9)).unwrap();
        counts.push(usize::from(response.reply.len() > 18));
    }
    assert_eq!(counts, [1, 0, 0, 1, 0, 0, 1, 0, 0]);
}

#[test]
fn streams_have_a_limit() {
    let mut lab = Lab::new();
    let stream = |number: i32| command(0x200e + STREAMING, &keyed(&[number, -1]), &[]);
    for number in 0..1024 {
        lab.send(1, &[stream(number)]);
    }
    let over = lab.send(1, &[stream(5000)]);
    assert_eq!((over.commands[0].failed, over.commands[0].payload.len()), (true, 0));
    assert_eq!(lab.send(1, &[]).commands.len(), 1024);
}

#[test]
fn without_the_synchronous_mode_there_is_nothing_to_trigger() {
    let mut lab = Lab::new();
    lab.ask(1, 0x1007, &[0], &[]);
    assert!(lab.try_ask(1, 0x0003, &[], &[]).failed);
    lab.session.tick();
    assert_eq!(lab.time(1), 50);
    lab.ask(1, 0x1007, &[2], &[]);
    lab.ask(1, 0x0001, &[], &[]);
    assert!(lab.try_ask(1, 0x0003, &[], &[]).failed, "a stopped simulation does not advance");
}

#[test]
fn a_trigger_is_answered_before_its_step() {
    let mut lab = Lab::new();
    lab.ask(1, 0x0001, &[], &[]);
    lab.ask(1, 0x1007, &[0], &[]);
    assert!(lab.session.tick().is_empty());
    assert_eq!(lab.time(1), 0, "no step without a trigger");
    let trigger = command(0x0003 + BLOCKING, &[], &[]);
    let seen = lab.send(1, std::slice::from_ref(&trigger));
    assert_eq!((seen.state, seen.commands[0].time, seen.commands[0].failed), (5, 0, false));
    assert_eq!(lab.time(1), 50);
    assert_eq!(lab.time(1), 50);
    lab.send(1, &[trigger]);
    assert_eq!(lab.time(1), 100);
    lab.ask(1, 0x0002, &[], &[]);
    assert!(lab.session.is_free_running());
}

#[test]
fn synchronous_clients_advance_in_lockstep() {
    let mut lab = Lab::new();
    for client in [1, 2] {
        lab.ask(client, 0x0001, &[], &[]);
    }
    lab.ask(1, 0x1007, &[0], &[]);
    lab.ask(1, 0x0003, &[], &[]);
    lab.ask(1, 0x0003, &[], &[]);
    assert_eq!(lab.time(1), 0, "the other one has not triggered");
    lab.ask(2, 0x0003, &[], &[]);
    assert_eq!((lab.time(1), lab.time(2)), (50, 50), "two triggers of one client are not two steps");
    lab.ask(1, 0x0003, &[], &[]);
    assert!(lab.session.disconnect(2).is_empty());
    assert_eq!(lab.time(1), 100, "a disconnected client blocks nobody");
    // One waits while the other leaves the mode.
    lab.ask(3, 0x0001, &[], &[]);
    lab.ask(1, 0x0003, &[], &[]);
    lab.ask(3, 0x0002, &[], &[]);
    assert_eq!(lab.time(1), 150);
}

#[test]
fn stopping_ends_the_synchronous_mode_of_all() {
    let mut lab = Lab::new();
    lab.ask(1, 0x0001, &[], &[]);
    lab.ask(2, 0x0001, &[], &[]);
    lab.ask(1, 0x1007, &[0], &[]);
    lab.ask(2, 0x0003, &[], &[]);
    lab.ask(1, 0x1007, &[2], &[]);
    assert_eq!((lab.send(1, &[]).state, lab.time(1)), (4, 0));
    lab.ask(1, 0x1007, &[0], &[]);
    assert!(lab.session.is_free_running());
    // A pause stops both the free-running and the triggered clock.
    assert_eq!(lab.send(1, &[command(0x1007, &keyed(&[1]), &[])]).state, 7);
    lab.session.tick();
    assert_eq!(lab.time(1), 0);
}

#[test]
fn disconnecting_stops_the_wheels_of_a_client() {
    let mut lab = Lab::new();
    let rate = 2.0_f32.to_le_bytes();
    lab.ask(1, 0x1007, &[0], &[]);
    lab.ask(1, 0x1008, &[LEFT], &rate);
    lab.ask(1, 0x1008, &[RIGHT], &rate);
    lab.ask(2, 0x1008, &[RIGHT], &rate);
    lab.session.disconnect(1);
    let world = lab.session.world();
    assert!(world.target(0, 0) == 0.0, "no client drives it");
    assert!(world.target(0, 1) != 0.0, "another client has taken it over");
    lab.session.disconnect(2);
    assert!(lab.session.world().target(0, 1) == 0.0);
    assert_eq!(lab.session.client_count(), 0);
}

#[test]
fn a_client_disconnects_with_an_end_command() {
    let mut lab = Lab::new();
    let goodbye = [header(3), command(0x000a, &[0; 4], &[])].concat();
    assert_eq!(goodbye[18], 30);
    let response = lab.session.legacy_message(1, Duration::ZERO, &goodbye).unwrap();
    assert!(response.is_last && response.reply.len() == 18 + 30);
}

#[test]
fn invalid_messages_are_refused() {
    let mut lab = Lab::new();
    let good = command(0x1021, &keyed(&[1]), &[]);
    let changed = |at: usize, value: u8| {
        let mut bytes = [header(0), good.clone()].concat();
        bytes[at] = value;
        bytes
    };
    let refused = [
        vec![],
        header(0)[..17].to_vec(),
        changed(2, 10),  // version
        changed(18, 29), // trailing bytes
        changed(18, 31), // more than there is
        changed(18, 25), // less than a header
        changed(18, 0),
        changed(21, 0x80), // less than nothing
        changed(26, 5),    // a key that is longer than the command
        [header(0), good[..20].to_vec()].concat(),
    ];
    for (index, bytes) in refused.iter().enumerate() {
        assert_eq!(lab.session.legacy_message(1, Duration::ZERO, bytes), Err(Malformed), "{index}");
    }
    assert!(lab.session.legacy_message(1, Duration::ZERO, &changed(26, 4)).is_ok());
}

proptest! {
    /// Whatever the commands, nothing panics and the reply belongs to the message.
    #[test]
    fn arbitrary_commands_do_not_panic(
        parts in prop::collection::vec(
            (any::<u16>(), 0..8_i32, prop::collection::vec(any::<u8>(), 0..12), prop::collection::vec(any::<u8>(), 0..8)),
            0..6,
        ),
        known in any::<bool>(),
    ) {
        let kinds = [1, 2, 3, 0x1001, 0x1007, 0x1008, 0x1009, 0x1012, 0x102a, 0x2007, 0x2008, 0x200d, 0x200e, 0x3001];
        let mut lab = Lab::new();
        let commands: Vec<Vec<u8>> = parts
            .iter()
            .map(|(kind, mode, key, payload)| {
                let kind = if known { kinds[usize::from(*kind) % kinds.len()] } else { i32::from(*kind) };
                command(kind + (mode << 16), key, payload)
            })
            .collect();
        for _ in 0..2 {
            let seen = lab.send(1, &commands);
            let count = seen.commands.len();
            prop_assert!(count >= parts.len() && (seen.id == lab.last_id || count == 0));
        }
        lab.session.disconnect(1);
    }

    #[test]
    fn arbitrary_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..80), with_header in any::<bool>()) {
        let bytes = if with_header { [header(0), bytes].concat() } else { bytes };
        let _ = Lab::new().session.legacy_message(1, Duration::ZERO, &bytes);
    }
}
