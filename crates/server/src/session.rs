//! One client's session: messages in, handlers run, answers out, without threads, streams or clocks.
//!
//! Every handler runs, in arrival order, up to its first `.await`, before the next message is looked at; what is then
//! still unfinished is handed to the caller to run to its end. A panic answers its request with an error and nothing
//! else; a message that is none is answered too.

use std::any::Any;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::task::{Context, Poll, Waker};

use futures::future::BoxFuture;
use futures::{FutureExt, SinkExt, StreamExt};
use tower_lsp::jsonrpc::{ErrorCode, Id, Request, Response};
use tower_lsp::{ClientSocket, ExitedError, LspService};
use tower_service::Service;

use crate::direct::Direct;
use crate::handlers::driven_path::DRIVEN_PATH;
use crate::handlers::explain::EXPLAIN;
use crate::handlers::planned_action::{ACTION_LOCATION, PLANNED_AT};
use crate::handlers::planned_path::PLANNED_PATH;
use crate::log::log;
use crate::message::{IN_PASSING, Incoming, Outbox, parse, refuse};
use crate::server::Server;

/// The protocol's code for a request that comes too early.
const NOT_INITIALIZED: ErrorCode = ErrorCode::ServerError(-32002);

/// How a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// `shutdown`, then `exit`.
    Orderly,
    /// `exit` without `shutdown`, or the end of the input.
    Abrupt,
}

/// Runs a future to its end, somewhere else.
type Spawn = Box<dyn Fn(BoxFuture<'static, ()>)>;

type Reply = Result<Option<Response>, ExitedError>;

/// One client's session.
pub struct Session {
    service: LspService<Server>,
    server: Server,
    responses: Box<dyn FnMut(Response)>,
    spawn: Spawn,
    outbox: Outbox,
    stage: Stage,
}

/// How far a session is, which decides what may be asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Starting,
    Serving,
    ShutDown,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Session").field("server", &self.server).finish_non_exhaustive()
    }
}

