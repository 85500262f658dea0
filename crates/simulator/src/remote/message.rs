//! Messages of ZeroMQ's remote API: requests and their replies, each one CBOR map.

use std::time::Duration;

use ciborium::Value;

use super::arguments::{Failure, Outcome, integer};

/// The maximum nesting of requests; real ones have two or three levels, and more would overflow the stack.
const MAX_NESTING: usize = 32;

/// The maximum length of a client's name; real ones are UUIDs of 36 characters.
const MAX_UUID_LENGTH: usize = 128;

/// A request, decoded.
pub(super) struct Request {
    pub(super) function: String,
    pub(super) arguments: Vec<Value>,
    pub(super) uuid: String,
    pub(super) timeout: Option<Duration>,
}

impl Request {
    pub(super) fn decode(bytes: &[u8]) -> Result<Self, &'static str> {
        let value: Value = ciborium::de::from_reader_with_recursion_limit(bytes, MAX_NESTING)
            .map_err(|_| "the request is not valid CBOR")?;
        let Value::Map(map) = value else { return Err("the request is not a CBOR map") };
        let mut request =
            Self { function: String::new(), arguments: vec![], uuid: String::new(), timeout: None };
        for (key, value) in map {
            match (key.as_text().unwrap_or_default(), value) {
                ("func", Value::Text(function)) => request.function = function,
                ("args", Value::Array(arguments)) => request.arguments = arguments,
                ("uuid", Value::Text(uuid)) => request.uuid = uuid,
                ("timeout", value) => {
                    let seconds = integer(&value).and_then(|seconds| u64::try_from(seconds).ok());
                    request.timeout = seconds.map(Duration::from_secs);
                }
                _ => {}
            }
        }
        if request.uuid.is_empty() || request.uuid.len() > MAX_UUID_LENGTH {
            return Err("the client's version does not match: requests need a `uuid`");
        }
        if request.function.is_empty() {
            return Err("the request names no function (`func`)");
        }
        Ok(request)
    }
}

pub(super) fn outcome_map(outcome: Outcome) -> Vec<(Value, Value)> {
    match outcome {
        // The engine encodes an empty list as an empty map.
        Ok(values) if values.is_empty() => vec![("ret".into(), Value::Map(vec![]))],
        Ok(values) => vec![("ret".into(), Value::Array(values.into_iter().map(table).collect()))],
        Err(Failure(text)) => vec![("err".into(), text.into())],
    }
}

/// A value as the engine encodes it: its lists are Lua's tables, of which an empty one is a map.
fn table(value: Value) -> Value {
    if value.as_array().is_some_and(Vec::is_empty) { Value::Map(vec![]) } else { value }
}

pub(super) fn encode(map: Vec<(Value, Value)>) -> Vec<u8> {
    let mut bytes = Vec::new();
    // Neither writing to a Vec nor encoding these values can fail.
    let written = ciborium::into_writer(&Value::Map(map), &mut bytes);
    debug_assert!(written.is_ok());
    bytes
}
