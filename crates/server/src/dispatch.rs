//! The one road from a message to its handler: a table with a row per method, read by a `tower` layer around the
//! framework's service. The rows are in [`handlers`](crate::handlers).
//!
//! The layer writes answers as JSON text. The framework's router would build a tree of JSON values of each first, which
//! takes longer than the handler does where an answer is large or follows every keystroke; and it cancels only what
//! waits, not what computes.

use std::fmt;
use std::future::Future;
use std::sync::Arc;
use std::task::{Context, Poll};

use futures::FutureExt;
use futures::future::{BoxFuture, Either, Ready, ready};
use pydslrep_analysis::CancellationToken;
use rustc_hash::FxHashMap;
use serde::de::DeserializeOwned;
use serde_json::Value;
use tower_layer::Layer;
use tower_lsp::ExitedError;
use tower_lsp::jsonrpc::{Error, ErrorCode, Id, Request, Response, Result};
use tower_lsp::ls_types::notification::Notification;
use tower_lsp::ls_types::{ServerCapabilities, request};
use tower_service::Service;

use crate::client::ClientFeatures;
use crate::log::log;
use crate::message::{Body, Outbox, WriteJson, encode, encode_answer, encode_error};
use crate::page::Audience;
use crate::reader::yield_now;
use crate::server::{Server, Stage};
use crate::state::State;
use crate::view::View;
use crate::work::{FileWork, SHORT, Work};

/// The protocol's code for requests that come too early.
const NOT_INITIALIZED: ErrorCode = ErrorCode::ServerError(-32002);

/// The protocol's code for answers about a text that has changed meanwhile.
const CONTENT_MODIFIED: ErrorCode = ErrorCode::ServerError(-32801);

/// Adds the capabilities that a row gives the server.
pub(crate) type Announce = fn(&mut ServerCapabilities, &ClientFeatures);

/// The result of handling a message: an answer, or nothing. It runs up to its first `.await` before the next message is
/// handled.
pub(crate) type Reply = Either<Ready<Outcome>, BoxFuture<'static, Outcome>>;

/// The message to send back, if there is one; the error is the framework's, for calls after `exit`.
pub(crate) type Outcome = std::result::Result<Option<Body>, ExitedError>;

/// All methods that the server knows.
#[derive(Default)]
pub(crate) struct Table {
    rows: FxHashMap<&'static str, Row>,
}

impl fmt::Debug for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.rows.keys()).finish()
    }
}

/// A method, with its handler.
pub(crate) struct Row {
    method: &'static str,
    /// When it may come.
    stages: &'static [Stage],
    /// Tells clients about it; nothing where they send it anyway, or with another method.
    announce: Option<Announce>,
    handler: Handler,
}

enum Handler {
    /// The framework's own request, which begins or ends the session.
    FrameworkRequest,
    /// The framework's own notification.
    FrameworkNotification,
    Request(RequestHandler),
    Notification(NotificationHandler),
}

type RequestHandler = Box<dyn Fn(&Server, &Caller, Option<Value>) -> Reply + Send + Sync>;

type NotificationHandler = Box<dyn Fn(&Server, Option<Value>) -> Reply + Send + Sync>;

/// The sender of a request.
#[derive(Debug, Clone)]
struct Caller {
    audience: Audience,
    id: Id,
}

/// A request that reads; see [`read`].
pub(crate) struct Read<R: request::Request, A> {
    answer: fn(&View, &R::Params) -> A,
    note: fn(&mut State, &R::Params),
    is_long: fn(&View, &R::Params) -> bool,
    announce: Option<Announce>,
}

/// A request that reads a place or little more: on the loop.
pub(crate) fn read<R, A>(answer: fn(&View, &R::Params) -> A) -> Read<R, A>
where
    R: request::Request,
{
    Read { answer, note: |_, _| {}, is_long: |_, _| false, announce: None }
}

impl<R: request::Request, A> Read<R, A> {
    /// Notes something in the state at once, before it reads.
    pub(crate) fn noting(self, note: fn(&mut State, &R::Params)) -> Self {
        Self { note, ..self }
    }

    /// Where it may read a lot, it reads beside the loop. A change to the workspace stops it, since an answer must not be
    /// about a later text.
    pub(crate) fn beside_if(self, is_long: fn(&View, &R::Params) -> bool) -> Self {
        Self { is_long, ..self }
    }

