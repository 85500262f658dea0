//! Messages: the bytes of a frame as a JSON-RPC request, notification or response, or the error to answer with.

use std::borrow::Cow;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;
use serde_json::{Map, Value};
use tower_lsp::jsonrpc::{Error, ErrorCode, Id, Request, Response};
use tower_lsp::ls_types::notification::{Notification, ShowMessage};
use tower_lsp::ls_types::request::{self, Request as _};
use tower_lsp::ls_types::{MessageType, ShowMessageParams};

use crate::load::Load;

/// Begins the ids of requests whose answers are ignored.
pub(crate) const IGNORED: &str = "pydslrep: ignored ";

/// A message to the client, encoded.
pub(crate) type Body = Vec<u8>;

/// A message from the client.
#[derive(Debug, PartialEq)]
pub(crate) enum Incoming {
    /// A request, or a notification if it has no id.
    Request(Request),
    /// The answer to a request of ours.
    Response(Response),
}

/// Reads one message.
///
/// # Errors
///
/// The response to an unusable message: a parse error for text that is not JSON, an invalid request for JSON
/// that is not a message; with the message's id where it has a usable one, else null.
pub(crate) fn parse(body: &[u8]) -> Result<Incoming, Response> {
    let value = serde_json::from_slice(body)
        .or_else(|error| {
            without_lone_surrogates(body).map_or(Err(error), |replaced| serde_json::from_slice(&replaced))
        })
        .map_err(|error| refuse(Id::Null, ErrorCode::ParseError, format!("not JSON: {error}")))?;
    let Value::Object(mut fields) = value else {
        return Err(invalid(
            Id::Null,
            "a message must be a JSON object; batches are not part of the protocol",
        ));
    };
    let id: Result<Option<Id>, _> = fields.remove("id").map(serde_json::from_value).transpose();
    let answer_to = id.as_ref().ok().cloned().flatten().unwrap_or_default();
    if fields.get("jsonrpc").and_then(Value::as_str) != Some("2.0") {
        return Err(invalid(answer_to, "`jsonrpc` must be \"2.0\""));
    }
    let Ok(id) = id else {
        return Err(invalid(Id::Null, "`id` must be an integer or a string"));
    };
    match fields.remove("method") {
        Some(Value::String(method)) => Ok(Incoming::Request(request(method, id, &mut fields))),
        Some(_) => Err(invalid(answer_to, "`method` must be a string")),
        None => response(id, &mut fields).ok_or_else(|| {
            invalid(answer_to, "a message needs a `method`, or an `id` with a `result` or an `error`")
        }),
    }
}

/// Replaces lone surrogates, which an editor's text may hold but Unicode text cannot; `None` if there are none. The
/// replacement character is as long in UTF-16, so positions stay right. Refusing the message would lose the edit.
fn without_lone_surrogates(body: &[u8]) -> Option<Vec<u8>> {
    let escape = |at: usize| -> Option<u16> {
        let digits = body.get(at..)?.strip_prefix(b"\\u")?.get(..4)?;
        u16::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()
    };
    let mut replaced = body.to_vec();
    let mut at = 0;
    while at < body.len() {
        at += match (body[at], escape(at)) {
            (b'\\', Some(0xD800..=0xDBFF)) if matches!(escape(at + 6), Some(0xDC00..=0xDFFF)) => 12,
            (b'\\', Some(0xD800..=0xDFFF)) => {
                replaced[at..at + 6].copy_from_slice(b"\\ufffd");
                6
            }
            (b'\\', _) => 2,
            _ => 1,
        };
    }
    (replaced != body).then_some(replaced)
}

fn request(method: String, id: Option<Id>, fields: &mut Map<String, Value>) -> Request {
    // Some clients send `{}` where the protocol has no parameters at all.
    let params = fields.remove("params").filter(|_| method != request::Shutdown::METHOD);
    build(method, id, params)
}

/// A request with an id and parameters where there are any.
pub(crate) fn build(method: impl Into<Cow<'static, str>>, id: Option<Id>, params: Option<Value>) -> Request {
    let mut request = Request::build(method);
    if let Some(params) = params {
        request = request.params(params);
    }
    if let Some(id) = id {
        request = request.id(id);
    }
    request.finish()
}

