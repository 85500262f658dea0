//! The message loop.
//!
//! Every handler runs, in arrival order, up to its first `.await`, before the next message is looked at; what is then
//! still unfinished goes on elsewhere. A panic answers its request with an error and nothing else; malformed input is
//! answered and read past. Reading and handling share this thread, writing has its own, so that a client that writes
//! much before it reads cannot lock both sides.

use std::any::Any;
use std::io::{self, BufWriter, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::mpsc::{self, Receiver};
use std::task::{Context, Poll, Waker};
use std::thread;
use std::time::Duration;

use futures::future::BoxFuture;
use futures::{FutureExt, SinkExt, StreamExt};
use tokio::runtime::Runtime;
use tower_lsp::jsonrpc::{ErrorCode, Id, Request, Response};
use tower_lsp::{ClientSocket, ExitedError, LspService};
use tower_service::Service;

use crate::frame::{Frame, FrameReader};
use crate::message::{Incoming, Outbox, parse, refuse};
use crate::server::{Server, log};

/// How long the last messages may take to leave once the session is over.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// `shutdown`, then `exit`.
    Orderly,
    /// `exit` without `shutdown`, or the end of the input.
    Abrupt,
}

impl From<Ending> for ExitCode {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Orderly => Self::SUCCESS,
            Ending::Abrupt => Self::FAILURE,
        }
    }
}

/// Serves one client until it leaves.
///
/// # Errors
///
/// Only if the runtime or the writing thread cannot be started.
pub(crate) fn serve(input: impl Read, output: impl Write + Send + 'static) -> io::Result<Ending> {
    let (sender, messages) = mpsc::channel();
    let outbox = Outbox::new(sender);
    let (service, socket) = LspService::new(|client| Server::new(client, outbox.clone()));
    serve_with(service, socket, input, output, (outbox, messages))
}

/// [`serve`] with a service of the caller's making.
fn serve_with(
    service: LspService<Server>,
    socket: ClientSocket,
    input: impl Read,
    output: impl Write + Send + 'static,
    (outbox, messages): (Outbox, Receiver<Option<Vec<u8>>>),
) -> io::Result<Ending> {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(1).build()?;
    let (finished, writer_finished) = mpsc::channel();
    thread::Builder::new().name("writer".to_owned()).spawn(move || {
        // Without a reader at the other end there is nobody to tell; the input will end too.
        let _ = write_all(&messages, output);
        let _ = finished.send(());
    })?;
    let (requests, responses) = socket.split();
    let forward = outbox.clone();
    runtime.spawn(requests.for_each(move |request| {
        forward.send(&request);
        futures::future::ready(())
    }));
    let server = service.inner().clone();
    let mut session = Session { service, server, responses, runtime, outbox, shut_down: false };
    let ending = session.run(FrameReader::new(input));
    session.outbox.close();
    let _ = writer_finished.recv_timeout(LAST_WORDS);
    session.runtime.shutdown_background();
    Ok(ending)
}

struct Session<R> {
    service: LspService<Server>,
    server: Server,
    responses: R,
    runtime: Runtime,
    outbox: Outbox,
    shut_down: bool,
}

type Reply = Result<Option<Response>, ExitedError>;

impl<R: futures::Sink<Response> + Unpin> Session<R> {
    fn run(&mut self, mut frames: FrameReader<impl Read>) -> Ending {
        loop {
            if !frames.has_more() {
                self.settle();
            }
            let body = match frames.next() {
                Ok(Some(Frame::Body(body))) => body,
                Ok(Some(Frame::BadHeader)) => {
                    let reason = "a header without a usable Content-Length".to_owned();
                    self.outbox.send(&refuse(Id::Null, ErrorCode::ParseError, reason));
                    continue;
                }
                Ok(None) => return Ending::Abrupt,
                Err(error) => {
                    log(format_args!("cannot read from the client: {error}"));
                    return Ending::Abrupt;
                }
            };
            match parse(&body) {
                Ok(Incoming::Request(request)) if request.method() == "exit" => {
                    return if self.shut_down { Ending::Orderly } else { Ending::Abrupt };
                }
                Ok(Incoming::Request(request)) => self.call(request),
                Ok(Incoming::Response(response)) => self.pass_on(response),
                Err(refusal) => self.outbox.send(&refusal),
            }
        }
    }

    /// Runs a handler up to its first `.await`; hands over what remains.
    fn call(&mut self, request: Request) {
        let id = request.id().cloned();
        let method = request.method().to_owned();
        let _in_runtime = self.runtime.enter();
        let started = catch_unwind(AssertUnwindSafe(|| {
            let mut running = self.service.call(request);
            let mut unheard = Context::from_waker(Waker::noop());
            match running.poll_unpin(&mut unheard) {
                Poll::Ready(reply) => Ok(reply),
                Poll::Pending => Err(running),
            }
        }));
        match started {
            Ok(Ok(reply)) => {
                self.shut_down |=
                    method == "shutdown" && matches!(&reply, Ok(Some(answer)) if answer.is_ok());
                send_reply(&self.outbox, reply);
            }
            Ok(Err(running)) => self.finish_elsewhere(running, method, id),
            Err(panic) => {
                self.forget(id.as_ref());
                report_panic(&self.server, &self.outbox, &method, id, panic.as_ref());
            }
        }
    }