    /// With capabilities.
    pub(crate) fn announced(self, announce: Announce) -> Self {
        Self { announce: Some(announce), ..self }
    }
}

impl<R, A> From<Read<R, A>> for Row
where
    R: request::Request,
    R::Params: Send,
    A: Answer<R::Result> + 'static,
{
    fn from(Read { answer, note, is_long, announce }: Read<R, A>) -> Self {
        let row = request::<R>(move |server, caller, params| {
            let mut state = server.state();
            note(&mut state, &params);
            if !is_long(&state.view, &params) {
                return answer_now(&caller.id, answer(&state.view, &params).into_result());
            }
            let version = state.prepare_to_lend();
            drop(state);
            answer_later(server, caller, |token| {
                let (server, caller) = (server.clone(), caller.clone());
                async move {
                    caller.turn(&server).await;
                    let answer = read_beside(&server, &caller, version, &token, |view| answer(view, &params));
                    Ok(encode_answer(&caller.id, &answer?.into_result()?))
                }
            })
        });
        Self { announce, ..row }
    }
}

/// Reads beside the loop. A client asks again when the text has changed; a page does not, and gets the answer about the
/// latest text.
fn read_beside<A>(
    server: &Server,
    caller: &Caller,
    mut version: u64,
    token: &CancellationToken,
    read: impl Fn(&View) -> A,
) -> Result<A> {
    loop {
        let loan = server.state().lend(version);
        if let Some(answer) = loan.and_then(|loan| loan.read(token.clone(), &read)) {
            return Ok(answer);
        }
        if caller.audience == Audience::Client {
            return Err(outdated());
        }
        version = server.state().prepare_to_lend();
    }
}

/// A request that reads a whole file: on a snapshot of it, beside the loop where the file is long. `prepare` returns
/// `None` where there is no such file.
pub(crate) fn read_file<R, A>(prepare: fn(&View, &R::Params) -> Option<Work<A>>) -> Row
where
    R: request::Request,
    A: WriteJson + 'static,
{
    request::<R>(move |server, caller, params| {
        let work = prepare(&server.state().view, &params);
        let work = match work {
            None => return answer_now(&caller.id, Ok(Value::Null)),
            Some(Work::Done(answer)) => return answer_now(&caller.id, Ok(answer)),
            Some(Work::OnFile(work)) => work,
        };
        if work.snapshot.text().len_bytes() < SHORT {
            return answer_now(&caller.id, Ok((work.run)(work.snapshot)));
        }
        answer_later(server, caller, |token| {
            let (server, caller) = (server.clone(), caller.clone());
            async move {
                caller.turn(&server).await;
                let FileWork { snapshot, outdated: is_outdated, run } = work;
                let snapshot = snapshot.cancelled_by(is_outdated.clone()).cancelled_by(token);
                let body = encode_answer(&caller.id, &run(snapshot));
                if is_outdated.is_cancelled() {
                    return Err(outdated());
                }
                Ok(body)
            }
        })
    })
}

/// A request that does something, or takes several turns, and may talk with the client about it.
pub(crate) fn run<R, F>(handler: fn(Server, R::Params) -> F) -> Row
where
    R: request::Request,
    F: Future<Output = Result<R::Result>> + Send + 'static,
{
    request::<R>(move |server, caller, params| {
        let answer = handler(server.clone(), params);
        answer_later(server, caller, |_| {
            let id = caller.id.clone();
            async move { Ok(encode_answer(&id, &answer.await?)) }
        })
    })
}

/// A notification that changes the state.
pub(crate) fn change<N: Notification>(handler: fn(&mut State, &N::Params, &Outbox)) -> Row {
    notification::<N>(move |server, params| {
        handler(&mut server.state(), &params, &server.outbox);
        no_answer()
    })
}

/// A notification that changes the state and leads to something else, such as a request to the client.
pub(crate) fn follow<N, F>(handler: fn(Server, N::Params) -> F) -> Row
where
    N: Notification,
    F: Future<Output = ()> + Send + 'static,
{
    notification::<N>(move |server, params| {
        Either::Right(handler(server.clone(), params).map(|()| Ok(None)).boxed())
    })
}

