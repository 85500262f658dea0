//! The session and its loop together, over pipes in memory.

use std::io::{Cursor, PipeReader, PipeWriter, pipe};
use std::str::FromStr;
use std::sync::{Arc, Condvar, Mutex};

use pydslrep_analysis::Database;
use serde_json::{Value, json};
use tower_lsp::jsonrpc;
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::request::Request;
use tower_lsp::ls_types::{TextDocumentIdentifier, Uri};

use super::*;
use crate::dispatch::{Table, change, read, run};
use crate::handlers;
use crate::reader::yield_now;
use crate::server::Server;
use crate::state::State;
use crate::view::View;

const DOCUMENT: &str = "file:///tmp/a.pyr";

/// The text as the analysis has it.
enum TestText {}

impl Request for TestText {
    type Params = TextDocumentIdentifier;
    type Result = Option<String>;
    const METHOD: &'static str = "test/text";
}

fn text(view: &View, document: &TextDocumentIdentifier) -> Option<String> {
    let analysed = view.analysed(&document.uri).and_then(|(_, file)| view.database().text(file));
    analysed.map(ToString::to_string)
}

enum TestPanic {}

impl Request for TestPanic {
    type Params = ();
    type Result = Option<()>;
    const METHOD: &'static str = "test/panic";
}

enum TestPanicLater {}

impl Request for TestPanicLater {
    type Params = ();
    type Result = ();
    const METHOD: &'static str = "test/panicLater";
}

enum TestPanicNotified {}

impl Notification for TestPanicNotified {
    type Params = ();
    const METHOD: &'static str = "test/panicNotified";
}

enum TestForever {}

impl Request for TestForever {
    type Params = ();
    type Result = ();
    const METHOD: &'static str = "test/forever";
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what handlers look like")]
fn panic_now(state: &mut State, (): &()) {
    state.workspace_mut().update(|database| *database = Database::new());
    panic!("on purpose");
}

async fn panic_later(_: Server, (): ()) -> jsonrpc::Result<()> {
    yield_now().await;
    panic!("on purpose");
}

/// All methods, and some that only tests need.
fn table() -> Table {
    let mut table = handlers::table();
    table.add(read::<TestText, _>(text));
    table.add(read::<TestPanic, _>(|_, ()| None).noting(panic_now));
    table.add(run::<TestPanicLater, _>(panic_later));
    table.add(change::<TestPanicNotified>(|_, (), _| panic!("on purpose")));
    table.add(run::<TestForever, _>(|_, ()| std::future::pending()));
    table
}

fn serve_in_test(input: impl Read + Send + 'static, output: impl Write + Send + 'static) -> Ending {
    let start = |outbox: Outbox, runtime: runtime::Handle| {
        Session::with_state(
            table(),
            State::default(),
            outbox,
            Box::new(move |unfinished| drop(runtime.spawn(unfinished))),
        )
    };
    serve_with(input, output, &Load::new(MAX_UNWRITTEN), start).unwrap()
}

/// A client that writes all of its requests before it reads any answer.
#[derive(Default)]
struct Hurried {
    has_written: bool,
    answers: usize,
}

type SharedHurried = Arc<(Mutex<Hurried>, Condvar)>;

/// The client's output: its requests and, once they are answered, the end.
struct Requests(SharedHurried, Cursor<Vec<u8>>, usize, Cursor<Vec<u8>>);

impl Read for Requests {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.1.read(buffer)?;
        if length > 0 {
            return Ok(length);
        }
        let (client, changed) = &*self.0;
        let mut client = client.lock().unwrap();
        client.has_written = true;
        changed.notify_all();
        drop(changed.wait_while(client, |client| client.answers < self.2).unwrap());
        self.3.read(buffer)
    }
}

/// The beginning of answers to outlines; other answers are not lists.
const LIST: &[u8] = b"\"result\":[";

/// The client's input.
struct Answers(SharedHurried, Vec<u8>);