    fn finish_elsewhere(&self, running: BoxFuture<'static, Reply>, method: String, id: Option<Id>) {
        let (server, outbox) = (self.server.clone(), self.outbox.clone());
        self.runtime.spawn(async move {
            match AssertUnwindSafe(running).catch_unwind().await {
                Ok(reply) => send_reply(&outbox, reply),
                Err(panic) => report_panic(&server, &outbox, &method, id, panic.as_ref()),
            }
        });
    }

    /// The router remembers a request until its handler returns, which one that panicked never does.
    fn forget(&mut self, id: Option<&Id>) {
        if let Some(id) = id.and_then(|id| serde_json::to_value(id).ok()) {
            let cancel = Request::build("$/cancelRequest").params(serde_json::json!({ "id": id })).finish();
            let _ = self.service.call(cancel).now_or_never();
        }
    }

    fn pass_on(&mut self, response: Response) {
        let passing = || self.responses.send(response).now_or_never();
        if catch_unwind(AssertUnwindSafe(passing)).is_err() {
            log(format_args!("an answer from the client to nothing that was asked"));
        }
    }

    fn settle(&self) {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.server.settle())) {
            report_panic(&self.server, &self.outbox, "diagnostics", None, panic.as_ref());
        }
    }
}

fn send_reply(outbox: &Outbox, reply: Reply) {
    if let Ok(Some(response)) = reply {
        outbox.send(&response);
    }
}

/// The panic itself, with its place, is on standard error already.
fn report_panic(server: &Server, outbox: &Outbox, method: &str, id: Option<Id>, panic: &(dyn Any + Send)) {
    let words = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    let message = format!("a defect of the server in {method}: {words}; the session goes on");
    log(format_args!("{message}"));
    if let Some(id) = id {
        outbox.send(&refuse(id, ErrorCode::InternalError, message));
    }
    if catch_unwind(AssertUnwindSafe(|| server.recover())).is_err() {
        log(format_args!("and another one while starting afresh"));
    }
}

/// Writes messages until the last; what is ready together leaves together.
fn write_all(messages: &Receiver<Option<Vec<u8>>>, output: impl Write) -> io::Result<()> {
    let mut output = BufWriter::with_capacity(1 << 16, output);
    while let Ok(Some(first)) = messages.recv() {
        let mut next = Some(first);
        while let Some(body) = next {
            write!(output, "Content-Length: {}\r\n\r\n", body.len())?;
            output.write_all(&body)?;
            next = match messages.try_recv() {
                Ok(Some(body)) => Some(body),
                Ok(None) => return output.flush(),
                Err(_) => None,
            };
        }
        output.flush()?;
    }
    output.flush()
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, PipeReader, PipeWriter, pipe};
    use std::str::FromStr;
    use std::sync::{Arc, Mutex};

    use serde_json::{Value, json};
    use tower_lsp::jsonrpc;
    use tower_lsp::ls_types::{TextDocumentIdentifier, Uri};

    use super::*;

    const DOCUMENT: &str = "file:///tmp/a.pyr";

    /// Questions and misbehaviour that only tests have a use for.
    impl Server {
        async fn test_text(&self, document: TextDocumentIdentifier) -> jsonrpc::Result<String> {
            let state = self.state();
            Ok(state.document(&document.uri).map(|document| document.text.to_string()).unwrap_or_default())
        }

        async fn test_panic(&self) -> jsonrpc::Result<()> {
            let _held = self.state();
            panic!("on purpose");
        }

        async fn test_panic_later(&self) -> jsonrpc::Result<()> {
            tokio::task::yield_now().await;
            panic!("on purpose");
        }

        async fn test_panic_notified(&self) {
            panic!("on purpose");
        }

        async fn test_forever(&self) -> jsonrpc::Result<()> {
            std::future::pending().await
        }
    }

    fn serve_in_test(input: impl Read, output: impl Write + Send + 'static) -> Ending {
        let (sender, messages) = mpsc::channel();
        let outbox = Outbox::new(sender);
        let (service, socket) = LspService::build(|client| Server::new(client, outbox.clone()))
            .custom_method("test/text", Server::test_text)
            .custom_method("test/panic", Server::test_panic)
            .custom_method("test/panicLater", Server::test_panic_later)
            .custom_method("test/panicNotified", Server::test_panic_notified)
            .custom_method("test/forever", Server::test_forever)
            .finish();
        serve_with(service, socket, input, output, (outbox, messages)).unwrap()
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

    fn request(id: i64, method: &str, params: Value) -> Vec<u8> {
        message(json!({"id": id, "method": method, "params": params}))
    }

    fn notification(method: &str, params: Value) -> Vec<u8> {
        message(json!({"method": method, "params": params}))
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
        let bytes = output.0.lock().unwrap().clone();
        let mut frames = FrameReader::new(&bytes[..]);
        let mut messages = Vec::new();
        while let Some(found) = frames.next().unwrap() {
            let Frame::Body(body) = found else { panic!("a bad frame on the output") };
            messages.push(serde_json::from_slice(&body).unwrap());
        }
        (ending, messages)
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
        client
            .write_all(&[initialize(), request(1, "test/forever", Value::Null), goodbye()].concat())
            .unwrap();
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
}