/// A notification that stops something; it needs no state, and may come after `shutdown` too.
pub(crate) fn interrupt<N: Notification>(handler: fn(&Server, &N::Params)) -> Row {
    let row = notification::<N>(move |server, params| {
        handler(server, &params);
        no_answer()
    });
    Row { stages: &[Stage::Serving, Stage::ShutDown], ..row }
}

/// A request that the framework answers.
pub(crate) fn framework_request<R: request::Request>(stages: &'static [Stage]) -> Row {
    Row { method: R::METHOD, stages, announce: None, handler: Handler::FrameworkRequest }
}

/// A notification for the framework.
pub(crate) fn framework_notification<N: Notification>(stages: &'static [Stage]) -> Row {
    Row { method: N::METHOD, stages, announce: None, handler: Handler::FrameworkNotification }
}

fn request<R: request::Request>(
    handler: impl Fn(&Server, &Caller, R::Params) -> Reply + Send + Sync + 'static,
) -> Row {
    let handler = move |server: &Server, caller: &Caller, params| match read_params(params) {
        Ok(params) => handler(server, caller, params),
        Err(error) => answer_now(&caller.id, Err::<Value, _>(error)),
    };
    let handler = Handler::Request(Box::new(handler));
    Row { method: R::METHOD, stages: &[Stage::Serving], announce: None, handler }
}

fn notification<N: Notification>(
    handler: impl Fn(&Server, N::Params) -> Reply + Send + Sync + 'static,
) -> Row {
    let handler = move |server: &Server, params| match read_params(params) {
        Ok(params) => handler(server, params),
        Err(error) => {
            log(format_args!("`{}` is ignored: {}", N::METHOD, error.message));
            no_answer()
        }
    };
    let handler = Handler::Notification(Box::new(handler));
    Row { method: N::METHOD, stages: &[Stage::Serving], announce: None, handler }
}

impl Row {
    /// With capabilities.
    pub(crate) fn announced(self, announce: Announce) -> Self {
        Self { announce: Some(announce), ..self }
    }

    /// True for a request, which has an id and is answered.
    fn is_request(&self) -> bool {
        matches!(self.handler, Handler::FrameworkRequest | Handler::Request(_))
    }
}

impl Caller {
    /// Resolves when other messages have had their turn, and the client has room for another answer.
    async fn turn(&self, server: &Server) {
        yield_now().await;
        if self.audience == Audience::Client {
            server.outbox.room().await;
        }
    }
}

impl Table {
    /// Adds a method.
    pub(crate) fn add(&mut self, row: impl Into<Row>) {
        let row = row.into();
        let method = row.method;
        let before = self.rows.insert(method, row);
        debug_assert!(before.is_none(), "`{method}` has two rows");
    }

    /// Returns the capabilities of the server for this client.
    pub(crate) fn capabilities(&self, client: &ClientFeatures) -> ServerCapabilities {
        let mut capabilities = ServerCapabilities::default();
        for announce in self.rows.values().filter_map(|row| row.announce) {
            announce(&mut capabilities, client);
        }
        capabilities
    }

    /// Answers a request of a page.
    #[cfg(feature = "process")]
    pub(crate) async fn answer_page(&self, server: &Server, request: Request) -> Option<Body> {
        let reply = match self.row(&request, server.stage()) {
            Ok(row) => row.handle(server, Audience::Page, request),
            Err(error) => refuse(&request, error),
        };
        reply.await.ok().flatten()
    }

    /// The row of a message, or why it cannot be taken.
    fn row(&self, request: &Request, stage: Stage) -> Result<&Row> {
        let row = self.rows.get(request.method());
        let stages = row.map_or(&[Stage::Serving][..], |row| row.stages);
        if !stages.contains(&stage) {
            return Err(match stage {
                Stage::ShutDown => {
                    error(ErrorCode::InvalidRequest, "after `shutdown` only `exit` may follow")
                }
                Stage::Starting | Stage::Serving => {
                    error(NOT_INITIALIZED, "a session begins with `initialize`")
                }
            });
        }
        match (row, request.id()) {
            (None, _) => Err(Error::method_not_found()),
            (Some(row), None) if row.is_request() => {
                Err(error(ErrorCode::InvalidRequest, "it is a request and needs an id"))
            }
            (Some(Row { handler: Handler::Notification(_), .. }), Some(_)) => {
                Err(error(ErrorCode::InvalidRequest, "it is a notification and has no id"))
            }
            (Some(row), _) => Ok(row),
        }
    }
}