impl Write for Answers {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (client, changed) = &*self.0;
        let mut client = changed.wait_while(client.lock().unwrap(), |client| !client.has_written).unwrap();
        self.1.extend(bytes);
        while let Some(start) = self.1.windows(LIST.len()).position(|part| part == LIST) {
            client.answers += 1;
            self.1.drain(..start + LIST.len());
        }
        changed.notify_all();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_client_that_does_not_read_costs_a_bounded_amount_of_memory() {
    // Answered on the loop, and beside it.
    for wheels in [300, 3_000] {
        check_hurried_client(wheels);
    }
}

fn check_hurried_client(wheels: usize) {
    const REQUESTS: usize = 40;
    const LIMIT: usize = 200_000;
    let wheel = |number: usize| format!("wheel w{number} with radius 4\n");
    let mut requests = [initialize(), open(&(0..wheels).map(wheel).collect::<String>())].concat();
    for id in 1..=REQUESTS {
        let params = json!({"textDocument": {"uri": DOCUMENT}});
        requests.extend(request(i64::try_from(id).unwrap(), "textDocument/documentSymbol", params));
    }
    let client = SharedHurried::default();
    let input = Requests(Arc::clone(&client), Cursor::new(requests), REQUESTS, Cursor::new(goodbye()));
    let load = Load::new(LIMIT);
    let output = Answers(Arc::clone(&client), Vec::new());
    let ending = serve_with(input, output, &load, |outbox, runtime| {
        Session::with_state(
            table(),
            State::default(),
            outbox,
            Box::new(move |unfinished| drop(runtime.spawn(unfinished))),
        )
    });
    assert_eq!(ending.unwrap(), Ending::Orderly);
    assert_eq!(client.0.lock().unwrap().answers, REQUESTS, "all are answered in the end");
    // And the answer that was being written when it became full.
    let most = LIMIT + wheels * 300;
    assert!((LIMIT..most).contains(&load.peak_bytes()), "{}", load.peak_bytes());
}

/// The order of events: a client that reads nothing cancels a request, the request ends, and only then the client
/// reads.
#[derive(Default)]
struct Turns {
    state: Mutex<Turn>,
    changed: Condvar,
}

#[derive(Default, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Turn {
    #[default]
    Writing,
    /// The request has ended.
    Ended,
    Reading,
}

/// The time after which an event is not expected any more.
const LIMIT: Duration = Duration::from_secs(60);

impl Turns {
    fn set(&self, turn: Turn) {
        let mut state = self.state.lock().unwrap();
        *state = turn.max(*state);
        self.changed.notify_all();
    }

    /// Waits for a turn, or a limit; returns the turn.
    fn wait(&self, for_turn: Turn) -> Turn {
        let state = self.state.lock().unwrap();
        *self.changed.wait_timeout_while(state, LIMIT, |turn| *turn < for_turn).unwrap().0
    }
}

/// Writes one part after the other; `read` is called when the server has handled all before the last.
struct Written<F>(Vec<Cursor<Vec<u8>>>, F);

impl<F: FnMut()> Read for Written<F> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let Some(part) = self.0.first_mut() else { return Ok(0) };
            let length = part.read(buffer)?;
            if length > 0 {
                return Ok(length);
            }
            self.0.remove(0);
            if self.0.len() == 1 {
                (self.1)();
            }
        }
    }
}

/// Reads nothing before its turn.
struct Late(Arc<Turns>, Shared);

