//! Bytes as calls of the remote APIs, and as the frames that carry them.

use std::time::Duration;

use ciborium::Value;
use pydslrep_kinematics::Drive;
use pydslrep_scene::{Robot, Scene, SensorKind, Wheel};
use pydslrep_simulator::{Answer, Session, World, edge};

const MAX_CALLS: usize = 64;

fn session() -> Option<Session> {
    let wheels = vec![Wheel::new("l", 0.04), Wheel::new("r", 0.04)];
    let sensors = vec![("s".to_owned(), SensorKind::Distance)];
    let robot = Robot::new("rover".to_owned(), Drive::TwoWheel, wheels, sensors);
    Some(Session::new(World::new(Scene::empty_floor(vec![robot])).ok()?))
}

/// Calls: each has a byte for the client and its protocol, and two for its length.
pub(crate) fn calls(data: &[u8]) {
    let Some(mut session) = session() else { return };
    let mut rest = data;
    for ticket in 0..MAX_CALLS {
        let [client, high, low, after @ ..] = rest else { return };
        let length = usize::from(u16::from_be_bytes([*high, *low])).min(after.len());
        let (call, next) = after.split_at(length);
        rest = next;
        let ticket = ticket as u64;
        let (connection, now) = (u64::from(client & 3), Duration::from_millis(100 * ticket));
        match client >> 6 {
            0 | 1 => check(&session.request(connection, ticket, now, call)),
            2 => {
                if let Ok(response) = session.legacy_message(connection, now, call) {
                    check(&response.answers);
                }
            }
            _ => check(&session.disconnect(connection)),
        }
        check(&session.tick());
        assert!(session.world().pose(0).x.is_finite(), "the robot is nowhere");
    }
}

fn check(answers: &[Answer]) {
    for answer in answers {
        let decoded: Result<Value, _> = ciborium::from_reader(answer.bytes.as_slice());
        assert!(decoded.is_ok(), "not CBOR: {:?}", answer.bytes);
    }
}

/// What a client sends: its first byte says how many bytes arrive at a time.
pub(crate) fn frames(data: &[u8]) {
    let [pace, bytes @ ..] = data else { return };
    let at_once = edge::count_messages(bytes, bytes.len().max(1));
    let in_parts = edge::count_messages(bytes, usize::from(*pace).max(1));
    assert_eq!(at_once, in_parts, "it depends on how the bytes arrive");
}