impl Row {
    /// Handles a message that is not the framework's.
    fn handle(&self, server: &Server, audience: Audience, request: Request) -> Reply {
        let (_, id, params) = request.into_parts();
        match (&self.handler, id) {
            (Handler::Request(handler), Some(id)) => handler(server, &Caller { audience, id }, params),
            (Handler::Notification(handler), _) => handler(server, params),
            (Handler::Request(_) | Handler::FrameworkRequest | Handler::FrameworkNotification, _) => {
                no_answer()
            }
        }
    }
}

fn error(code: ErrorCode, message: &'static str) -> Error {
    Error { code, message: message.into(), data: None }
}

fn outdated() -> Error {
    error(CONTENT_MODIFIED, "the text has changed")
}

fn read_params<P: DeserializeOwned>(params: Option<Value>) -> Result<P> {
    serde_json::from_value(params.unwrap_or_default())
        .map_err(|error| Error::invalid_params(error.to_string()))
}

/// The return type of a handler.
pub(crate) trait Answer<T> {
    /// The answer, or the error to answer with.
    fn into_result(self) -> Result<T>;
}

impl<T> Answer<T> for Result<T> {
    fn into_result(self) -> Result<T> {
        self
    }
}

impl<T> Answer<Option<T>> for Option<T> {
    fn into_result(self) -> Result<Option<T>> {
        Ok(self)
    }
}

fn no_answer() -> Reply {
    Either::Left(ready(Ok(None)))
}

fn answer_now(id: &Id, answer: Result<impl WriteJson>) -> Reply {
    let body = match answer {
        Ok(answer) => encode_answer(id, &answer),
        Err(error) => encode_error(id.clone(), error),
    };
    Either::Left(ready(Ok(Some(body))))
}

/// Answers with the result of `start`, unless the client cancels the request before.
fn answer_later<F>(server: &Server, caller: &Caller, start: impl FnOnce(CancellationToken) -> F) -> Reply
where
    F: Future<Output = Result<Body>> + Send + 'static,
{
    let id = caller.id.clone();
    if caller.audience != Audience::Client {
        // Pages cancel nothing, and have ids of their own.
        let answer = start(CancellationToken::default());
        return Either::Right(
            async move { Ok(Some(answer.await.unwrap_or_else(|error| encode_error(id, error)))) }.boxed(),
        );
    }
    let request = match server.pending.register(&id) {
        Ok(request) => request,
        Err(error) => return answer_now(&id, Err::<Value, _>(error)),
    };
    let answer = start(request.token.clone());
    let reply =
        async move { Ok(Some(request.run(answer).await.unwrap_or_else(|error| encode_error(id, error)))) };
    Either::Right(reply.boxed())
}

/// Puts the table around the framework's service.
#[derive(Debug)]
pub(crate) struct TableLayer {
    pub(crate) table: Arc<Table>,
    pub(crate) server: Server,
}

impl<S> Layer<S> for TableLayer {
    type Service = TableService<S>;

    fn layer(&self, inner: S) -> Self::Service {
        TableService { table: Arc::clone(&self.table), server: self.server.clone(), inner }
    }
}

/// Messages in, encoded answers out. What begins and ends the session is the framework's; it does not see the rest.
#[derive(Debug)]
pub(crate) struct TableService<S> {
    table: Arc<Table>,
    server: Server,
    inner: S,
}

impl<S> Service<Request> for TableService<S>
where
    S: Service<Request, Response = Option<Response>, Error = ExitedError>,
    S::Future: Send + 'static,
{
    type Response = Option<Body>;
    type Error = ExitedError;
    type Future = Reply;

    fn poll_ready(&mut self, context: &mut Context<'_>) -> Poll<std::result::Result<(), ExitedError>> {
        self.inner.poll_ready(context)
    }

    fn call(&mut self, request: Request) -> Self::Future {
        let row = match self.table.row(&request, self.server.stage()) {
            Ok(row) => row,
            Err(error) => return refuse(&request, error),
        };
        match row.handler {
            Handler::FrameworkRequest | Handler::FrameworkNotification => {
                let answer = self.inner.call(request);
                Either::Right(async move { Ok(answer.await?.map(|answer| encode(&answer))) }.boxed())
            }
            Handler::Request(_) | Handler::Notification(_) => {
                row.handle(&self.server, Audience::Client, request)
            }
        }
    }
}