impl Write for Late {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.wait(Turn::Reading);
        self.1.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn what_is_cancelled_ends_while_the_client_does_not_read() {
    const REQUESTS: i64 = 40;
    let wheels = "wheel w with radius 4\n".repeat(300);
    let mut requests = [initialize(), open(&wheels), request(1000, "test/forever", Value::Null)].concat();
    for id in 1..=REQUESTS {
        let params = json!({"textDocument": {"uri": DOCUMENT}});
        requests.extend(request(id, "textDocument/documentSymbol", params));
    }
    let cancel = notification("$/cancelRequest", json!({"id": 1000}));
    let (turns, output) = (Arc::new(Turns::default()), Shared::default());
    let has_ended = Arc::new(Mutex::new(false));
    let (during, noted) = (Arc::clone(&turns), Arc::clone(&has_ended));
    let input = Written([requests, cancel, goodbye()].map(Cursor::new).into(), move || {
        *noted.lock().unwrap() = during.wait(Turn::Ended) == Turn::Ended;
        during.set(Turn::Reading);
    });
    let (late, ended) = (Late(Arc::clone(&turns), output.clone()), Arc::clone(&turns));
    let ending = serve_with(input, late, &Load::new(200_000), |outbox, runtime| {
        let run = move |unfinished| {
            let ended = Arc::clone(&ended);
            drop(runtime.spawn(async move {
                let () = unfinished.await;
                ended.set(Turn::Ended);
            }));
        };
        Session::with_state(table(), State::default(), outbox, Box::new(run))
    });
    assert_eq!(ending.unwrap(), Ending::Orderly);
    assert!(*has_ended.lock().unwrap(), "the request goes on although it was cancelled");
    let messages = messages(&output);
    assert_eq!(error_code(&messages, 1000), -32800);
    // A client that leaves may get no answer to the last ones.
    let place = messages.iter().position(|message| message["id"] == 1000).unwrap();
    let is_last = |message: &Value| message["id"] == REQUESTS;
    assert!(!messages[..place].iter().any(is_last), "the last requests are answered when there is room");
}

fn frame(body: impl AsRef<[u8]>) -> Vec<u8> {
    let body = body.as_ref();
    [format!("Content-Length: {}\r\n\r\n", body.len()).as_bytes(), body].concat()
}

fn message(value: Value) -> Vec<u8> {
    let Value::Object(mut fields) = value else { panic!("not a message") };
    fields.insert("jsonrpc".to_owned(), json!("2.0"));
    frame(Value::Object(fields).to_string())
}

fn request(id: i64, method: &str, params: impl Into<Value>) -> Vec<u8> {
    message(json!({"id": id, "method": method, "params": params.into()}))
}

fn notification(method: &str, params: impl Into<Value>) -> Vec<u8> {
    message(json!({"method": method, "params": params.into()}))
}

fn initialize() -> Vec<u8> {
    let hello = request(0, "initialize", json!({"capabilities": {}}));
    [hello, notification("initialized", json!({}))].concat()
}

fn open(text: &str) -> Vec<u8> {
    let document = json!({"uri": DOCUMENT, "languageId": "pydslrep", "version": 1, "text": text});
    notification("textDocument/didOpen", json!({"textDocument": document}))
}

fn insert(version: i32, line: u32, character: u32, text: &str) -> Vec<u8> {
    let at = json!({"line": line, "character": character});
    let changes = json!([{"range": {"start": at, "end": at}, "text": text}]);
    let document = json!({"uri": DOCUMENT, "version": version});
    notification("textDocument/didChange", json!({"textDocument": document, "contentChanges": changes}))
}

fn ask_text(id: i64) -> Vec<u8> {
    request(id, "test/text", json!({"uri": DOCUMENT}))
}

fn goodbye() -> Vec<u8> {
    [request(-1, "shutdown", Value::Null), notification("exit", Value::Null)].concat()
}

/// Output that can be looked at afterwards.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Sends everything in one write; returns all that came back.
fn session(parts: &[Vec<u8>]) -> (Ending, Vec<Value>) {
    let output = Shared::default();
    let ending = serve_in_test(Cursor::new(parts.concat()), output.clone());
    (ending, messages(&output))
}

/// The messages in an output.
fn messages(output: &Shared) -> Vec<Value> {
    let bytes = output.0.lock().unwrap().clone();
    let mut frames = FrameReader::new(&bytes[..]);
    let mut messages = Vec::new();
    while let Some(found) = frames.next().unwrap() {
        let Frame::Body(body) = found else { panic!("a bad frame on the output") };
        messages.push(serde_json::from_slice(&body).unwrap());
    }
    messages
}

fn answer(messages: &[Value], id: i64) -> &Value {
    let answers: Vec<_> = messages.iter().filter(|message| message["id"] == id).collect();
    assert_eq!(answers.len(), 1, "answers to {id} in {messages:#?}");
    answers[0]
}

fn error_code(messages: &[Value], id: i64) -> i64 {
    answer(messages, id)["error"]["code"].as_i64().unwrap()
}

#[test]
fn every_read_sees_exactly_the_changes_sent_before_it() {
    let mut parts = vec![initialize(), open("")];
    for change in 1..=1000 {
        parts.push(insert(change + 1, 0, 0, if change % 2 == 0 { "é" } else { "🤖" }));
        if change % 50 == 0 {
            parts.push(ask_text(i64::from(change)));
        }
    }
    parts.push(goodbye());
    let (ending, messages) = session(&parts);
    for change in (50..=1000).step_by(50) {
        let text = answer(&messages, change)["result"].as_str().unwrap();
        assert_eq!(text, "é🤖".repeat(usize::try_from(change).unwrap() / 2));
    }
    assert_eq!(ending, Ending::Orderly);
}

#[test]
fn the_ending_is_orderly_only_after_shutdown() {
    assert_eq!(session(&[initialize(), goodbye()]).0, Ending::Orderly);
    assert_eq!(session(&[initialize(), notification("exit", Value::Null)]).0, Ending::Abrupt);
    assert_eq!(session(&[notification("exit", Value::Null)]).0, Ending::Abrupt);
    assert_eq!(session(&[initialize()]).0, Ending::Abrupt, "end of the input");
    assert_eq!(session(&[initialize(), request(1, "shutdown", Value::Null)]).0, Ending::Abrupt);
    assert_eq!(session(&[goodbye()]).0, Ending::Abrupt, "shutdown was refused before initialize");
    assert_eq!(session(&[]).0, Ending::Abrupt);
}

#[test]
fn exit_ends_the_session_while_the_input_stays_open_and_a_request_hangs() {
    let (input, mut client) = pipe().unwrap();
    client.write_all(&[initialize(), request(1, "test/forever", Value::Null), goodbye()].concat()).unwrap();
    assert_eq!(serve_in_test(input, io::sink()), Ending::Orderly);
    drop(client);
}

#[test]
fn requests_out_of_turn_get_their_errors() {
    let hover = json!({"textDocument": {"uri": DOCUMENT}, "position": {"line": 0, "character": 0}});
    let (_, messages) = session(&[
        request(1, "textDocument/hover", hover.clone()),
        initialize(),
        request(2, "no/suchMethod", json!({})),
        request(3, "initialize", json!({"capabilities": {}})),
        request(4, "textDocument/hover", json!({"nonsense": true})),
        notification("no/suchNotification", json!({})),
        notification("$/optional", json!({})),
        request(5, "shutdown", Value::Null),
        request(6, "textDocument/hover", hover),
    ]);
    let codes: Vec<_> = (1..=6).filter(|&id| id != 5).map(|id| error_code(&messages, id)).collect();
    assert_eq!(codes, [-32002, -32601, -32600, -32602, -32600]);
    assert_eq!(answer(&messages, 5)["result"], Value::Null);
    assert_eq!(messages.len(), 7, "{messages:#?}");
}

#[test]
fn malformed_input_is_answered_and_the_session_goes_on() {
    let (ending, messages) = session(&[
        initialize(),
        open("text"),
        frame("{"),
        frame(b"{\"jsonrpc\":\"2.0\",\"method\":\"\xff\"}"),
        frame("[]"),
        frame(r#"{"hello":"world"}"#),
        b"Content-Length: x\r\n\r\n{\"garbage\":1}".to_vec(),
        message(json!({"id": 77, "result": "to nothing that was asked"})),
        message(json!({"id": "what", "error": {"code": 1, "message": "m"}})),
        ask_text(1),
        goodbye(),
    ]);
    let refused: Vec<_> = messages
        .iter()
        .filter(|message| message["id"].is_null())
        .map(|m| m["error"]["code"].clone())
        .collect();
    assert_eq!(refused, [-32700, -32700, -32600, -32600, -32700].map(Value::from));
    assert_eq!(answer(&messages, 1)["result"], "text");
    assert_eq!(ending, Ending::Orderly);
}

#[test]
fn a_panic_answers_its_request_and_nothing_else() {
    let (ending, messages) = session(&[
        initialize(),
        open("text"),
        request(1, "test/panic", Value::Null),
        notification("test/panicNotified", Value::Null),
        insert(2, 0, 4, "!"),
        ask_text(2),
        // The same id once more: nothing of the first is left.
        request(1, "test/panic", Value::Null),
        goodbye(),
    ]);
    let panics: Vec<_> = messages.iter().filter(|message| message["id"] == 1).collect();
    assert_eq!(panics.len(), 2);
    for panic in panics {
        assert_eq!(panic["error"]["code"], -32603);
        assert!(panic["error"]["message"].as_str().unwrap().contains("test/panic: on purpose"));
    }
    assert_eq!(answer(&messages, 2)["result"], "text!");
    assert_eq!(ending, Ending::Orderly);
}

/// A client that reads answers while it goes on writing.
struct Conversation {
    client: PipeWriter,
    answers: FrameReader<PipeReader>,
    server: thread::JoinHandle<Ending>,
}

impl Conversation {
    fn start() -> Self {
        let (input, client) = pipe().unwrap();
        let (answers, output) = pipe().unwrap();
        let server = thread::spawn(|| serve_in_test(input, output));
        let mut conversation = Self { client, answers: FrameReader::new(answers), server };
        conversation.say(&initialize());
        assert_eq!(conversation.hear()["id"], 0);
        conversation
    }

    fn say(&mut self, bytes: &[u8]) {
        self.client.write_all(bytes).unwrap();
    }

    /// The next answer, whatever notifications come before it.
    fn hear(&mut self) -> Value {
        loop {
            let Some(Frame::Body(body)) = self.answers.next().unwrap() else { panic!("no answer") };
            let message: Value = serde_json::from_slice(&body).unwrap();
            if message["method"].is_null() {
                return message;
            }
        }
    }
}

#[test]
fn slow_requests_hold_up_nothing_and_can_be_cancelled() {
    let mut conversation = Conversation::start();
    let slow: Vec<u8> = (1..=10).flat_map(|id| request(id, "test/forever", Value::Null)).collect();
    conversation.say(&[slow, open("a"), insert(2, 0, 1, "b"), ask_text(99)].concat());
    assert_eq!(conversation.hear(), json!({"jsonrpc": "2.0", "id": 99, "result": "ab"}));
    let cancel: Vec<u8> =
        (1..=10).flat_map(|id| notification("$/cancelRequest", json!({"id": id}))).collect();
    conversation.say(&cancel);
    let mut cancelled: Vec<_> = (1..=10)
        .map(|_| conversation.hear())
        .map(|answer| (answer["id"].as_i64().unwrap(), answer["error"]["code"].as_i64().unwrap()))
        .collect();
    cancelled.sort_unstable();
    assert_eq!(cancelled, (1..=10).map(|id| (id, -32800)).collect::<Vec<_>>());
    conversation.say(&goodbye());
    assert_eq!(conversation.server.join().unwrap(), Ending::Orderly);
}

#[test]
fn a_panic_after_an_await_is_contained_too() {
    let mut conversation = Conversation::start();
    conversation.say(&request(1, "test/panicLater", Value::Null));
    assert_eq!(conversation.hear()["error"]["code"], -32603);
    conversation.say(&[open("still here"), ask_text(2)].concat());
    assert_eq!(conversation.hear()["result"], "still here");
}

#[test]
fn a_client_may_write_much_before_it_reads() {
    let mut conversation = Conversation::start();
    // More answers than a pipe holds, none of them read yet.
    conversation.say(&open(&"wheel ".repeat(10_000)));
    for id in 1..=100 {
        conversation.say(&ask_text(id));
    }
    for id in 1..=100 {
        assert_eq!(conversation.hear()["id"], id);
    }
}

#[test]
fn documents_are_known_by_any_spelling_of_their_address() {
    let uri = Uri::from_str("file:///c%3A/a.pyr").unwrap();
    let document = json!({"uri": uri.as_str(), "languageId": "pydslrep", "version": 1, "text": "x"});
    let (_, messages) = session(&[
        initialize(),
        notification("textDocument/didOpen", json!({"textDocument": document})),
        request(1, "test/text", json!({"uri": "file:///C:/a.pyr"})),
    ]);
    assert_eq!(answer(&messages, 1)["result"], "x");
}