fn response(id: Option<Id>, fields: &mut Map<String, Value>) -> Option<Incoming> {
    let id = id?;
    let result = if let Some(error) = fields.remove("error").filter(|error| !error.is_null()) {
        Err(serde_json::from_value(error).unwrap_or_else(|_| Error::internal_error()))
    } else {
        Ok(fields.remove("result")?)
    };
    Some(Incoming::Response(Response::from_parts(id, result)))
}

fn invalid(id: Id, reason: &'static str) -> Response {
    refuse(id, ErrorCode::InvalidRequest, reason.to_owned())
}

/// An error response with a message of our own.
pub(crate) fn refuse(id: Id, code: ErrorCode, message: String) -> Response {
    Response::from_error(id, Error { code, message: message.into(), data: None })
}

/// Values that can be written as JSON; most of them with serde.
pub(crate) trait WriteJson {
    /// Appends its JSON text.
    fn write_json(&self, json: &mut Vec<u8>) -> serde_json::Result<()>;
}

impl<T: Serialize + ?Sized> WriteJson for T {
    fn write_json(&self, json: &mut Vec<u8>) -> serde_json::Result<()> {
        serde_json::to_writer(json, self)
    }
}

/// Any message. Writing our own plain structs into memory cannot fail.
pub(crate) fn encode(message: &impl Serialize) -> Body {
    serde_json::to_vec(message).unwrap_or_default()
}