fn refuse(request: &Request, error: Error) -> Reply {
    if let Some(id) = request.id() {
        return answer_now(id, Err::<Value, _>(error));
    }
    // Clients may send notifications of that kind to every server.
    if !request.method().starts_with("$/") {
        log(format_args!("`{}` is ignored: {}", request.method(), error.message));
    }
    no_answer()
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::task::Waker;

    use serde_json::json;

    use super::*;
    use crate::session::Session;

    /// A session whose long work waits for [`Self::work`].
    struct Held {
        session: Session,
        work: mpsc::Receiver<BoxFuture<'static, ()>>,
        sent: mpsc::Receiver<Option<Vec<u8>>>,
        /// Work that waits for something.
        left: Vec<BoxFuture<'static, ()>>,
    }

    impl Held {
        fn new() -> Self {
            let (outbox, sent) = mpsc::channel();
            let (later, work) = mpsc::channel();
            let session = Session::new(Outbox::new(outbox), move |future| {
                let _ = later.send(future);
            });
            let mut held = Self { session, work, sent, left: Vec::new() };
            let capabilities = json!({ "textDocument": { "diagnostic": {} } });
            // The task that forwards the server's own requests never ends.
            held.work.try_iter().for_each(drop);
            held.send(
                &json!({ "id": 0, "method": "initialize", "params": { "capabilities": capabilities } }),
            );
            held.send(&json!({ "method": "initialized", "params": {} }));
            let text = "wheel a with radius 4\n".repeat(SHORT / 10);
            let document = json!({ "uri": "file:///a.pyr", "languageId": "x", "version": 1, "text": text });
            held.send(&json!({ "method": "textDocument/didOpen", "params": { "textDocument": document } }));
            held.answers();
            held
        }

        fn send(&mut self, message: &Value) {
            let mut message = message.clone();
            message["jsonrpc"] = "2.0".into();
            self.session.handle(message.to_string().as_bytes());
        }

        fn request(&mut self, id: i32, method: &str, params: &Value) {
            self.send(&json!({ "id": id, "method": method, "params": params }));
        }

        fn change(&mut self, text: &str) {
            let document = json!({ "uri": "file:///a.pyr", "version": 2 });
            let params = json!({ "textDocument": document, "contentChanges": [{ "text": text }] });
            self.send(&json!({ "method": "textDocument/didChange", "params": params }));
            self.session.flush_diagnostics();
        }

        fn cancel(&mut self, id: i32) {
            self.send(&json!({ "method": "$/cancelRequest", "params": { "id": id } }));
        }

        /// Requests the outline.
        fn ask(&mut self, id: i32) {
            let params = json!({ "textDocument": { "uri": "file:///a.pyr" } });
            self.send(&json!({ "id": id, "method": "textDocument/documentSymbol", "params": params }));
        }

        fn work(&mut self) {
            self.left.extend(self.work.try_iter());
            self.left.retain_mut(|work| {
                let mut context = Context::from_waker(Waker::noop());
                // Long enough for one that yields.
                !(0..99).any(|_| work.poll_unpin(&mut context).is_ready())
            });
        }

        fn messages(&self) -> Vec<Value> {
            let messages = self.sent.try_iter().flatten().map(|body| serde_json::from_slice(&body).unwrap());
            messages.filter(|message: &Value| message.get("id").is_some()).collect()
        }

        fn answers(&self) -> Vec<(Value, Option<i64>)> {
            let answer = |message: &Value| (message["id"].clone(), message["error"]["code"].as_i64());
            self.messages().iter().map(answer).collect()
        }
    }

    #[test]
    fn long_work_does_not_keep_others_waiting() {
        let mut held = Held::new();
        held.ask(1);
        let params =
            json!({ "textDocument": { "uri": "file:///a.pyr" }, "position": { "line": 0, "character": 1 } });
        held.send(&json!({ "id": 2, "method": "textDocument/hover", "params": params }));
        assert_eq!(held.answers(), [(json!(2), None)]);
        held.work();
        assert_eq!(held.answers(), [(json!(1), None)]);
    }

    /// Requests about all of a document that keep something for the next one, or note something at once.
    const LONG: [&str; 7] = [
        "textDocument/codeLens",
        "textDocument/inlayHint",
        "textDocument/codeAction",
        "textDocument/semanticTokens/range",
        "textDocument/references",
        "textDocument/documentHighlight",
        "textDocument/rename",
    ];

    fn whole() -> Value {
        let end = json!({ "line": 999_999, "character": 0 });
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": end });
        let document = json!({ "uri": "file:///a.pyr" });
        json!({
            "textDocument": document,
            "range": range,
            "context": { "diagnostics": [], "includeDeclaration": true },
            "position": { "line": 0, "character": 6 },
            "newName": "b",
        })
    }

    #[test]
    fn long_reads_do_not_keep_others_waiting() {
        let mut held = Held::new();
        for method in LONG {
            held.request(1, method, &whole());
            let params = json!({ "textDocument": { "uri": "file:///a.pyr" }, "position": { "line": 0, "character": 1 } });
            held.request(2, "textDocument/hover", &params);
            assert_eq!(held.answers(), [(json!(2), None)], "{method}");
            held.work();
            assert_eq!(held.answers(), [(json!(1), None)], "{method}");
        }
    }

    #[test]
    fn long_reads_are_about_the_text_of_their_request() {
        let mut held = Held::new();
        for (number, method) in LONG.into_iter().enumerate() {
            held.request(1, method, &whole());
            held.session.flush_diagnostics();
            held.cancel(1);
            held.work();
            assert_eq!(held.answers(), [(json!(1), Some(-32800))], "{method}");
            held.request(2, method, &whole());
            held.change(&format!("wheel a{number} with radius 4\n").repeat(SHORT / 10));
            held.request(3, method, &whole());
            // Messages published in between have changed nothing.
            held.session.flush_diagnostics();
            held.work();
            assert_eq!(held.answers(), [(json!(2), Some(-32801)), (json!(3), None)], "{method}");
        }
    }

    #[test]
    fn work_on_a_text_that_has_changed_is_refused() {
        let mut held = Held::new();
        held.ask(1);
        held.change("wheel");
        held.work();
        assert_eq!(held.answers(), [(json!(1), Some(-32801))]);
        held.ask(2);
        assert_eq!(held.answers(), [(json!(2), None)], "short files are read at once");
    }

    #[test]
    fn cancelled_work_is_not_done() {
        let mut held = Held::new();
        held.ask(1);
        held.ask(2);
        held.cancel(1);
        held.work();
        assert_eq!(held.answers(), [(json!(1), Some(-32800)), (json!(2), None)]);
        held.cancel(2);
        held.work();
        assert_eq!(held.answers(), [], "it was answered already");
    }

    #[test]
    fn a_read_of_the_workspace_lets_others_in_and_can_be_cancelled() {
        let mut held = Held::new();
        let query = json!({ "query": "a" });
        held.request(1, "workspace/symbol", &query);
        held.request(2, "workspace/symbol", &query);
        assert_eq!(held.answers(), []);
        held.cancel(2);
        held.work();
        assert_eq!(held.answers(), [(json!(1), None), (json!(2), Some(-32800))]);
        held.change("wheel abc");
        held.request(1, "workspace/symbol", &query);
        assert_eq!(held.answers(), [(json!(1), None)], "short files are read at once");
    }

    #[test]
    fn workspace_diagnostics_wait_for_a_change() {
        let mut held = Held::new();
        held.change("wheel a with radius 4");
        held.request(1, "workspace/diagnostic", &json!({ "previousResultIds": [] }));
        let [report] = &held.messages()[..] else { panic!("no report") };
        let known = json!([{ "uri": "file:///a.pyr", "value": report["result"]["items"][0]["resultId"] }]);
        for id in [2, 3] {
            held.request(id, "workspace/diagnostic", &json!({ "previousResultIds": known }));
        }
        held.work();
        assert_eq!(held.answers(), []);
        held.cancel(3);
        held.change("wheel a");
        held.work();
        let mut answers = held.answers();
        answers.sort_by_key(|(id, _)| id.as_i64());
        assert_eq!(answers, [(json!(2), None), (json!(3), Some(-32800))]);
    }

    #[test]
    fn an_id_is_used_once_at_a_time() {
        let mut held = Held::new();
        held.ask(1);
        held.ask(1);
        assert_eq!(held.answers(), [(json!(1), Some(-32602))]);
        held.work();
        held.ask(1);
        held.work();
        assert_eq!(held.answers(), [(json!(1), None), (json!(1), None)]);
    }
}