impl Session {
    /// A session whose messages to the client go to `outbox`. `spawn` runs what outlasts the message that began it.
    pub fn new(outbox: Outbox, spawn: impl Fn(BoxFuture<'static, ()>) + 'static) -> Self {
        let (service, socket) = LspService::build(|client| Server::new(client, outbox.clone()))
            .custom_method(PLANNED_PATH, Server::planned_path)
            .custom_method(DRIVEN_PATH, Server::driven_path)
            .custom_method(PLANNED_AT, Server::planned_at)
            .custom_method(ACTION_LOCATION, Server::action_location)
            .custom_method(EXPLAIN, Server::explain)
            .custom_method("$/setTrace", Server::set_trace)
            .custom_method("window/workDoneProgress/cancel", Server::cancel_progress)
            .finish();
        Self::of_service(service, socket, outbox, Box::new(spawn))
    }

    /// A session with a service of the caller's making.
    pub(crate) fn of_service(
        service: LspService<Server>,
        socket: ClientSocket,
        outbox: Outbox,
        spawn: Spawn,
    ) -> Self {
        let (requests, mut responses) = socket.split();
        let forward = outbox.clone();
        let forwarding = requests.for_each(move |request| {
            forward.send_unasked(&without_null(request));
            std::future::ready(())
        });
        spawn(forwarding.boxed());
        let server = service.inner().clone();
        let responses = Box::new(move |response| {
            let _ = responses.send(response).now_or_never();
        });
        Self { service, server, responses, spawn, outbox, stage: Stage::Starting }
    }

    /// Handles one message, the bytes of a frame; says how the session ended, if it did.
    pub fn handle(&mut self, body: &[u8]) -> Option<Ending> {
        match parse(body) {
            Ok(Incoming::Request(request)) if request.method() == "exit" => {
                let orderly = self.stage == Stage::ShutDown;
                return Some(if orderly { Ending::Orderly } else { Ending::Abrupt });
            }
            Ok(Incoming::Request(request)) => self.call(request),
            Ok(Incoming::Response(response)) => self.pass_on(response),
            Err(refusal) => self.outbox.send(&refusal),
        }
        None
    }

    /// Answers input that is no message at all.
    pub fn refuse(&self, reason: &str) {
        self.outbox.send(&refuse(Id::Null, ErrorCode::ParseError, reason.to_owned()));
    }

    /// To be called when all messages that had arrived are handled: tells the client what they changed.
    pub fn settle(&self) {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.server.settle())) {
            report_panic(&self.server, &self.outbox, "diagnostics", None, panic.as_ref());
        }
    }

    /// To be called when the session is over, in whatever way: ends what it has started.
    pub fn leave(&self) {
        self.server.leave();
    }

    /// Runs a handler up to its first `.await`; hands over what remains.
    fn call(&mut self, request: Request) {
        if request.method() == "$/cancelRequest" && self.cancels_running(&request) {
            return;
        }
        if let Some((code, reason)) = self.why_not(&request) {
            match request.id() {
                Some(id) => self.outbox.send(&refuse(id.clone(), code, reason.to_owned())),
                None => log(format_args!("`{}` is passed over: {reason}", request.method())),
            }
            return;
        }
        let id = request.id().cloned();
        let method = request.method().to_owned();
        let started = catch_unwind(AssertUnwindSafe(|| {
            if self.stage == Stage::Serving {
                match self.server.answer_direct(&request) {
                    Direct::Other => {}
                    Direct::Answered => return Ok(Ok(None)),
                    Direct::Later(work) => {
                        (self.spawn)(work);
                        return Ok(Ok(None));
                    }
                }
            }
            let mut running = self.service.call(request);
            let mut unheard = Context::from_waker(Waker::noop());
            match running.poll_unpin(&mut unheard) {
                Poll::Ready(reply) => Ok(reply),
                Poll::Pending => Err(running),
            }
        }));
        match started {
            Ok(Ok(reply)) => {
                if matches!(&reply, Ok(Some(answer)) if answer.is_ok()) {
                    self.advance(&method);
                }
                send_reply(&self.outbox, reply);
            }
            Ok(Err(running)) => self.finish_elsewhere(running, method, id),
            Err(panic) => {
                self.forget(id.as_ref());
                report_panic(&self.server, &self.outbox, &method, id, panic.as_ref());
            }
        }
    }

    /// Why a message cannot be taken now. The router would say so too, but not of methods that it does not know; and
    /// it would begin or end a session without an answer, and answer nothing to requests that begin with `$/`.
    fn why_not(&self, request: &Request) -> Option<(ErrorCode, &'static str)> {
        let begins = request.method() == "initialize";
        match self.stage {
            Stage::Starting if !begins => Some((NOT_INITIALIZED, "a session begins with `initialize`")),
            Stage::ShutDown if request.method() != "$/cancelRequest" => {
                Some((ErrorCode::InvalidRequest, "after `shutdown` only `exit` may follow"))
            }
            _ if request.id().is_some() && request.method().starts_with("$/") => {
                Some((ErrorCode::MethodNotFound, "there is no such request"))
            }
            _ if request.id().is_none() && (begins || request.method() == "shutdown") => {
                Some((ErrorCode::InvalidRequest, "it is a request and needs an id"))
            }
            _ => None,
        }
    }

    fn cancels_running(&self, request: &Request) -> bool {
        let id = request.params().and_then(|params| params.get("id")).cloned();
        id.and_then(|id| serde_json::from_value(id).ok()).is_some_and(|id| self.server.running.cancel(&id))
    }

    fn advance(&mut self, answered: &str) {
        match answered {
            "initialize" => self.stage = Stage::Serving,
            "shutdown" => {
                self.stage = Stage::ShutDown;
                self.outbox.only_answer();
            }
            _ => {}
        }
    }

    fn finish_elsewhere(&self, running: BoxFuture<'static, Reply>, method: String, id: Option<Id>) {
        let (server, outbox) = (self.server.clone(), self.outbox.clone());
        let finish = async move {
            match AssertUnwindSafe(running).catch_unwind().await {
                Ok(reply) => send_reply(&outbox, reply),
                Err(panic) => report_panic(&server, &outbox, &method, id, panic.as_ref()),
            }
        };
        (self.spawn)(finish.boxed());
    }

    /// The router remembers a request until its handler returns, which one that panicked never does.
    fn forget(&mut self, id: Option<&Id>) {
        if let Some(id) = id.and_then(|id| serde_json::to_value(id).ok()) {
            let cancel = Request::build("$/cancelRequest").params(serde_json::json!({ "id": id })).finish();
            let _ = self.service.call(cancel).now_or_never();
        }
    }

    fn pass_on(&mut self, response: Response) {
        if matches!(response.id(), Id::String(id) if id.starts_with(IN_PASSING)) {
            return;
        }
        if catch_unwind(AssertUnwindSafe(|| (self.responses)(response))).is_err() {
            log(format_args!("an answer from the client to nothing that was asked"));
        }
    }
}

/// The library writes `params: null` into requests that have no parameters, which JSON-RPC does not allow.
fn without_null(request: Request) -> Request {
    let (method, id, params) = request.into_parts();
    let mut mended = Request::build(method);
    if let Some(params) = params.filter(|params| !params.is_null()) {
        mended = mended.params(params);
    }
    if let Some(id) = id {
        mended = mended.id(id);
    }
    mended.finish()
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