/// The answer to a request.
pub(crate) fn encode_answer(id: &Id, result: &impl WriteJson) -> Body {
    let mut body = br#"{"jsonrpc":"2.0","id":"#.to_vec();
    // As in `encode`.
    let _ = id.write_json(&mut body);
    body.extend(br#","result":"#);
    let _ = result.write_json(&mut body);
    body.push(b'}');
    body
}

/// The answer to a request that failed.
pub(crate) fn encode_error(id: Id, error: Error) -> Body {
    encode(&Response::from_error(id, error))
}

/// Where messages to the client go; it never blocks, and messages arrive in the order in which they were sent.
#[derive(Debug, Clone)]
pub struct Outbox {
    sender: Sender<Option<Body>>,
    load: Load,
    /// Set by [`Self::only_answer`], and locked while anything else is sent, so that nothing is sent after it.
    only_answers: Arc<Mutex<bool>>,
}

impl Outbox {
    /// An outbox whose messages, encoded but not framed, come out of `sender`'s receiver; `None` is the last.
    pub fn new(sender: Sender<Option<Body>>) -> Self {
        Self { sender, load: Load::default(), only_answers: Arc::default() }
    }

    /// One whose receiver reports to the load what it has passed on.
    #[cfg(feature = "process")]
    pub(crate) fn with_load(sender: Sender<Option<Body>>, load: Load) -> Self {
        Self { sender, load, only_answers: Arc::default() }
    }

    /// Resolves once there is room for another answer.
    pub(crate) fn room(&self) -> impl Future<Output = ()> + use<> {
        self.load.room()
    }

    /// Sends an answer.
    pub(crate) fn send_answer(&self, body: Body) {
        self.load.add(body.len());
        // Without a receiver the client is gone.
        let _ = self.sender.send(Some(body));
    }

    /// Sends a notification.
    pub(crate) fn send_notification<N: Notification>(&self, params: &N::Params) {
        #[derive(Serialize)]
        struct Message<'a, P> {
            jsonrpc: &'static str,
            method: &'static str,
            params: &'a P,
        }
        self.send_server_message(&Message { jsonrpc: "2.0", method: N::METHOD, params });
    }

    /// Shows a message to the user.
    pub(crate) fn tell(&self, typ: MessageType, message: String) {
        self.send_notification::<ShowMessage>(&ShowMessageParams { typ, message });
    }

    /// Sends a request whose answer is ignored; `number` makes its id unique.
    pub(crate) fn send_server_request<R: request::Request<Params = ()>>(&self, number: u64) {
        let id = Id::String(format!("{IGNORED}{number}"));
        self.send_server_message(&build(R::METHOD, Some(id), None));
    }

    /// Sends a request or notification of ours, unless the client has shut the session down.
    pub(crate) fn send_server_message(&self, message: &impl Serialize) {
        let only_answers = self.only_answers.lock().unwrap_or_else(PoisonError::into_inner);
        if !*only_answers {
            self.send_answer(encode(message));
        }
    }

    /// From now on sends answers only: the client has shut the session down, and ignores everything else.
    pub(crate) fn only_answer(&self) {
        *self.only_answers.lock().unwrap_or_else(PoisonError::into_inner) = true;
    }

    /// Says that no message follows.
    #[cfg(feature = "process")]
    pub(crate) fn close(&self) {
        let _ = self.sender.send(None);
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn refusal(body: &[u8]) -> (Id, i64) {
        let response = parse(body).unwrap_err();
        (response.id().clone(), response.error().unwrap().code.code())
    }

    #[test]
    fn requests_notifications_and_responses_are_told_apart() {
        let request = parse(br#"{"jsonrpc":"2.0","id":1,"method":"a","params":{"b":2}}"#).unwrap();
        assert_eq!(request, Incoming::Request(Request::build("a").id(1).params(json!({"b": 2})).finish()));
        let notification = parse(br#"{"jsonrpc":"2.0","method":"a"}"#).unwrap();
        assert_eq!(notification, Incoming::Request(Request::build("a").finish()));
        let response = parse(br#"{"jsonrpc":"2.0","id":"x","result":null}"#).unwrap();
        assert_eq!(response, Incoming::Response(Response::from_ok("x".into(), Value::Null)));
        let failure =
            parse(br#"{"jsonrpc":"2.0","id":3,"error":{"code":-1,"message":"m","more":1}}"#).unwrap();
        assert_eq!(failure, Incoming::Response(Response::from_error(3.into(), Error::internal_error())));
    }

    #[test]
    fn what_is_not_json_is_a_parse_error() {
        let deep = "[".repeat(100_000);
        for body in [&b"{"[..], b"", b"nonsense", b"{\"a\":\"\xff\"}", deep.as_bytes()] {
            assert_eq!(refusal(body), (Id::Null, -32700), "{:?}", String::from_utf8_lossy(body).get(..20));
        }
    }

    #[test]
    fn half_a_surrogate_pair_does_not_lose_the_message() {
        let message = |text: &str| parse(format!(r#"{{"jsonrpc":"2.0","method":"{text}"}}"#).as_bytes());
        let method = |text: &str| match message(text) {
            Ok(Incoming::Request(request)) => request.method().to_owned(),
            other => panic!("{other:?}"),
        };
        assert_eq!(method(r"a\ud83d"), "a\u{fffd}");
        assert_eq!(method(r"\uDD16\ud83e\uDD16\ud83e"), "\u{fffd}🤖\u{fffd}");
        assert_eq!(method(r"\\ud83e \ud83e"), "\\ud83e \u{fffd}", "an escaped backslash begins no escape");
        assert!(message(r"\ud83e\x").is_err());
        assert!(message(r"\ud83").is_err());
    }

    #[test]
    fn what_is_not_a_message_is_an_invalid_request() {
        for (body, id) in [
            (r"[]", Id::Null),
            ("1", Id::Null),
            (r#"{"hello":1}"#, Id::Null),
            (r#"{"jsonrpc":"2.0"}"#, Id::Null),
            (r#"{"jsonrpc":"2.0","id":4}"#, 4.into()),
            (r#"{"jsonrpc":"2.0","id":4,"method":5}"#, 4.into()),
            (r#"{"jsonrpc":"1.0","id":4,"method":"a"}"#, 4.into()),
            (r#"{"jsonrpc":"2.0","id":[4],"method":"a"}"#, Id::Null),
            (r#"{"jsonrpc":"2.0","result":1}"#, Id::Null),
        ] {
            assert_eq!(refusal(body.as_bytes()), (id, -32600), "{body}");
        }
    }

    #[test]
    fn shutdown_with_empty_parameters_is_understood() {
        let request = parse(br#"{"jsonrpc":"2.0","id":1,"method":"shutdown","params":{}}"#).unwrap();
        assert_eq!(request, Incoming::Request(Request::build("shutdown").id(1).finish()));
    }
}
